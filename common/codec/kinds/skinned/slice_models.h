// Models and contexts of a skinned GOF (clause 9.8). The parser and the writer drive them in
// the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/components/track_models.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kActivityContexts = 5;
using VertexModels = std::array<ResidualModels, kActivityContexts>;

// 9.8.1: models of the bone section.
struct BoneModels {
  BitModel rotation_flag;
  BitModel origin_flag;
  std::array<BitModel, 2> stretch_idc;
  std::array<BitModel, kMaxPredictorOrder - 1> rotation_order;
  std::array<BitModel, kMaxPredictorOrder> origin_order;
  std::array<BitModel, kMaxPredictorOrder> stretch_order;
  std::array<BitModel, kMaxBetween> rotation_between;
  std::array<BitModel, kMaxBetween> origin_between;
  std::array<BitModel, kMaxBetween> stretch_between;
  TrackModels rotation;
  TrackModels origin;
  TrackModels stretch;
};

// 9.8.1: models of the slices of a GOF, except those of spatial residuals.
struct SliceModels {
  BitModel trajectory_flag;
  std::array<BitModel, kMaxTemporalPredictor> temporal_predictor;
  std::array<BitModel, kMaxBetween> temporal_between;
  std::array<BitModel, kMaxExtraBones> extra_bone_flag;
  ResidualModels header;
  TrackModels trajectory;
  ResidualModels weight;
  std::array<std::uint32_t, 4> header_mean{};  // [HeaderField]
};

// 9.8.4 Expected magnitude of a spatial residual, for one component group. Copies share the
// magnitudes, and can process different vertices of a layer on separate threads.
class VertexContexts {
 public:
  VertexContexts(const OrderedMesh& mesh, std::size_t num_factors);

  // Starts a vertex, whose residuals follow factor by factor.
  void start(std::uint32_t v);
  // Returns the expected magnitude of the next residual.
  std::uint32_t expected() const {
    const std::uint64_t sum =
        96 * std::uint64_t{mean_[next_]} + 48 * std::uint64_t{ring_mean_[next_]} +
        40 * std::uint64_t{outer_mean_[next_]} + 72 * std::uint64_t{latest_mean_};
    return static_cast<std::uint32_t>(sum >> 12);
  }
  std::size_t activity() const {
    const std::uint64_t sum = 16 * (activity_sum_ + 5);
    const std::uint64_t mean = activity_mean_ + 5;
    return std::size_t{sum >= 8 * mean} + std::size_t{sum >= 13 * mean} +
           std::size_t{sum >= 20 * mean} + std::size_t{sum >= 32 * mean};
  }
  void update(std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    activity_sum_ += clipped_magnitude(residual) - (activity_sum_ >> 4);
    activity_mean_ += mean_[next_] - (activity_mean_ >> 4);
    latest_mean_ = update_mean(latest_mean_, magnitude, 2);
    mean_[next_] = update_mean(mean_[next_], magnitude, 5);
    (*magnitudes_)[std::size_t{vertex_} * mean_.size() + next_] =
        static_cast<std::uint8_t>(std::min<std::uint32_t>(magnitude, 255));
    ++next_;
  }
  // Adapts the mean of a factor to a residual that a copy has processed.
  void follow(std::size_t factor, std::int32_t residual) {
    mean_[factor] = update_mean(mean_[factor], magnitude_of(residual), 5);
  }

 private:
  void mean_magnitudes(std::span<const std::uint32_t> ring,
                       std::span<const std::uint32_t> otherwise,
                       std::span<std::uint32_t> means);

  const OrderedMesh* mesh_;
  Vector<std::uint32_t> mean_;  // ComponentMean, [num_factors]
  // ResidualMagnitude, [num_vertices][num_factors]
  std::shared_ptr<Vector<std::uint8_t>> magnitudes_;
  Vector<std::uint16_t> sums_;  // [num_factors]
  // State of the current vertex.
  std::uint32_t vertex_ = 0;
  std::size_t next_ = 0;              // next factor
  Vector<std::uint32_t> ring_mean_;   // [num_factors]
  Vector<std::uint32_t> outer_mean_;  // [num_factors]
  std::uint32_t latest_mean_ = 0;
  std::uint64_t activity_sum_ = 0;
  std::uint64_t activity_mean_ = 0;
};

}  // namespace rlpc
