// 8.19.5 Motion of patches.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/inter/patch_motion.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr int kMatrixFractionBits = 16;
// Steps of motions are finer than those of residuals. Measured with 32 patches on six rigged
// animations, KG errors of 0.03 and 0.3 %: with 1, frames take 7 % more bytes, with 3, 4 %; on
// cesium-man and dembones, not used for tuning, up to 17 % more with 1, the same with 3.
inline constexpr int kMotionStepLog2 = 2;

class PatchRecon {
 public:
  // vertices: vertices of the lowest layer group; they and patch_of_vertex must outlive it.
  // first: first frame of the GOF, [num_vertices][3], 1/16 grid units, like all positions here.
  PatchRecon(std::uint32_t num_patches, const PatchOfVertex& patch_of_vertex,
             std::span<const std::uint32_t> vertices, std::span<const std::int32_t> first,
             std::uint32_t num_depths, int value_bits);

  // Starts a frame, not the first, in coding order. reference: must outlive the frame. step:
  // step of the frame, 1/16 grid units. patches: patches of the frame; empty: none moves.
  void start_frame(std::span<const std::int32_t> reference, std::uint32_t depth,
                   std::uint32_t step, const FramePatches& patches);

  PatchMode mode(std::uint32_t v) const { return modes_[patch_of_vertex_[v]]; }
  // Returns MovedPoint of v in its patch.
  std::int32_t moved(std::uint32_t v, std::size_t c) const {
    return moved(last_[depth_][patch_of_vertex_[v]], v, c);
  }

  // For the choice of motions by an encoder: the centre in the reference frame, and the motion
  // that residuals are relative to, offset and matrix.
  using Motion = std::array<std::int32_t, kMotionValues>;
  Vec3i centre(std::size_t patch) const { return centres_[patch]; }
  const Motion& last_motion(std::uint32_t depth, std::size_t patch) const {
    return last_[depth][patch];
  }
  std::int64_t reach(std::size_t patch) const { return reach_[patch]; }
  std::size_t num_patches() const { return reach_.size(); }
  // Returns the motion for given residuals.
  Motion motion(std::size_t patch, std::uint32_t depth, std::uint32_t step,
                const std::array<std::int32_t, kMotionValues>& residual) const;
  // Returns the MovedPoint of v if its patch has this motion in the frame that has started.
  std::int32_t moved(const Motion& motion, std::uint32_t v, std::size_t c) const;

 private:
  // Returns the centre of each patch; without vertices in the lowest layer group, that of the
  // group.
  Vector<Vec3i> centres(std::span<const std::int32_t> frame) const;

  const PatchOfVertex& patch_of_vertex_;
  std::span<const std::uint32_t> vertices_;  // vertices of the lowest layer group
  int value_bits_;
  Vector<std::size_t> size_;     // [num_patches]: vertices of the group
  Vector<std::int64_t> reach_;   // [num_patches]: PatchReach
  Vector<Vector<Motion>> last_;  // [depth][num_patches]: PatchMotion
  // State of the current frame.
  std::span<const std::int32_t> reference_;
  std::uint32_t depth_ = 0;
  Vector<PatchMode> modes_;
  Vector<Vec3i> centres_;
};

}  // namespace rlpc
