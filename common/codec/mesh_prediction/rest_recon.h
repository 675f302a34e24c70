// 8.18.6 Reconstruction
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/mesh_prediction/rest_prediction.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/rest/rest_shape.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.18.6 Reconstruction: PredictFromCounterpart( v, hinges, axes ); also returns these axes.
Vec3l predict_from_counterpart(const RestPrediction& predictor, const HingePairs& pairs,
                               RestAxes& axes);

// Reconstructs vertex by vertex, so that the encoder predicts from the values of the decoder.
class RestRecon {
 public:
  // order must outlive it. rest_step: 1/16 grid units.
  RestRecon(const RestOrder& order, const RestSettings& settings, std::uint32_t rest_step,
            int position_bits);

  // Computes prediction and axes of v. counterparts: pairs with its counterpart; null: none.
  void start(std::uint32_t v, const HingePairs* counterparts);
  const Vec3l& prediction() const { return prediction_; }
  const RestAxes& axes() const { return axes_; }
  // Sets the value from residuals along the axes.
  void finish(const Vec3i& residual);

  // Returns the values, [num_vertices][3].
  Vector<std::int32_t>& values() { return values_; }

 private:
  const RestOrder& order_;
  RestSettings settings_;
  std::int64_t rest_step_;
  int bits_;
  Vector<std::int32_t> values_;
  // State of the current vertex.
  std::uint32_t v_ = 0;
  Vec3l prediction_{};
  RestAxes axes_{};
};

// 8.18.6 Reconstruction: ReconstructRest( ). Returns all positions, [num_vertices][3], from
// residuals, [num_vertices][3], and counterparts, [num_vertices] or empty.
Vector<std::int32_t> recon_rest(RestRecon recon, const RestOrder& order,
                                std::span<const std::int32_t> residuals,
                                std::span<const Counterpart> counterparts);

}  // namespace rlpc
