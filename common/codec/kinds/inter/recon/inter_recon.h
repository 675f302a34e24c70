// 8.19 Inter GOF: the positions of one frame after the other, in coding order. The decoder
// gives it the residuals of a frame; the encoder chooses them layer by layer.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/kernels/kernels.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/recon/patch_recon.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh_prediction/geometry_weights.h"
#include "common/codec/mesh_prediction/near_vertices.h"
#include "common/memory/owned.h"

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
class InterRecon {
 public:
  // The mesh must have layers; mesh and settings must outlive it.
  InterRecon(const OrderedMesh& mesh, const InterSettings& settings, int position_bits);

  // Decodes a frame, the next in coding order, on several threads. last_use: the last place
  // whose frame is predicted from it.
  void decode(const FramePlace& place, std::uint32_t last_use, const InterFrame& frame);
  // Whether each frame but the first decodes alone; then skip_to() makes another place, from
  // the second on, the next, once the first has been decoded.
  bool has_independent_frames() const {
    return settings_.pattern.kind == FramePattern::kFirst && !settings_.learning_flag &&
           settings_.max_earlier_distance == 0 && settings_.num_patches == 0;
  }
  void skip_to(std::uint32_t place);
  // The last frame in grid units, [num_vertices][3].
  void positions(std::span<std::int32_t> positions) const;

  // The parts of decode( ). Each frame: start_frame(), with the next place in coding order, and
  // move_patches() if it has patches; for the vertices of a layer, predict() and set(), and at
  // any time after that adapt(); end_frame(). is_there: the frame has their layer group;
  // expected: then FrameNoise.
  void start_frame(const FramePlace& place, std::uint32_t last_use);
  void move_patches(const FramePatches& patches);
  void predict(std::uint32_t v, VertexMotion& motion, bool is_there = true) const;
  // 8.19.3: the position that residuals, in steps, lead to.
  Vec3i position(std::uint32_t v, const VertexMotion& motion, const Vec3i& residual) const;
  void set(std::uint32_t v, const VertexMotion& motion, const Vec3i& position,
           bool is_there = true);
  void adapt(std::uint32_t v, VertexMotion& motion, bool is_there, std::uint32_t expected);
  // In a first frame with an order of its own, all at once: 1/16 grid units, [num_vertices][3].
  void set_positions(std::span<const std::int32_t> positions);
  void end_frame();

  // What residuals are relative to, with 4 fractional bits: the prediction, or where the patch
  // moves to; rounded to the grid if positions are exact.
  std::int32_t start_of(std::uint32_t v, const VertexMotion& motion, std::size_t c) const;
  // FrameStep of a vertex, 1/256 grid units.
  std::int64_t step(std::uint32_t v) const {
    return std::int64_t{settings_.step[place_.depth]} * settings_.layer_step[mesh_.layer_of(v)];
  }
  // The place in coding order that is in progress, or comes next.
  std::uint32_t place() const { return number_; }
  // Of the frame in progress, unless it is the first.
  std::span<const std::int32_t> reference() const { return reference_; }
  const PatchRecon& patches() const { return *patches_; }

 private:
  // 8.19.4: what a temporal layer learns.
  struct Learned {
    // Of the last frame, and the one before it; [num_vertices][3]:
    Vector<std::int32_t> plain_error1;
    Vector<std::int32_t> plain_error2;
    Vector<std::int32_t> error;  // of this frame, and of the last
    Vector<std::int32_t> error1;
    Vector<std::int32_t> older_error;
    mutable Vector<std::int32_t> filters;  // of each vertex: weights, then spread
  };
  struct Kept {
    Vector<std::int32_t> values;
    std::uint32_t last_use = 0;
  };

  bool follows_patch(std::uint32_t v) const {
    return patches_ && patches_->mode(v) != PatchMode::kNeighbours;
  }
  void decode_positions_in_order(const InterFrame& frame);
  void start_motion();
  void start_learning();
  void prime(Learned& learned, std::uint32_t v, std::int64_t variance);
  void make_reference();
  void end_errors();
  FilterState filter(const Learned& learned, std::uint32_t v) const;
  // By what a temporal layer has learned.
  void predict(const Learned& learned, std::uint32_t v, VertexMotion& motion,
               bool is_there) const;
  void adapt(Learned& learned, std::uint32_t v, const VertexMotion& motion,
             std::int64_t variance);
  std::size_t num_neighbours(std::uint32_t v) const {
    return mesh_.ring(v).size() + near_[v].size();
  }
  void gather_motion(std::uint32_t v, VertexMotion& motion) const;
  void gather_errors(const Learned& learned, std::uint32_t v, VertexMotion& motion,
                     bool is_there) const;

  const OrderedMesh& mesh_;
  const InterSettings& settings_;
  Kernels kernels_;
  int value_bits_;
  int position_bits_;
  std::uint32_t number_ = 0;          // of the place in coding order
  FramePlace place_;                  // the last one started
  std::uint32_t last_use_ = 0;        // of its frame
  std::uint32_t temporal_layer_ = 0;  // likewise
  Map<std::uint32_t, Kept> kept_;     // frames that later ones need
  // [num_vertices][3], 1/16 grid units:
  Vector<std::int32_t> values_;     // FrameValues
  Vector<std::int32_t> reference_;  // Reference
  Vector<std::int32_t> motion_;     // values_ - reference_
  // From the second frame on:
  VertexLists near_;
  std::optional<GeometryWeights> weights_;
  std::optional<PatchRecon> patches_;
  // If the weights are learned:
  Vector<std::int32_t> plain_error_;  // of this frame
  Vector<std::size_t> first_;         // [num_vertices]: of its filter
  Vector<Learned> learned_;           // [temporal_layers]
};

}  // namespace rlpc
