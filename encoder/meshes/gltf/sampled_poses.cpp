#include "encoder/meshes/gltf/sampled_poses.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rlpc {
namespace {

constexpr std::uint32_t kMaxExamined = 4096;               // fixed: frames, for time
constexpr std::size_t kMaxVolumes = std::size_t{1} << 20;  // fixed: memory, and time
constexpr double kShown = 0.125;  // fixed: part of the largest volume; half of the size

// Returns the nodes that place vertices: those of instances without skin, and joints.
std::vector<std::uint32_t> placing_nodes(const GltfModel& model) {
  std::vector<std::uint32_t> nodes;
  std::vector<bool> is_taken(model.skins.size());  // many instances may have the same skin
  for (const GltfModel::Instance& instance : model.instances) {
    nodes.push_back(instance.node);
    if (!instance.skin || is_taken[*instance.skin]) continue;
    is_taken[*instance.skin] = true;
    const auto& joints = model.skins[*instance.skin].joints;
    nodes.insert(nodes.end(), joints.begin(), joints.end());
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

// Determinants of nodes over time.
class NodeVolumes {
 public:
  NodeVolumes(std::vector<std::uint32_t> nodes, std::size_t num_frames)
      : nodes_(std::move(nodes)), volumes_(nodes_.size(), std::vector<double>(num_frames)) {}

  void set(std::size_t i, const GltfPose& pose) {
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      volumes_[n][i] = determinant(pose.to_scene[nodes_[n]]);
    }
  }
  // Returns the frame in which node n is largest, the first of several.
  std::size_t largest(std::size_t n) const {
    const auto found = std::max_element(
        volumes_[n].begin(), volumes_[n].end(),
        [](double a, double b) { return std::abs(a) < std::abs(b) * (1.0 - 1e-6); });
    return static_cast<std::size_t>(found - volumes_[n].begin());
  }
  double size(std::size_t n, std::size_t i) const { return std::abs(volumes_[n][i]); }
  bool is_mirrored(std::uint32_t node) const {
    const std::size_t n = index_of(node);
    return volumes_[n][largest(n)] < 0.0;
  }
  // Whether a node has both signs in frames in which it is visible.
  bool turns_over(std::uint32_t node) const {
    constexpr double kVisible = 1e-6;  // fixed: of the largest volume: a hundredth of the size
    const std::size_t n = index_of(node);
    const double min = kVisible * size(n, largest(n));
    const auto has = [&](double sign) {
      return std::any_of(volumes_[n].begin(), volumes_[n].end(),
                         [&](double x) { return sign * x > min; });
    };
    return has(1.0) && has(-1.0);
  }
  std::size_t count() const { return nodes_.size(); }

 private:
  std::size_t index_of(std::uint32_t node) const {
    return static_cast<std::size_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) -
                                    nodes_.begin());
  }

  std::vector<std::uint32_t> nodes_;          // ascending
  std::vector<std::vector<double>> volumes_;  // [node][frame]
};

// Returns frames at equal distances to examine, including the first and the last.
std::vector<std::uint32_t> spread_out(std::uint32_t num_frames, std::size_t count) {
  std::vector<std::uint32_t> frames{0};
  for (std::size_t i = 1; i < count; ++i) {
    const auto f = static_cast<std::uint32_t>(std::uint64_t{num_frames - 1} * i / (count - 1));
    if (f != frames.back()) frames.push_back(f);
  }
  return frames;
}

}  // namespace

SampledPoses sample_poses(const GltfModel& model, std::uint32_t num_frames, std::size_t max,
                          const std::function<GltfPose(std::uint32_t)>& pose_at) {
  std::vector<std::uint32_t> nodes = placing_nodes(model);
  const std::size_t max_frames =
      std::clamp<std::size_t>(kMaxVolumes / (nodes.size() + 1), 2, kMaxExamined);
  const std::vector<std::uint32_t> examined =
      spread_out(num_frames, std::min<std::size_t>(num_frames, max_frames));
  NodeVolumes volumes(std::move(nodes), examined.size());
  for (std::size_t i = 0; i < examined.size(); ++i) volumes.set(i, pose_at(examined[i]));
  SampledPoses sampled;
  for (const GltfModel::Instance& instance : model.instances) {
    sampled.is_mirrored.push_back(volumes.is_mirrored(instance.node));
    if (!instance.skin && volumes.turns_over(instance.node)) ++sampled.num_turning_over;
  }
  // Half of the frames are at equal distances, the others where nodes are largest.
  std::vector<std::size_t> chosen{0};
  const std::vector<std::uint32_t> even = spread_out(num_frames, 1 + (max + 1) / 2);
  for (const std::uint32_t f : even) {
    chosen.push_back(static_cast<std::size_t>(
        std::lower_bound(examined.begin(), examined.end(), f) - examined.begin()));
  }
  for (std::size_t n = 0; n < volumes.count() && chosen.size() <= max + 1; ++n) {
    const std::size_t largest = volumes.largest(n);
    const bool is_shown = std::any_of(chosen.begin(), chosen.end(), [&](std::size_t i) {
      return volumes.size(n, i) >= kShown * volumes.size(n, largest);
    });
    if (!is_shown) chosen.push_back(largest);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  for (const std::size_t i : chosen) {
    if (i > 0 && max > 0) sampled.later.push_back({examined[i], pose_at(examined[i])});
  }
  return sampled;
}

}  // namespace rlpc
