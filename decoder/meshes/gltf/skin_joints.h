// Joints of a skin: their places in each frame relative to their parents, as animation keys.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "decoder/meshes/gltf/eigen.h"

namespace rlpc {

// Images of the axes of a joint, a rotation unless it or one above it stretches, and its
// origin, in units of the input.
struct JointPlace {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();

  Eigen::Vector3d moved(const Eigen::Vector3d& p) const { return axes * p + origin; }
  JointPlace after(const JointPlace& first) const {
    return {axes * first.axes, moved(first.origin)};
  }
  // Of a joint that has shrunk to nothing, the inverse maps all to one point.
  JointPlace inverse() const;
};

using JointPlaces = std::vector<JointPlace>;  // [joint]
// Map of a joint from the rest shape, as rows of a matrix.
using JointMap = Eigen::Matrix<double, 3, 4>;
using JointMaps = std::vector<JointMap>;  // [joint]

JointPlace joint_place(const BonePlace& place, const Grid& grid);
JointMap map_of_place(const JointPlace& place);

// A linear map as a rotation after factors along the axes, as nodes of glTF have it.
struct TurnAndScale {
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};
// Returns turn and scale of a map whose columns are at right angles. before: the turn to keep
// where factors of 0 leave it open.
TurnAndScale turn_and_scale(const Eigen::Matrix3d& map, const Eigen::Quaterniond& before);

// Keys of a track within a clip: frames of the clip, and `width` numbers for each. No keys: the
// value of the node, constantly.
struct JointTrack {
  std::vector<std::uint32_t> keys;
  std::vector<float> values;
  bool has_short_values = false;  // values are multiples of 1/32767
};

struct JointMotion {
  struct Node {  // relative to the parent
    std::int32_t parent = -1;
    std::array<float, 4> rotation{};  // x, y, z, w
    std::array<float, 3> translation{};
    std::array<float, 3> scale{1.0F, 1.0F, 1.0F};
  };
  struct OfClip {
    JointTrack rotation;
    JointTrack translation;
    JointTrack scale;
  };

  std::vector<Node> nodes;                          // [joint], as in frame 0
  std::vector<std::vector<OfClip>> clips;           // [clip][joint]
  std::vector<std::array<float, 16>> inverse_bind;  // [joint], in column-major order
};

// Returns the frames of a track that must be keys, so that linear interpolation between keys
// stays within the tolerance. is_near(a, b): whether it does for all frames between a and b.
template <class IsNear>
std::vector<std::uint32_t> needed_keys(std::uint32_t num_frames, const IsNear& is_near) {
  constexpr std::uint32_t kLongest = 256;
  std::vector<std::uint32_t> keys{0};
  for (std::uint32_t a = 0; a + 1 < num_frames;) {
    std::uint32_t b = a + 1;
    while (b + 1 < num_frames && b - a < kLongest && is_near(a, b + 1)) ++b;
    keys.push_back(b);
    a = b;
  }
  return keys;
}

// Returns the keys, or all frames if these take fewer bytes: tracks with the same keys share
// times.
std::vector<std::uint32_t> keys_to_write(std::vector<std::uint32_t> keys,
                                         std::uint32_t num_frames, std::size_t bytes_of_key);

// Makes the tracks of the joints. places: [frame][joint]; reach: [joint], largest distance of
// the vertices that a joint moves from its origin; tolerance: error of the motion at that
// distance, in units of the input.
JointMotion joint_motion(const Skeleton& skeleton, const Grid& grid,
                         std::span<const JointPlaces> places, std::span<const double> reach,
                         std::span<const Clip> spans, double tolerance);

// Returns the maps that viewers compute from the keys, in a frame of a clip.
JointMaps joint_maps(const JointMotion& motion, std::size_t clip, std::uint32_t frame);

}  // namespace rlpc
