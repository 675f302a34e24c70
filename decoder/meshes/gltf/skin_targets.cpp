#include "decoder/meshes/gltf/skin_targets.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

#include "decoder/meshes/gltf/skin_joints.h"

namespace rlpc {
namespace {

using Eigen::Index;

// RMS by which dropping keys may turn normals: about half a degree. Half and twice change files
// by at most 0.01 % (cesium-man).
constexpr double kNormalTolerance = 0.01;

// Returns the RMS of the moves by a weight of 1.
Eigen::VectorXf lengths_of(const PrincipalShapes& shapes) {
  return shapes.targets.colwise().norm() /
         std::sqrt(std::max(1.0F, static_cast<float>(shapes.targets.rows()) / 3));
}

Eigen::MatrixXf stacked(const Eigen::MatrixXf& a, const Eigen::MatrixXf& b) {
  Eigen::MatrixXf both(a.rows() + b.rows(), a.cols());
  both << a, b;
  return both;
}

void add_targets(GltfJson& targets, const PrincipalShapes& shapes, const char* path,
                 const GlbMesh* expand, GlbBuffers& buffers) {
  for (Index k = 0; k < shapes.targets.cols(); ++k) {
    std::vector<std::int8_t> bytes;
    for (const float x : shapes.targets.col(k)) {
      bytes.push_back(static_cast<std::int8_t>(std::lround(x / shapes.unit)));
    }
    if (expand != nullptr) bytes = expanded_values<std::int8_t>(*expand, bytes, 3);
    targets.push_back({{path, buffers.add_byte_vectors(bytes, shapes.unit < 1)}});
  }
}

}  // namespace

TargetTrack target_track(const SkinTargets& targets, const Clip& clip, double tolerance) {
  const auto clip_weights = [&](const PrincipalShapes& shapes) {
    return shapes.weights.middleCols(clip.first_frame, clip.num_frames);
  };
  const Eigen::MatrixXf weights =
      stacked(clip_weights(targets.places), clip_weights(targets.normals));
  Eigen::VectorXf costs(weights.rows());
  costs << lengths_of(targets.places) / static_cast<float>(tolerance),
      lengths_of(targets.normals) / static_cast<float>(kNormalTolerance);
  TargetTrack track;
  track.keys = needed_keys(clip.num_frames, [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t f = a + 1; f < b; ++f) {
      const float t = static_cast<float>(f - a) / static_cast<float>(b - a);
      const Eigen::VectorXf apart =
          weights.col(a) + t * (weights.col(b) - weights.col(a)) - weights.col(f);
      const auto cost = apart.cwiseProduct(costs);
      if (cost.head(targets.places.targets.cols()).squaredNorm() > 1) return false;
      if (cost.tail(targets.normals.targets.cols()).squaredNorm() > 1) return false;
    }
    return true;
  });
  const std::size_t bytes_of_key = static_cast<std::size_t>(weights.rows()) * sizeof(float);
  track.keys = keys_to_write(std::move(track.keys), clip.num_frames, bytes_of_key);
  track.weights.resize(weights.rows(), static_cast<Index>(track.keys.size()));
  for (std::size_t i = 0; i < track.keys.size(); ++i) {
    track.weights.col(static_cast<Index>(i)) = weights.col(track.keys[i]);
  }
  return track;
}

Eigen::MatrixXf shown_weights(const SkinTargets& targets, std::span<const TargetTrack> tracks,
                              std::span<const Clip> spans) {
  Eigen::MatrixXf shown = targets.places.weights;
  const Index count = shown.rows();
  for (std::size_t i = spans.size(); i-- > 0;) {
    const TargetTrack& track = tracks[i];
    for (std::size_t k = 0; k + 1 < track.keys.size(); ++k) {
      const std::uint32_t a = track.keys[k];
      const std::uint32_t b = track.keys[k + 1];
      const auto from = track.weights.col(static_cast<Index>(k)).head(count);
      const auto to = track.weights.col(static_cast<Index>(k + 1)).head(count);
      for (std::uint32_t f = a; f <= b; ++f) {
        const float t = static_cast<float>(f - a) / static_cast<float>(b - a);
        shown.col(spans[i].first_frame + f) = from + t * (to - from);
      }
    }
  }
  return shown;
}

GltfJson targets_of(const SkinTargets& targets, const GlbMesh& mesh, GlbBuffers& buffers) {
  GltfJson json = GltfJson::array();
  add_targets(json, targets.places, "POSITION", &mesh, buffers);
  if (targets.normals.targets.cols() == 0) return json;
  add_targets(json, targets.normals, "NORMAL", nullptr, buffers);
  // All targets have the same attributes.
  const std::uint32_t zeros =
      buffers.add_zero_vectors(static_cast<std::uint32_t>(mesh.vertex.size()));
  for (GltfJson& target : json) {
    for (const char* const path : {"POSITION", "NORMAL"}) {
      if (!target.contains(path)) target[path] = zeros;
    }
  }
  return json;
}

GltfJson first_weights(const SkinTargets& targets) {
  GltfJson json = GltfJson::array();
  for (const float w : targets.places.weights.col(0)) json.push_back(w);
  for (const float w : targets.normals.weights.col(0)) json.push_back(w);
  return json;
}

void add_weights(GlbAnimation& animation, std::uint32_t node, const SkinTargets& targets,
                 const TargetTrack& track, GlbBuffers& buffers) {
  const auto values =
      std::span(track.weights.data(), static_cast<std::size_t>(track.weights.size()));
  const auto is_short = [](const PrincipalShapes& shapes) {
    return shapes.targets.cols() == 0 || shapes.has_short_weights;
  };
  const std::uint32_t output = is_short(targets.places) && is_short(targets.normals)
                                   ? buffers.add_short_values(values, "SCALAR")
                                   : buffers.add_values(values, "SCALAR");
  animation.add_channel(node, "weights", track.keys, output);
}

}  // namespace rlpc
