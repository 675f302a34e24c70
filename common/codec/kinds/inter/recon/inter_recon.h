// 8.19 Inter GOF: reconstructs frame after frame, in coding order. The decoder passes the
// residuals of a frame; the encoder chooses them layer by layer.
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

inline constexpr std::size_t kNumEarlierErrors = 5;  // 8.19.4: offsets besides neighbours
inline constexpr std::size_t kMaxMotions = kMaxRing + kMaxNear + kNumEarlierErrors;
static_assert(kMaxMotions % kFilterVector == 0 && kMaxMotions <= kMaxFilterSize);

// Prediction of a vertex in a frame, and the motions that it was made from.
struct VertexMotion {
  alignas(32) std::array<std::array<std::int32_t, kMaxMotions>, 3> offsets{};
  Vec3i prediction{};  // predicted position, before it is rounded to the grid
  Vec3l mean{};        // MotionMean
  Vec3l plain{};       // PlainMotion
};

// Positions have 4 fractional bits. Several threads can process the vertices of a layer above
// the base.
class InterRecon {
 public:
  // The mesh must have layers; mesh and settings must outlive it.
  InterRecon(const OrderedMesh& mesh, const InterSettings& settings, int position_bits);

  // Decodes the next frame in coding order, on several threads. last_use: the last place whose
  // frame is predicted from it.
  void decode(const FramePlace& place, std::uint32_t last_use, const InterFrame& frame);
  // Returns whether each frame but the first depends only on the first; skip_to() can then make
  // any later place the next one, once the first has been decoded.
  bool has_independent_frames() const {
    return settings_.pattern.kind == FramePattern::kFirst && !settings_.learning_flag &&
           settings_.max_earlier_distance == 0 && settings_.num_patches == 0;
  }
  void skip_to(std::uint32_t place);
  // Copies the last frame, grid units, [num_vertices][3].
  void positions(std::span<std::int32_t> positions) const;

  // Parts of decode(). A frame takes start_frame(), with the next place in coding order;
  // move_patches() if it has patches; predict() and set() for the vertices of a layer, and
  // adapt() at any time after that; and end_frame(). is_there: whether the frame has their
  // layer group; expected: FrameNoise if so.
  void start_frame(const FramePlace& place, std::uint32_t last_use,
                   std::int32_t step_delta = 0);
  void move_patches(const FramePatches& patches);
  void predict(std::uint32_t v, VertexMotion& motion, bool is_there = true) const;
  // 8.19.3: returns the position for residuals in steps.
  Vec3i position(std::uint32_t v, const VertexMotion& motion, const Vec3i& residual) const;
  void set(std::uint32_t v, const VertexMotion& motion, const Vec3i& position,
           bool is_there = true);
  void adapt(std::uint32_t v, VertexMotion& motion, bool is_there, std::uint32_t expected);
  // Sets all positions of a first frame with its own order: 1/16 grid units, [num_vertices][3].
  void set_positions(std::span<const std::int32_t> positions);
  void end_frame();

  // Returns the position that residuals are relative to, with 4 fractional bits: the
  // prediction, or the point moved by the patch; rounded to the grid if positions are exact.
  std::int32_t start_of(std::uint32_t v, const VertexMotion& motion, std::size_t c) const;
  // Returns FrameStep of a vertex, 1/256 grid units.
  std::int64_t step(std::uint32_t v) const {
    return std::int64_t{now_.step} * settings_.layer_step[mesh_.layer_of(v)];
  }
  // Returns StepOfFrame of the frame in progress, 1/16 grid units.
  std::uint32_t frame_step() const { return now_.step; }
  // Returns the place in coding order that is in progress, or comes next.
  std::uint32_t place() const { return now_.number; }
  // Returns the reference of the frame in progress, unless it is the first.
  std::span<const std::int32_t> reference() const { return frame_.reference; }
  const PatchRecon& patches() const { return *patches_; }

 private:
  // 8.19.4: errors and filters that a temporal layer learns.
  struct Learned {
    // [num_vertices][3]; 1: previous frame, 2: the frame before it.
    Vector<std::int32_t> plain_error1;
    Vector<std::int32_t> plain_error2;
    Vector<std::int32_t> error;
    Vector<std::int32_t> error1;
    Vector<std::int32_t> older_error;
    mutable Vector<std::int32_t> filters;  // per vertex: weights, then spread
  };
  struct Kept {
    Vector<std::int32_t> values;
    std::uint32_t last_use = 0;
  };
  struct Bits {
    int value;
    int position;
  };
  // The frame in progress, or the last one.
  struct Current {
    std::uint32_t number = 0;  // index of the place in coding order; the next one after a frame
    FramePlace place;
    std::uint32_t last_use = 0;
    std::uint32_t temporal_layer = 0;
    std::uint32_t step = 0;  // StepOfFrame, 1/16 grid units
  };
  // [num_vertices][3] of it, 1/16 grid units.
  struct Values {
    Vector<std::int32_t> values;       // FrameValues
    Vector<std::int32_t> reference;    // Reference
    Vector<std::int32_t> motion;       // values - reference
    Vector<std::int32_t> plain_error;  // if weights are learned
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
  // Predicts from the errors and filters of a temporal layer.
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
  Bits bits_;
  Current now_;
  Map<std::uint32_t, Kept> kept_;  // frames that later frames need
  Values frame_;
  // Set from the second frame on.
  VertexLists near_;
  std::optional<GeometryWeights> weights_;
  std::optional<PatchRecon> patches_;
  // Set if weights are learned.
  Vector<std::size_t> first_;  // [num_vertices] start of the filter
  Vector<Learned> learned_;    // [temporal_layers]
};

}  // namespace rlpc
