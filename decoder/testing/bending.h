// Animation for tests of skins.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "decoder/meshes/gltf/eigen.h"
#include "decoder/meshes/gltf/skin_shape.h"

namespace rlpc {

inline constexpr std::size_t kVertices = 60;
inline constexpr std::size_t kFrames = 50;

// Tube around two bones that bends, and moves as a whole.
struct Bending {
  Skeleton skeleton;
  std::vector<JointPlaces> places;
  std::vector<std::vector<float>> frames;

  Bending() {
    constexpr std::int64_t kOne = std::int64_t{1} << 30;
    const std::array<Vec3l, 3> axes{{{kOne, 0, 0}, {0, kOne, 0}, {0, 0, kOne}}};
    skeleton.bones = {{-1, {axes, {0, 0, 0}}}, {0, {axes, {80, 0, 0}}}};
    std::vector<Eigen::Vector3d> rest;
    for (std::size_t v = 0; v < kVertices; ++v) {
      const double x = static_cast<double>(v) / 6;
      rest.emplace_back(x, std::cos(2.1 * static_cast<double>(v)),
                        std::sin(2.1 * static_cast<double>(v)));
      const auto second = static_cast<std::uint16_t>(std::clamp(8 * (x - 4), 0.0, 16.0));
      std::vector<SkeletonInfluence> list;
      if (second < 16) list.push_back({0, static_cast<std::uint16_t>(16 - second)});
      if (second > 0) list.push_back({1, second});
      skeleton.influences.push_back(list);
    }
    const SkinInfluences influences = written_influences(skeleton, kShortWhole);
    for (std::size_t f = 0; f < kFrames; ++f) {
      const double t = static_cast<double>(f);
      const JointPlace first{turn(0.03 * t).toRotationMatrix(), {0.1 * t, 1, 0}};
      places.push_back({first, first.after({turn(0.02 * t).toRotationMatrix(), {5, 0, 0}})});
      const JointMaps maps = maps_of(f);
      std::vector<float>& xyz = frames.emplace_back();
      for (std::size_t v = 0; v < kVertices; ++v) {
        const Eigen::Vector3d p = map_of(influences, v, maps) * rest[v].homogeneous();
        for (Eigen::Index c = 0; c < 3; ++c) xyz.push_back(static_cast<float>(p[c]));
      }
    }
  }

  JointMaps maps_of(std::size_t f) const {
    JointMaps maps;
    for (std::size_t j = 0; j < 2; ++j) {
      const JointPlace bind = joint_place(skeleton.bones[j].bind, {});
      const JointPlace moved = places[f][j].after(bind.inverse());
      maps.push_back(map_of_place(moved));
    }
    return maps;
  }
  std::vector<JointMaps> maps() const {
    std::vector<JointMaps> all;
    for (std::size_t f = 0; f < kFrames; ++f) all.push_back(maps_of(f));
    return all;
  }
  static Eigen::Quaterniond turn(double angle) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d(0, 0.6, 0.8)));
  }
};

}  // namespace rlpc
