// Skinned meshes for tests: tubes around bones, as an animation tool would export them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

inline constexpr double kLimbScale = 4096.0;  // grid units per unit of length

// Numbers that are the same with every standard library.
class LimbRandom {
 public:
  explicit LimbRandom(std::uint32_t seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * 0x1p-32 * static_cast<double>(engine_());
  }
  Vec3d vector(double max) {
    const double x = between(-max, max);
    const double y = between(-max, max);
    return {x, y, between(-max, max)};
  }

 private:
  std::mt19937 engine_;
};

// Returns frames in which a vertex is at position(frame, vertex), rounded as in a point cache.
template <typename Position>
SpanFrames cached_frames(std::uint32_t num_vertices, std::uint32_t num_frames,
                         const Position& position) {
  SpanFrames frames{num_vertices, num_frames, {}};
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    for (std::uint32_t v = 0; v < num_vertices; ++v) {
      const Vec3d p = position(f, v);
      for (Eigen::Index c = 0; c < 3; ++c) {
        frames.xyz.push_back(kLimbScale * static_cast<double>(static_cast<float>(p(c))));
      }
    }
  }
  return frames;
}

struct LimbBone {
  int parent = -1;          // index of an earlier bone; it begins where that ends. -1: root
  Vec3d along = {1, 0, 0};  // from its start to its end, in the bind pose
  Vec3d from = {0, 0, 0};   // where a root starts
  int turns_like = -1;      // a root: index of an earlier bone with the same rotation
};

struct LimbOptions {
  std::uint32_t seed = 1;
  std::uint32_t num_frames = 60;
  std::uint32_t sides = 10;  // vertices of a ring
  double spacing = 0.1;      // of the rings
  double blend = 0.4;        // distance from a bone at which its weight becomes zero
  double bend = 0.7;         // maximum angle in the first frame, relative to the bind pose
  double turn = 0.5;         // amplitude of the elements of rotation vectors
};

// Bones one after the other.
inline std::vector<LimbBone> limb_chain(std::span<const double> lengths) {
  std::vector<LimbBone> bones;
  for (const double length : lengths) {
    bones.push_back({.parent = static_cast<int>(bones.size()) - 1, .along = {length, 0, 0}});
  }
  bones[0].from = {-0.5 * static_cast<double>(lengths.size()), 0, 0};
  return bones;
}

class SkinnedLimb {
 public:
  SkinnedLimb(std::vector<LimbBone> skeleton, const LimbOptions& options)
      : bones(std::move(skeleton)), options_(options), random_(options.seed) {
    make_mesh();
    make_motions();
    frames = cached_frames(static_cast<std::uint32_t>(rest.size()), options.num_frames,
                           [&](std::uint32_t f, std::uint32_t v) { return position(f, v); });
  }

  // Returns the true position of a vertex, before rounding.
  Vec3d position(std::uint32_t frame, std::uint32_t vertex) const {
    Vec3d sum = Vec3d::Zero();
    for (std::size_t b = 0; b < bones.size(); ++b) {
      sum += weights[vertex][b] * moved(motions[b][frame], rest[vertex]);
    }
    return sum;
  }

  std::vector<LimbBone> bones;
  std::vector<Vec3d> joints;                 // [bone], where it starts, in the bind pose
  std::vector<std::vector<Motion>> motions;  // [bone][frame], from the bind pose
  std::vector<Vec3d> rest;                   // [vertex], in the bind pose
  std::vector<std::vector<double>> weights;  // [vertex][bone], at most four above zero
  std::vector<Triangle> triangles;
  SpanFrames frames;  // grid units

 private:
  void make_mesh() {
    const std::uint32_t sides = options_.sides;
    std::vector<std::uint32_t> last_ring;  // [bone], its first vertex
    for (const LimbBone& bone : bones) {
      joints.push_back(bone.parent < 0 ? bone.from : end_of(index(bone.parent)));
      const double length = bone.along.norm();
      const auto rings = static_cast<std::uint32_t>(std::lround(length / options_.spacing));
      const Vec3d u = cross(bone.along, {0.2, 0.5, 0.7}).normalized();
      const Vec3d w = cross(bone.along, u) / length;
      for (std::uint32_t r = 0; r < rings; ++r) {
        const auto first = static_cast<std::uint32_t>(rest.size());
        for (std::uint32_t s = 0; s < sides; ++s) {
          const double angle = 6.283185307179586 * s / sides;
          const double radius = random_.between(0.2, 0.25);
          const double place = (r + random_.between(0.3, 0.7)) / rings;
          rest.emplace_back(joints.back() + place * bone.along +
                            radius * (std::cos(angle) * u + std::sin(angle) * w));
        }
        if (r > 0) {
          join_rings(first - sides, first);
        } else if (bone.parent >= 0) {
          join_rings(last_ring[index(bone.parent)], first);
        }
      }
      last_ring.push_back(static_cast<std::uint32_t>(rest.size()) - sides);
    }
    for (const Vec3d& p : rest) weights.push_back(weights_at(p));
  }

  void join_rings(std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t s = 0; s < options_.sides; ++s) {
      const std::uint32_t next = (s + 1) % options_.sides;
      triangles.push_back({a + s, a + next, b + s});
      triangles.push_back({a + next, b + next, b + s});
    }
  }

  // Returns weights that fall with the distance from a bone beyond its ends; at most four.
  std::vector<double> weights_at(const Vec3d& p) const {
    std::vector<double> list;
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Vec3d& along = bones[b].along;
      const double place = along.dot(p - joints[b]) / along.norm();
      const double outside = std::max({-place, place - along.norm(), 0.0});
      const Vec3d nearest = joints[b] + place * along.normalized();
      const double aside = std::max((p - nearest).norm() - 0.25, 0.0);
      const double share = std::max(1.0 - std::hypot(outside, aside) / options_.blend, 0.0);
      list.push_back(share * share);
    }
    std::vector<double> sorted = list;
    std::sort(sorted.rbegin(), sorted.rend());
    const double min = sorted.size() > 4 ? sorted[4] : 0.0;
    double sum = 0.0;
    for (double& w : list) sum += w = w > min ? w : 0.0;
    for (double& w : list) w /= sum;
    return list;
  }

  void make_motions() {
    struct Wave {
      double start, speed, phase, amplitude;
      double at(double f) const {
        return start + amplitude * (std::sin(speed * f + phase) - std::sin(phase));
      }
    };
    const auto make_waves = [&](const Vec3d& start, double amplitude) {
      std::array<Wave, 3> waves{};
      for (std::size_t k = 0; k < 3; ++k) {
        waves[k] = {start(static_cast<Eigen::Index>(k)), random_.between(0.1, 0.4),
                    random_.between(0.0, 6.28), amplitude};
      }
      return waves;
    };
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Vec3d start = random_.vector(1.0).normalized() * random_.between(0.4, 1.0);
      const auto turns = make_waves(options_.bend * start, options_.turn);
      const auto shifts = make_waves(joints[b], 0.3);
      std::vector<Motion>& list = motions.emplace_back();
      for (std::uint32_t f = 0; f < options_.num_frames; ++f) {
        const bool is_root = bones[b].parent < 0;
        const Motion own = rotation_about(
            joints[b], {turns[0].at(f), turns[1].at(f), turns[2].at(f)},
            is_root ? Vec3d(shifts[0].at(f), shifts[1].at(f), shifts[2].at(f)) : joints[b]);
        list.push_back(is_root ? own : after(motions[index(bones[b].parent)][f], own));
        if (is_root && bones[b].turns_like >= 0) {
          Motion& m = list.back();
          const Vec3d joint = moved(m, joints[b]);
          m.leftCols<3>() = motions[index(bones[b].turns_like)][f].leftCols<3>();
          m.col(3) = joint - m.leftCols<3>() * joints[b];
        }
      }
    }
  }

  static Vec3d cross(const Vec3d& a, const Vec3d& b) {
    return {a(1) * b(2) - a(2) * b(1), a(2) * b(0) - a(0) * b(2), a(0) * b(1) - a(1) * b(0)};
  }
  static std::size_t index(int bone) { return static_cast<std::size_t>(bone); }
  Vec3d end_of(std::size_t bone) const { return joints[bone] + bones[bone].along; }
  // Turns by a rotation vector, and moves the centre to a place.
  static Motion rotation_about(const Vec3d& centre, const Vec3d& turn, const Vec3d& to) {
    const double half = 0.5 * turn.norm();
    const double scale = half > 1e-9 ? 0.5 * std::sin(half) / half : 0.5;
    Motion m;
    m.leftCols<3>() = rotation_matrix(
        normalised({std::cos(half), scale * turn(0), scale * turn(1), scale * turn(2)}));
    m.col(3) = to - m.leftCols<3>() * centre;
    return m;
  }
  static Motion after(const Motion& parent, const Motion& own) {
    Motion m = parent.leftCols<3>() * own;
    m.col(3) += parent.col(3);
    return m;
  }

  LimbOptions options_;
  LimbRandom random_;
};

// Returns a limb of two to six bones; skeleton and options depend on the number.
inline SkinnedLimb random_limb(std::uint32_t seed) {
  LimbRandom random(seed);
  std::vector<double> lengths;
  const int links = 2 + static_cast<int>(random.between(0.0, 3.0));
  lengths.reserve(static_cast<std::size_t>(links));
  for (int i = 0; i < links; ++i) lengths.push_back(random.between(0.3, 1.2));
  std::vector<LimbBone> bones = limb_chain(lengths);
  const int branches = static_cast<int>(random.between(0.0, 3.0));
  for (int i = 0; i < branches; ++i) {
    const int parent = i == 0 ? 0 : static_cast<int>(bones.size()) - 1;
    bones.push_back({.parent = parent, .along = {0.0, random.between(0.5, 1.0), 0.1}});
  }
  return SkinnedLimb(std::move(bones),
                     {.seed = seed,
                      .num_frames = static_cast<std::uint32_t>(random.between(40.0, 80.0)),
                      .sides = static_cast<std::uint32_t>(random.between(8.0, 13.0)),
                      .blend = random.between(0.2, 0.6)});
}

}  // namespace rlpc
