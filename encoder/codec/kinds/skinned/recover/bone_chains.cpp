#include "encoder/codec/kinds/skinned/recover/bone_chains.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "common/codec/mesh/indices.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/recover/trajectory_span.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

constexpr std::size_t kFewAnchors = 3;  // fixed: a triangle

using Bones = std::vector<std::uint32_t>;  // ascending

bool has(const Bones& list, std::size_t bone) {
  return std::binary_search(list.begin(), list.end(), static_cast<std::uint32_t>(bone));
}

// Whether points are near a line: it may be an axis that two bones share.
bool are_straight(std::span<const Vec3d> points) {
  constexpr double kFlat = 1e-3;  // fixed: squared width, relative to the squared length
  Vec3d mean = Vec3d::Zero();
  for (const Vec3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vec3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  const double trace = scatter.trace();
  // The sum of the products of two eigenvalues each.
  const double pairs = 0.5 * (trace * trace - (scatter * scatter).trace());
  return !(pairs > kFlat * trace * trace);
}

// Groups of things that are found to belong together, one pair at a time.
class Groups {
 public:
  explicit Groups(std::size_t count) : above_(count) {
    std::iota(above_.begin(), above_.end(), std::size_t{0});
  }
  std::size_t of(std::size_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  // Returns false if both are in one group already.
  bool join(std::size_t a, std::size_t b) {
    a = of(a);
    b = of(b);
    above_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }

 private:
  std::vector<std::size_t> above_;
};

// Trajectories of some vertices as seen from a bone: those of its anchors differ by constants.
class SeenFromBone {
 public:
  SeenFromBone(const Trajectories& t, const Rotations& rotation,
               std::span<const std::uint32_t> vertices)
      : num_frames_(t.num_frames()) {
    for (const std::uint32_t v : vertices) {
      for (std::size_t f = 0; f < num_frames_; ++f) {
        seen_.emplace_back(rotation[f].transpose() * t.position(f, v));
      }
    }
  }
  const Vec3d& first(std::size_t i) const { return seen_[i * num_frames_]; }
  bool move_together(std::size_t i, std::size_t j) const {
    constexpr double kRigid = 5e-6;  // fixed: RMS of a coordinate, extents; above rounding
    const auto count = static_cast<double>(num_frames_);
    Vec3d sum = Vec3d::Zero();
    double square = 0.0;
    for (std::size_t f = 0; f < num_frames_; ++f) {
      const Vec3d d =
          seen_[i * num_frames_ + f] - first(i) - seen_[j * num_frames_ + f] + first(j);
      sum += d;
      square += d.squaredNorm();
    }
    return (square - sum.squaredNorm() / count) / (3.0 * count) < kRigid * kRigid;
  }

 private:
  std::size_t num_frames_;
  std::vector<Vec3d> seen_;  // [vertex][frame]
};

class Connection {
 public:
  Connection(const Trajectories& t, const VertexRings& rings, BoneRotations& rotations)
      : t_(t), rings_(rings), rotations_(rotations) {}

  BoneChains run() {
    find_members();
    spread_members();
    find_anchors();
    count_shared();
    find_joints();
    hang_others();
    return std::move(chains_);
  }

 private:
  // tuned: Vertices of the patches whose spans are looked at. Small ones show which bones a
  // vertex follows, large ones all of these bones.
  static constexpr std::array<std::size_t, 3> kMemberSizes{8, 12, 16};

  struct Patch {
    std::uint32_t centre = 0;
    Bones bones;
    bool is_joint = false;  // its bones explain how it moves, so they are joined
  };

  std::size_t num_bones() const { return rotations_.bones.size(); }

  Patch look_at(std::uint32_t centre, std::size_t size) const {
    constexpr double kTolerance = 10.0 * kExactMotion;  // fixed: rotations are less exact
    constexpr double kInside = 1e-3;  // fixed: as exact as rotations are found
    constexpr std::size_t kMany = 4;  // fixed: bones of a usual patch
    const TrajectorySpan span(t_, vertices_around(rings_, centre, size), kTolerance);
    Patch patch{centre, {}, false};
    if (span.rank() < 2) return patch;
    std::vector<const Rotations*> inside;
    for (std::size_t b = 0; b < num_bones(); ++b) {
      const Rotations& rotation = rotations_.bones[b].rotation;
      if (!(span.distance(rotation) < kInside)) continue;
      patch.bones.push_back(static_cast<std::uint32_t>(b));
      inside.push_back(&rotation);
    }
    if (inside.size() > 1 && inside.size() <= kMany) {
      patch.is_joint = span.unexplained(orthonormal_columns(inside)) < kExplained;
    }
    return patch;
  }

  void find_members() {
    constexpr std::size_t kSample = 3000;  // fixed: time
    constexpr std::size_t kTogether = 16;  // fixed: vertices of a pass
    const std::size_t n = t_.num_vertices();
    const std::size_t count = std::min(n, kSample);
    patches_.resize(count * kMemberSizes.size());
    for_ranges(count, kTogether, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        for (std::size_t k = 0; k < kMemberSizes.size(); ++k) {
          patches_[i * kMemberSizes.size() + k] =
              look_at(static_cast<std::uint32_t>(i * n / count), kMemberSizes[k]);
        }
      }
    });
  }

  // Gives each vertex the bones of the smallest patch that shows any, and those of its
  // neighbours.
  void spread_members() {
    std::vector<Bones>& list = chains_.candidates;
    list.resize(t_.num_vertices());
    for (const Patch& patch : patches_) {
      if (list[patch.centre].empty()) list[patch.centre] = patch.bones;
    }
    list = with_neighbours(list);
    for (;;) {
      const std::vector<Bones> wider = with_neighbours(list);
      bool is_done = true;
      for (std::size_t v = 0; v < list.size(); ++v) {
        if (!list[v].empty() || wider[v].empty()) continue;
        list[v] = wider[v];
        is_done = false;
      }
      if (is_done) break;
    }
  }

  std::vector<Bones> with_neighbours(const std::vector<Bones>& bones) const {
    std::vector<Bones> result = bones;
    for (std::size_t v = 0; v < result.size(); ++v) {
      Bones& list = result[v];
      for (const std::uint32_t u : rings_[v]) {
        list.insert(list.end(), bones[u].begin(), bones[u].end());
      }
      sort_without_repetitions(list);
    }
    return result;
  }

  // Returns the sets of vertices that move rigidly with a rotation, the largest first.
  std::vector<std::vector<std::uint32_t>> anchors_of(std::size_t bone) const {
    std::vector<std::uint32_t> vertices;
    std::vector<std::size_t> place(t_.num_vertices(), BoneChains::kNone);
    for (std::uint32_t v = 0; v < t_.num_vertices(); ++v) {
      if (!has(chains_.candidates[v], bone)) continue;
      place[v] = vertices.size();
      vertices.push_back(v);
    }
    const SeenFromBone seen(t_, rotations_.bones[bone].rotation, vertices);
    Groups groups(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (const std::uint32_t u : rings_[vertices[i]]) {
        if (u <= vertices[i] || place[u] == BoneChains::kNone) continue;
        if (groups.of(i) == groups.of(place[u])) continue;
        if (seen.move_together(i, place[u])) groups.join(i, place[u]);
      }
    }
    std::vector<std::vector<std::size_t>> sets(vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) sets[groups.of(i)].push_back(i);
    std::erase_if(sets, [](const auto& set) { return set.size() < 2; });
    // Parts of the mesh without an edge between them may move together.
    std::vector<std::vector<std::size_t>> joined;
    for (const auto& set : sets) {
      const auto same = std::find_if(joined.begin(), joined.end(), [&](const auto& other) {
        return seen.move_together(other.front(), set.front());
      });
      if (same == joined.end()) {
        joined.push_back(set);
      } else {
        same->insert(same->end(), set.begin(), set.end());
      }
    }
    std::stable_sort(joined.begin(), joined.end(),
                     [](const auto& x, const auto& y) { return x.size() > y.size(); });
    std::vector<std::vector<std::uint32_t>> result;
    for (const auto& set : joined) {
      std::vector<Vec3d> points;
      std::vector<std::uint32_t> anchors;
      for (const std::size_t i : set) {
        points.push_back(seen.first(i));
        anchors.push_back(vertices[i]);
      }
      if (set.size() >= kFewAnchors && !are_straight(points)) result.push_back(anchors);
    }
    return result;
  }

  void find_anchors() {
    constexpr std::size_t kMaxBones = 128;  // fixed: time and memory
    const std::size_t num_rotations = num_bones();
    std::vector<std::vector<std::vector<std::uint32_t>>> sets(num_rotations);
    for_each(num_rotations, [&](std::size_t b) { sets[b] = anchors_of(b); });
    chains_.bones.resize(num_rotations);
    for (std::size_t b = 0; b < num_rotations; ++b) {
      for (std::size_t k = 0; k < sets[b].size(); ++k) {
        if (k > 0 && num_bones() == kMaxBones) break;
        set_anchors(k == 0 ? b : add_twin(b), sets[b][k]);
      }
    }
  }

  // Adds a bone with the rotation of another.
  std::size_t add_twin(std::size_t bone) {
    const auto twin = static_cast<std::uint32_t>(num_bones());
    rotations_.bones.push_back(BoneRotation(rotations_.bones[bone]));
    chains_.bones.emplace_back();
    for (Bones& list : chains_.candidates) {
      if (has(list, bone)) list.push_back(twin);
    }
    return twin;
  }

  void set_anchors(std::size_t b, std::vector<std::uint32_t> anchors) {
    BoneChains::Bone& bone = chains_.bones[b];
    for (const std::uint32_t v : anchors) {
      bone.pivot += t_.position(0, v) / static_cast<double>(anchors.size());
    }
    bone.anchors = std::move(anchors);
  }

  // Counts the patches that pairs of bones share. Those that few others share, and that their
  // bones explain, tell most.
  void count_shared() {
    constexpr double kOther = -3.0;     // fixed: log2 of the factor for each other bone
    constexpr double kUnknown = -10.0;  // fixed: and for patches that may have more bones
    const std::size_t n = num_bones();
    shared_.assign(n * n, 0.0);
    place_.assign(n * n, Vec3d::Zero());
    for (const Patch& patch : patches_) {
      if (patch.bones.size() < 2) continue;
      const double weight = det_exp2(kOther * (static_cast<double>(patch.bones.size()) - 2.0) +
                                     (patch.is_joint ? 0.0 : kUnknown));
      for (const std::uint32_t a : patch.bones) {
        for (const std::uint32_t b : patch.bones) {
          shared_[a * n + b] += weight;
          place_[a * n + b] += weight * t_.position(0, patch.centre);
        }
      }
    }
  }

  // Finds the points at which anchored bones are joined, first those between bones that share
  // many patches.
  void find_joints() {
    struct Candidate {
      double shared = 0.0;
      double gap = 0.0;
      BoneChains::Joint joint;
    };
    constexpr double kClosed = 1e-5;  // fixed: extents; above rounding
    constexpr double kFar = 10.0;     // fixed: extents; such points are due to rounding
    const std::size_t n = num_bones();
    std::vector<std::vector<Vec3d>> origins(n);
    for (std::size_t b = 0; b < n; ++b) {
      const auto& anchors = chains_.bones[b].anchors;
      if (anchors.empty()) continue;
      for (std::size_t f = 0; f < t_.num_frames(); ++f) {
        origins[b].push_back(t_.mean(f, anchors));
      }
    }
    std::vector<Candidate> candidates;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = a + 1; b < n; ++b) {
        if (origins[a].empty() || origins[b].empty()) continue;
        Candidate c{shared_[a * n + b], 0.0, {a, b, Vec3d::Zero()}};
        c.gap = close_joint(origins[a], origins[b], c.joint);
        if (c.gap < kClosed && c.joint.at.norm() < kFar) candidates.push_back(c);
      }
    }
    std::stable_sort(candidates.begin(), candidates.end(),
                     [](const Candidate& x, const Candidate& y) {
                       return x.shared != y.shared ? x.shared > y.shared : x.gap < y.gap;
                     });
    Groups groups(n);
    for (const Candidate& c : candidates) {
      if (groups.join(c.joint.first, c.joint.second)) chains_.joints.push_back(c.joint);
    }
  }

  // Finds the point that two bones move most alike. Returns the RMS of a coordinate of the
  // distance between its places.
  double close_joint(std::span<const Vec3d> first_origin, std::span<const Vec3d> second_origin,
                     BoneChains::Joint& joint) const {
    const std::size_t pair = joint.first * num_bones() + joint.second;
    const BoneChains::Bone& first = chains_.bones[joint.first];
    const BoneChains::Bone& second = chains_.bones[joint.second];
    joint.at = shared_[pair] > 0.0 ? Vec3d(place_[pair] / shared_[pair])
                                   : Vec3d(0.5 * (first.pivot + second.pivot));
    const auto gap = [&](std::size_t f) -> Vec3d {
      return rotations_.bones[joint.first].rotation[f] * (joint.at - first.pivot) +
             first_origin[f] -
             rotations_.bones[joint.second].rotation[f] * (joint.at - second.pivot) -
             second_origin[f];
    };
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    Vec3d g = Vec3d::Zero();
    for (std::size_t f = 0; f < t_.num_frames(); ++f) {
      const Eigen::Matrix3d turn = rotations_.bones[joint.first].rotation[f] -
                                   rotations_.bones[joint.second].rotation[f];
      h += turn.transpose() * turn;
      g -= turn.transpose() * gap(f);
    }
    constexpr double kPull = 1e-7;  // fixed: of a hinge, the point of the axis that is nearest
    constexpr double kStill = 1e-12;  // fixed: bones that turn less together share all points
    h += (kPull * h.trace() + kStill) * Eigen::Matrix3d::Identity();
    std::vector<double> x(g.data(), g.data() + 3);
    SymmetricSystem({h.data(), h.data() + 9}, 3).solve(x);
    joint.at += Vec3d(x[0], x[1], x[2]);
    double square = 0.0;
    for (std::size_t f = 0; f < t_.num_frames(); ++f) square += gap(f).squaredNorm();
    return std::sqrt(square / (3.0 * static_cast<double>(t_.num_frames())));
  }

  void hang_others() {
    const std::size_t n = num_bones();
    std::vector<bool> has_place(n);
    for (std::size_t b = 0; b < n; ++b) {
      has_place[b] = !chains_.bones[b].anchors.empty();
      if (has_place[b]) chains_.order.push_back(b);
    }
    for (;;) {
      double max = 0.0;
      std::size_t from = 0;
      std::size_t to = 0;
      for (const std::size_t a : chains_.order) {
        for (std::size_t b = 0; b < n; ++b) {
          if (has_place[b] || !(shared_[a * n + b] > max)) continue;
          max = shared_[a * n + b];
          from = a;
          to = b;
        }
      }
      if (max == 0.0) break;
      chains_.bones[to].parent = from;
      chains_.bones[to].pivot = place_[from * n + to] / max;
      has_place[to] = true;
      chains_.order.push_back(to);
    }
  }

  const Trajectories& t_;
  const VertexRings& rings_;
  BoneRotations& rotations_;
  std::vector<Patch> patches_;  // [vertex of the sample][patch size]
  std::vector<double> shared_;  // [bone][bone]
  std::vector<Vec3d> place_;    // [bone][bone], sum of the places that they share
  BoneChains chains_;
};

}  // namespace

BoneChains connect_bones(const Trajectories& trajectories, const VertexRings& rings,
                         BoneRotations& rotations) {
  return Connection(trajectories, rings, rotations).run();
}

}  // namespace rlpc
