// 8.19 GOF of frames: the positions of one frame after the other. The decoder gives it the
// residuals of a frame; the encoder chooses them layer by layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/frame_gof/frame_gof.h"
#include "common/int_math.h"
#include "common/kernels/kernels.h"
#include "common/mesh/coded_mesh.h"
#include "common/mesh/mesh.h"
#include "common/mesh_prediction/geometry_weights.h"
#include "common/mesh_prediction/near_vertices.h"

namespace rlpc {

inline constexpr std::size_t kNumEarlierErrors = 5;  // 8.19.4: offsets that are no neighbours
inline constexpr std::size_t kMaxMotions = kMaxRing + kMaxNear + kNumEarlierErrors;
static_assert(kMaxMotions % kFilterVector == 0 && kMaxMotions <= kMaxFilterSize);

// The prediction of a vertex in a frame, and what it was made from.
struct VertexMotion {
  alignas(32) std::array<std::array<std::int32_t, kMaxMotions>, 3> offsets{};
  Vec3i prediction{};  // of the position, before it is rounded to the grid
  Vec3l mean{};        // MotionMean
  Vec3l plain{};       // PlainMotion
};

// Positions have 4 fractional bits. Vertices of a layer above the base can be processed on
// several threads.
class FrameRecon {
 public:
  // The mesh must have layers; mesh and settings must outlive it.
  FrameRecon(const CodedMesh& mesh, const FrameSettings& settings, int position_bits);

  // Decodes the next frame, on several threads.
  void decode(const CodedFrame& frame);
  // Whether each frame but the first decodes alone; then skip_to() makes another, from the
  // second on, the next, once the first has been decoded.
  bool has_independent_frames() const {
    return settings_.reference == FrameReference::kFirst && !settings_.learning_flag;
  }
  void skip_to(std::uint32_t frame);
  // The last frame in grid units, [num_vertices][3].
  void positions(std::span<std::int32_t> positions) const;

  // The parts of decode( ). Each frame: start_frame(); for the vertices of a layer, predict()
  // and set(), and at any time after that adapt(), once if the frame has their layer group;
  // end_frame().
  void start_frame();
  void predict(std::uint32_t v, VertexMotion& motion) const;
  // 8.19.3: the position that residuals, in steps, lead to.
  Vec3i position(std::uint32_t v, const VertexMotion& motion, const Vec3i& residual) const;
  void set(std::uint32_t v, const VertexMotion& motion, const Vec3i& position);
  void adapt(std::uint32_t v, const VertexMotion& motion, std::uint32_t expected);
  void end_frame();

  // What residuals are relative to, with 4 fractional bits: the prediction, rounded to the grid
  // if positions are exact.
  std::int32_t start_of(const VertexMotion& motion, std::size_t c) const;
  // FrameStep of a vertex, 1/256 grid units.
  std::int64_t step(std::uint32_t v) const {
    return std::int64_t{settings_.step} * settings_.layer_step[mesh_.layer_of(v)];
  }
  // Number of the frame in progress, or of the next one.
  std::uint32_t frame() const { return frame_; }

 private:
  void start_motion();
  void start_filters();
  void prime(std::uint32_t v, std::int64_t variance);
  FilterState filter(std::uint32_t v) const;
  std::size_t num_neighbours(std::uint32_t v) const {
    return mesh_.ring(v).size() + near_[v].size();
  }
  void gather_motion(std::uint32_t v, VertexMotion& motion) const;
  void gather_errors(std::uint32_t v, VertexMotion& motion) const;

  const CodedMesh& mesh_;
  const FrameSettings& settings_;
  Kernels kernels_;
  int value_bits_;
  int position_bits_;
  std::uint32_t frame_ = 0;
  // [num_vertices][3], 1/16 grid units:
  std::vector<std::int32_t> values_;
  std::vector<std::int32_t> before_;     // the frame before this one
  std::vector<std::int32_t> reference_;  // Reference
  std::vector<std::int32_t> motion_;     // values_ - reference_
  // From the second frame on:
  VertexLists near_;
  std::optional<GeometryWeights> weights_;
  // If the weights are learned:
  std::vector<std::int32_t> plain_error_;  // of this frame, the one before, and its predecessor
  std::vector<std::int32_t> plain_error1_;
  std::vector<std::int32_t> plain_error2_;
  std::vector<std::int32_t> error_;  // of this frame, and the one before
  std::vector<std::int32_t> error1_;
  std::vector<std::int32_t> older_error_;
  std::vector<std::size_t> first_;             // [num_vertices]: of its filter
  mutable std::vector<std::int32_t> filters_;  // of each vertex: weights, then spread
};

}  // namespace rlpc
