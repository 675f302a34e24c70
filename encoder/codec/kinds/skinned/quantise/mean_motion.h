// Motion that a vertex takes from its bones, and its residual (inverse of 8.14.3, in floating
// point).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

inline constexpr double kPointScale = 16.0;  // fixed: 1 << kPointFractionBits

// A bone motion or a weighted mean of several: world = turn * rest + shift, in grid units.
struct MeanMotion {
  std::array<Point, 3> turn{};  // columns: images of the axes
  Point shift{};
};

// Returns the motion of a decoded bone in some of its frames.
std::vector<MeanMotion> motions_of(const BoneMotion& bone, std::size_t first,
                                   std::size_t count);
// Returns the motion of a bone that is not quantised. pivot: 1/16 grid units; poses: with
// rotations in world coordinates; axes: as in RigBone.
std::vector<MeanMotion> motions_of(const Vec3i& pivot, std::span<const WantedPose> poses,
                                   std::span<const AxisImages> axes = {});

using MotionsOfBones = std::vector<std::vector<MeanMotion>>;  // [bone][frame]

// The motions of the vertices that follow some bones.
class MeanMotions {
 public:
  // Keeps a reference to the motions.
  explicit MeanMotions(const MotionsOfBones& motions) : motions_(motions) {}
  // Returns the weighted mean of the motions of the bones of a vertex, [frame]; valid until the
  // next call.
  std::span<const MeanMotion> of(const Influences& influences, int weight_bits);

 private:
  const MotionsOfBones& motions_;
  std::vector<MeanMotion> mean_;  // [frame], for vertices with influences mean_of_
  Influences mean_of_;
};

// Writes the residual of bone motion of a vertex: for each coordinate, all frames of `motion`.
//
//   chosen  the frames
//   rest    rest position, grid units
//   row     [3][frame]
void write_displacement(const SpanFrames& frames, std::span<const std::uint32_t> chosen,
                        std::uint32_t v, std::span<const MeanMotion> motion, const Point& rest,
                        double* row);

// Returns `count` consecutive numbers.
std::vector<std::uint32_t> numbers_from(std::uint32_t first, std::uint32_t count);

}  // namespace rlpc
