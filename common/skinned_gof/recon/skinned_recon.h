// 8.10 and 8.14: reconstructs the integer positions of a skinned GOF from residuals, frame by
// frame. Used by the decoder, and by the encoder for closed-loop coding.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/for_each.h"
#include "common/kernels/component_sum.h"
#include "common/kernels/kernels.h"
#include "common/mesh/coded_mesh.h"
#include "common/mesh_prediction/adaptive_weights.h"
#include "common/mesh_prediction/value_prediction.h"
#include "common/skinned_gof/recon/bones.h"
#include "common/skinned_gof/skinned_gof.h"

namespace rlpc {

// 8.10.2 Spatial values: the contribution of a residual of rest positions, or of trajectories,
// at a vertex of a layer.
inline std::int64_t rest_difference(const SkinnedGof& gof, std::int32_t residual,
                                    int layer_step) {
  return round2(std::int64_t{residual} * layer_step * gof.rest_step, 4);
}
inline std::int64_t factor_difference(std::int32_t residual, int layer_step) {
  return std::int64_t{residual} * layer_step;
}

// 8.10.2 Spatial values of the factors of a group, [num_vertices][factors]; without residuals
// of layers whose slices are absent. weights: null if no factor is adaptive. for_each: runs
// over vertices of a layer.
std::vector<std::int32_t> recon_values(const CodedMesh& mesh, const SkinnedGof& gof,
                                       std::size_t group, int position_bits,
                                       const ValuePrediction& prediction,
                                       AdaptiveWeights* weights = nullptr,
                                       const ForEach& for_each = in_order);

// 8.14.1 AddAbsentInfluences( ): the influences of all vertices, predicted where the slice is
// absent; [num_vertices].
std::vector<Influences> complete_influences(const CodedMesh& mesh, const SkinnedGof& gof);

// 8.14.2 PredictTrajectory( series, f ), from the values of the preceding frames.
Vec3l predict_trajectory(const Trajectory& trajectory, std::span<const Vec3i> values);
// 8.14.2 ReconstructTrajectory( ): temporal values, [num_gof_frames].
std::vector<Vec3i> recon_trajectory(const Trajectory& trajectory);

// 8.14.3 Positions: the weighted mean of a point moved by its bones; 4 fractional bits, |point|
// < 2^31. The plain twin of the computation of SkinnedRecon for many vertices.
Vec3l skinned_point(const Influences& influences, int weight_bits,
                    std::span<const BoneMotion> bones, std::uint32_t f, const Vec3l& point);

class SkinnedRecon {
 public:
  // Prepares the GOF. Reads the arguments only during the call. Cannot fail.
  SkinnedRecon(const CodedMesh& mesh, const SkinnedGof& gof, int position_bits,
               const ForEach& for_each = in_order, const Kernels& loops = kernels().back());

  // Reconstructs frames first to first + count - 1 of the GOF, grid units,
  // [count][num_vertices][3]. Several frames at a time are faster than single ones.
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const;
  void frame(std::uint32_t f, std::span<std::int32_t> positions) const {
    frames(f, 1, positions);
  }
  std::uint32_t num_frames() const { return num_frames_; }

 private:
  // Influences of one bone on vertices of a tile: elements first to end - 1 of the lists below.
  struct Run {
    std::uint32_t bone;
    std::uint32_t first;
    std::uint32_t end;
  };
  using Sums = std::array<std::array<std::int64_t, kTileValues>, 3>;  // by coordinate

  void add_influences(std::span<const Influences> influences,
                      std::span<const std::int32_t> rest);
  void add_factors(const CodedMesh& mesh, const SkinnedGof& gof,
                   std::span<const std::int32_t> rest, const ForEach& for_each);
  void skin_tile(std::size_t tile, std::uint32_t f, Sums& sums) const;

  std::uint32_t num_frames_;
  std::size_t num_vertices_;
  PositionWidths widths_;
  Kernels loops_;
  std::vector<BoneMotion> bones_;
  std::vector<Run> runs_;
  std::vector<std::size_t> first_run_;  // [tiles + 1]
  // Influences, by tile, then by bone:
  std::array<std::vector<std::int32_t>, 3> arm_;  // rest position relative to the pivot
  std::vector<std::int32_t> weight_;
  std::vector<std::uint8_t> place_;  // index of the vertex in its tile
  ComponentSum factors_;             // row 3 * f + c: coordinate c of frame f
};

}  // namespace rlpc
