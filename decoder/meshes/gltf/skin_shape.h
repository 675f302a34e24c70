// The rest shape of a skin, and the morph targets for what its joints leave.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/skeleton.h"
#include "decoder/meshes/gltf/eigen.h"
#include "decoder/meshes/gltf/principal_shapes.h"
#include "decoder/meshes/gltf/skin_joints.h"

namespace rlpc {

inline constexpr std::size_t kJointsOfVertex = 4;  // what all viewers support

// The sum of the weights of a vertex, of 8 or of 16 bits.
inline constexpr int kByteWhole = 255;
inline constexpr int kShortWhole = 65535;

// Influences as written: weights in 1/whole, which sum to `whole`.
struct SkinInfluences {
  int whole = kShortWhole;
  std::vector<std::uint16_t> joints;   // [num_vertices][kJointsOfVertex]
  std::vector<std::uint16_t> weights;  // likewise
};

// Of more than kJointsOfVertex influences, the largest remain, in proportion.
SkinInfluences written_influences(const Skeleton& skeleton, int whole);

// RMS of how far apart two ways to write influences move the vertices of a frame; maps: from it
// to another.
double rms_between(const SkinInfluences& a, const SkinInfluences& b, const JointMaps& maps,
                   std::span<const float> xyz);

// The joint that moves a vertex alone, if there is one.
std::optional<std::size_t> only_joint(const SkinInfluences& influences, std::size_t vertex);

// How the joints map a vertex in a frame.
JointMap map_of(const SkinInfluences& influences, std::size_t vertex, const JointMaps& maps);

// Frames as floats, [frame][num_vertices][3], as they are to be shown.
using ShownFrames = std::span<const std::vector<float>>;

// The rest positions from which the joints get nearest to all frames; maps [frame].
std::vector<float> best_rest(const SkinInfluences& influences, std::span<const JointMaps> maps,
                             ShownFrames frames);

// What has to be added to the rest positions in each frame, one column for each.
Eigen::MatrixXf missing_moves(const SkinInfluences& influences, std::span<const JointMaps> maps,
                              std::span<const float> rest, ShownFrames frames);

// Distances of the written skin from the frames.
struct SkinError {
  double kg_percent = 0;
  double rms = 0;
  double largest = 0;
};
SkinError skin_error(const SkinInfluences& influences, std::span<const JointMaps> maps,
                     std::span<const float> rest, const PrincipalShapes& shapes,
                     ShownFrames frames);

}  // namespace rlpc
