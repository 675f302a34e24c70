// 8.14: reconstructs the integer positions of a skinned GOF from residuals, frame by frame.
// Used by the decoder, and by the encoder for closed-loop coding.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>

#include "common/codec/kernels/component_sum.h"
#include "common/codec/kernels/kernels.h"
#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/recon/trajectory_prediction.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.14.2 ReconstructTrajectory( ): temporal values, [num_gof_frames].
Vector<Vec3i> recon_trajectory(const Trajectory& trajectory, int track_levels);

// 8.14.3 Positions: the weighted mean of a point moved by its bones; 4 fractional bits, |point|
// < 2^31. The plain twin of the computation of SkinnedRecon for many vertices.
Vec3l skinned_point(const Influences& influences, int weight_bits,
                    std::span<const BoneMotion> bones, std::uint32_t f, const Vec3l& point);

class SkinnedRecon {
 public:
  // Prepares a GOF without a shared rig. The mesh must outlive the object; the GOF is read only
  // during the call. Cannot fail.
  SkinnedRecon(const OrderedMesh& mesh, const SkinnedGof& gof, int position_bits,
               const Kernels& loops = kernels().back());
  // Prepares a GOF with a shared rig.
  SkinnedRecon(std::shared_ptr<const RigRecon> rig, const SkinnedGof& gof,
               const Kernels& loops = kernels().back());

  // Reconstructs frames first to first + count - 1 of the GOF, grid units,
  // [count][num_vertices][3]. Several frames at a time are faster than single ones.
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const;
  void frame(std::uint32_t f, std::span<std::int32_t> positions) const {
    frames(f, 1, positions);
  }
  std::uint32_t num_frames() const { return num_frames_; }
  // Return bones and influences, in decoded order, and the places of the bones in a frame.
  Skeleton skeleton() const;
  Vector<BonePlace> places(std::uint32_t f) const;
  // Returns the number of coded values per frame.
  std::size_t values_of_frame() const { return values_of_frame_; }

 private:
  using Sums = std::array<std::array<std::int64_t, kTileValues>, 3>;  // [coordinate][value]

  void skin_tile(std::size_t tile, std::uint32_t f, Sums& sums) const;

  std::uint32_t num_frames_;
  std::uint32_t rest_step_;
  std::size_t values_of_frame_ = 0;
  PositionWidths widths_;
  Kernels loops_;
  std::shared_ptr<const RigRecon> rig_;
  Vector<BoneMotion> bones_;
  // Displacements of the shared rig, then of local component groups. Row 3 * f + c: coordinate
  // c of frame f.
  Vector<ComponentSum> sums_;
};

}  // namespace rlpc
