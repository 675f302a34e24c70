// Models and contexts of an inter GOF (clause 9.8.6). The parser and the writer drive them
// in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::size_t kFrameClasses = 3;

// Expected magnitudes of the residuals of an inter GOF.
class InterContexts {
 public:
  // The mesh must have layers, and outlive it.
  InterContexts(const OrderedMesh& mesh, std::size_t num_layer_groups,
                std::uint32_t num_depths);
  // Points into its own state.
  InterContexts(const InterContexts&) = delete;
  InterContexts& operator=(const InterContexts&) = delete;

  // Starts a layer group of a frame that repeats no other, with its place in coding order and
  // its depth. Calls for a frame are in ascending order of layer groups, and those for the
  // frames of a depth and layer group in coding order.
  void start_group(std::uint32_t place, std::uint32_t depth, std::size_t layer_group);
  // Starts a vertex, whose residuals follow axis by axis.
  void start(std::uint32_t v);

  // Return the expected magnitude of the next residual, with 4 fractional bits, and its models.
  std::uint32_t expected() const {
    const std::uint64_t sum = 64 * std::uint64_t{*layer_mean_} +
                              51 * std::uint64_t{ring_mean_} + 38 * std::uint64_t{outer_mean_};
    const std::uint64_t own =
        axis_ == 0 ? 103 * std::uint64_t{before_mean_}
                   : 64 * std::uint64_t{before_mean_} + 39 * std::uint64_t{latest_mean_};
    return static_cast<std::uint32_t>((sum + own) >> 12);
  }
  ResidualModels& models() { return state_->models[group_][class_]; }
  void update(std::int32_t residual);

  // Returns FrameExpected of the vertex that has been started.
  std::uint16_t frame_expected() const {
    return static_cast<std::uint16_t>(std::min(expected(), kMaxInterExpected));
  }

 private:
  static constexpr std::uint32_t kMaxMagnitude = 4095;

  std::uint32_t mean_magnitude(std::span<const std::uint32_t> ring,
                               std::uint32_t otherwise) const;

  // State that frames inherit.
  struct State {
    Vector<std::array<ResidualModels, kFrameClasses>> models;  // [layer group][class]
    Vector<std::uint32_t> mean;                                // FrameLayerMean, [num_layers]
    std::optional<std::uint32_t> latest;                       // LatestFrame, its place
  };
  // Frame to whose residuals contexts refer.
  struct Frame {
    Vector<std::uint16_t> magnitude;      // FrameMagnitude, [num_vertices]
    std::optional<std::uint32_t> before;  // FrameBefore, its place
  };

  const OrderedMesh& mesh_;
  std::size_t num_layer_groups_;
  Vector<State> states_;    // [1 + num_depths]: first frame, then other frames by depth
  State* state_ = nullptr;  // state of the current frame
  Map<std::uint32_t, Frame> frames_;            // by place
  std::optional<std::uint32_t> last_use_;       // frame to which only the current group refers
  Vector<std::uint16_t>* magnitude_ = nullptr;  // of the current frame
  const Vector<std::uint16_t>* before_ = nullptr;  // of the frame before; null: none
  bool is_first_ = true;
  std::size_t group_ = 0;
  // State of the current vertex.
  std::uint32_t vertex_ = 0;
  std::size_t class_ = 0;
  std::size_t axis_ = 0;
  std::uint32_t* layer_mean_ = nullptr;
  std::uint32_t ring_mean_ = 0;
  std::uint32_t outer_mean_ = 0;
  std::uint32_t before_mean_ = 0;
  std::uint32_t latest_mean_ = 0;
};

}  // namespace rlpc
