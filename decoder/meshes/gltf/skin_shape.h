// Rest shape of a skin, and the residual of its joints.
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

inline constexpr std::size_t kJointsOfVertex = 4;  // supported by all viewers

// Sum of the weights of a vertex with 8 or 16 bits.
inline constexpr int kByteWhole = 255;
inline constexpr int kShortWhole = 65535;

// Influences as written: weights in 1/whole, which sum to `whole`.
struct SkinInfluences {
  int whole = kShortWhole;
  std::vector<std::uint16_t> joints;   // [num_vertices][kJointsOfVertex]
  std::vector<std::uint16_t> weights;  // [num_vertices][kJointsOfVertex]
};

// Rounds the influences; of more than kJointsOfVertex, keeps the largest, rescaled.
SkinInfluences written_influences(const Skeleton& skeleton, int whole);

// Returns the RMS distance of the vertices of a frame as moved by two ways to write influences.
// maps: from that frame to another.
double rms_between(const SkinInfluences& a, const SkinInfluences& b, const JointMaps& maps,
                   std::span<const float> xyz);

// Returns the joint that moves a vertex alone, if any.
std::optional<std::size_t> only_joint(const SkinInfluences& influences, std::size_t vertex);

// Returns the map of a vertex by the joints in a frame.
JointMap map_of(const SkinInfluences& influences, std::size_t vertex, const JointMaps& maps);

// Frames to show, as floats, [frame][num_vertices][3].
using ShownFrames = std::span<const std::vector<float>>;

// Returns the rest positions from which the joints fit all frames best. maps: [frame].
std::vector<float> best_rest(const SkinInfluences& influences, std::span<const JointMaps> maps,
                             ShownFrames frames);

// Returns the residual to add to the rest positions in each frame, [3 * num_vertices][frame].
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
