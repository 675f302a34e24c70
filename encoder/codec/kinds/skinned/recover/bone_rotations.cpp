#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr std::size_t kFirst = 64;  // fixed: patches that show whether a mesh was skinned

// Returns the RMS difference of the elements of two rotations.
double difference(const Rotations& a, const Rotations& b) {
  constexpr std::size_t kElements = 9;  // fixed: of a matrix
  double sum = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) sum += (a[f] - b[f]).squaredNorm();
  return std::sqrt(sum / static_cast<double>(kElements * a.size()));
}

// Returns the rotations that best fit a few vertices, relative to the first frame.
Rotations fitted_rotations(const Trajectories& t, std::span<const std::uint32_t> vertices) {
  Rotations result;
  Eigen::Matrix3d near = Eigen::Matrix3d::Identity();
  const auto n = static_cast<double>(vertices.size());
  for (std::size_t f = 0; f < t.num_frames(); ++f) {
    Vec3d first = Vec3d::Zero();
    Vec3d now = Vec3d::Zero();
    for (const std::uint32_t v : vertices) {
      first += t.position(0, v) / n;
      now += t.position(f, v) / n;
    }
    Eigen::Matrix3d h = Eigen::Matrix3d::Zero();
    for (const std::uint32_t v : vertices) {
      h += (t.position(f, v) - now) * (t.position(0, v) - first).transpose();
    }
    near = closest_rotation(h, near);
    result.push_back(near);
  }
  return result;
}

class Search {
 public:
  Search(const Trajectories& trajectories, const VertexRings& rings)
      : t_(trajectories), rings_(rings) {}

  BoneRotations run() {
    // tuned: Vertices of a patch. Bones with small weights show only in patches of more
    // vertices than their motion has dimensions.
    constexpr std::array<std::size_t, 3> kPatchSizes{20, 40, 60};
    std::vector<std::uint32_t> open = centres();
    const auto count = static_cast<double>(open.size());
    for (const std::size_t size : kPatchSizes) open = search(open, size);
    if (bones_.size() < 2) return {};
    return {std::move(bones_), 1.0 - static_cast<double>(open.size()) / count};
  }

 private:
  struct Outcome {
    bool is_explained = false;
    std::optional<BoneRotation> found;
  };

  // Returns the centres of patches, those first that are spread over the mesh.
  std::vector<std::uint32_t> centres() const {
    constexpr std::size_t kMax = 1500;  // fixed: time
    const std::size_t n = t_.num_vertices();
    const std::size_t count = std::min(n, kMax);
    const std::size_t stride = std::max<std::size_t>(count / kFirst, 1);
    std::vector<std::uint32_t> result;
    for (std::size_t start = 0; start < stride; ++start) {
      for (std::size_t i = start; i < count; i += stride) {
        result.push_back(static_cast<std::uint32_t>(i * n / count));
      }
    }
    return result;
  }

  // Returns the centres of patches that the rotations do not explain: all of them if the first
  // patches show hardly any rotations.
  std::vector<std::uint32_t> search(std::span<const std::uint32_t> centres, std::size_t size) {
    constexpr std::size_t kTogether = 16;  // fixed: patches of a pass
    // tuned: Patches in a row that are searched and show nothing new, before no more are.
    constexpr std::size_t kPatience = 200;
    std::vector<std::uint32_t> open;
    std::size_t idle = 0;
    for (std::size_t first = 0; first < centres.size(); first += kTogether) {
      const std::size_t count = std::min(kTogether, centres.size() - first);
      std::array<Outcome, kTogether> outcomes;
      update_columns();
      for_each(count, [&](std::size_t i) {
        outcomes[i] = look_at(centres[first + i], size, idle < kPatience);
      });
      for (std::size_t i = 0; i < count; ++i) {
        if (outcomes[i].is_explained) continue;
        open.push_back(centres[first + i]);
        ++idle;
        if (outcomes[i].found && add(std::move(*outcomes[i].found))) idle = 0;
      }
      if (first + count >= kFirst && bones_.size() < 2) {
        return {centres.begin(), centres.end()};
      }
    }
    return open;
  }

  // Looks at the patch around a vertex, and searches it for a rotation if no rotations explain
  // it.
  Outcome look_at(std::uint32_t centre, std::size_t size, bool searches) const {
    constexpr std::size_t kMaxRank = 48;  // fixed: time
    constexpr std::size_t kCore = 7;      // fixed: a vertex and its ring in a regular mesh
    constexpr double kExact = 3e-6;       // fixed: strain that rounding of floats explains
    const std::vector<std::uint32_t> patch = vertices_around(rings_, centre, size);
    const TrajectorySpan span(t_, patch, kExactMotion);
    if (span.rank() < 3) return {true, std::nullopt};  // too small or too still to show a bone
    // Vertices that move as they like have nearly as many dimensions as there are vertices.
    const bool is_free = 4 * span.rank() > 3 * (patch.size() + 4) || span.rank() > kMaxRank;
    if (is_free) return {};
    if (columns_.count > 0 && span.unexplained(columns_) < kExplained) {
      return {true, std::nullopt};
    }
    if (!searches) return {};
    TrajectorySpan::Found found =
        span.rotation_near(fitted_rotations(t_, vertices_around(rings_, centre, kCore)));
    if (found.error > kExact) return {};
    return {false, BoneRotation{std::move(found.rotation), patch, std::move(found.combination),
                                found.error}};
  }

  // Returns whether a rotation is new. Keeps the more exact one of two that are one.
  bool add(BoneRotation found) {
    constexpr double kSame = 3e-3;  // fixed: a thousand times what rounding explains
    for (BoneRotation& b : bones_) {
      if (difference(b.rotation, found.rotation) > kSame) continue;
      if (found.error < b.error) b = std::move(found);
      return false;
    }
    bones_.push_back(std::move(found));
    return true;
  }

  void update_columns() {
    if (num_columns_of_ == bones_.size()) return;
    num_columns_of_ = bones_.size();
    std::vector<const Rotations*> all;
    for (const BoneRotation& b : bones_) all.push_back(&b.rotation);
    columns_ = orthonormal_columns(all);
  }

  const Trajectories& t_;
  const VertexRings& rings_;
  std::vector<BoneRotation> bones_;
  RotationColumns columns_;         // of bones_
  std::size_t num_columns_of_ = 0;  // bones that have columns
};

}  // namespace

BoneRotations find_bone_rotations(const Trajectories& trajectories, const VertexRings& rings) {
  return Search(trajectories, rings).run();
}

}  // namespace rlpc
