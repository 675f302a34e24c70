// A target holds differences from frame 0. If a difference is not exact in 32-bit floats, the
// sum would miss the position; the target of such a frame holds its positions, combined with a
// common target that cancels frame 0.
#include "decoder/meshes/gltf/gltf_morph.h"

#include <utility>

#include "common/files/glb.h"
#include "decoder/meshes/gltf/glb_animation.h"

namespace rlpc {
namespace {

// Returns the differences of a frame from frame 0; none if any sum would not be exact.
std::optional<std::vector<float>> exact_moves(std::span<const float> from,
                                              std::span<const float> to) {
  std::vector<float> moves(from.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    moves[i] = to[i] - from[i];
    if (double{from[i]} + double{moves[i]} != double{to[i]}) return std::nullopt;
  }
  return moves;
}

}  // namespace

void GltfMorph::add_frame(std::span<const float> xyz) {
  GlbBuffers& buffers = document_.buffers;
  std::vector<float> places = expanded_values(mesh_, xyz, 3);
  if (num_frames_ == 0) {
    base_ = std::move(places);
    attributes_["POSITION"] = buffers.add_vectors(base_);
    if (look_.has_normals()) {
      base_normals_ = look_.normals(xyz);
      attributes_["NORMAL"] = buffers.add_normals(base_normals_);
    }
    look_.add_values(attributes_, buffers);
  } else if (const auto moves = exact_moves(base_, places)) {
    if (const auto accessor = buffers.add_moves(*moves)) {
      weights_.push_back({num_frames_, add_target(*accessor)});
      add_normal_moves(xyz);
    }
  } else {
    weights_.push_back({num_frames_, minus_base_target()});
    weights_.push_back({num_frames_, add_target(buffers.add_vectors(places))});
    add_normal_moves(xyz);
  }
  ++num_frames_;
}

// Adds the changes of the normals in a frame to its target, the last one.
void GltfMorph::add_normal_moves(std::span<const float> xyz) {
  if (base_normals_.empty()) return;
  std::vector<float> moves = look_.normals(xyz);
  for (std::size_t i = 0; i < moves.size(); ++i) moves[i] -= base_normals_[i];
  targets_.back()["NORMAL"] = document_.buffers.add_normals(moves);
}

std::uint32_t GltfMorph::add_target(std::uint32_t accessor) {
  targets_.push_back({{"POSITION", accessor}});
  return static_cast<std::uint32_t>(targets_.size() - 1);
}

// Returns the target that cancels frame 0. It precedes the targets of the frames that need it,
// so that sums stay exact.
std::uint32_t GltfMorph::minus_base_target() {
  if (!minus_base_) {
    std::vector<float> minus(base_.size());
    for (std::size_t i = 0; i < base_.size(); ++i) minus[i] = 0 - base_[i];
    minus_base_ = add_target(document_.buffers.add_vectors(minus));
  }
  return *minus_base_;
}

// Adds the weights of all targets in the frames of a clip.
std::uint32_t GltfMorph::weights_of(const Clip& clip) {
  std::vector<std::uint32_t> places;
  for (const Weight& w : weights_) {
    if (w.frame < clip.first_frame || w.frame > clip.last_frame()) continue;
    places.push_back(
        static_cast<std::uint32_t>((w.frame - clip.first_frame) * targets_.size() + w.target));
  }
  return document_.buffers.add_ones(places, std::uint64_t{clip.num_frames} * targets_.size());
}

bool GltfMorph::finish(std::span<const Clip> spans, FrameRate frame_rate) {
  GlbBuffers& buffers = document_.buffers;
  std::uint64_t max_weights = 0;
  for (const Clip& clip : spans) {
    max_weights += std::uint64_t{clip.num_frames} * (targets_.size() + 1);
  }
  if (max_weights > kMaxGlbBytes) return false;
  if (num_frames_ > 1 && targets_.empty()) {
    // An animation without motion still has a duration.
    add_target(buffers.add_zero_vectors(static_cast<std::uint32_t>(mesh_.vertex.size())));
  }
  GltfJson& root = document_.root;
  root["scene"] = 0;
  root["scenes"] = GltfJson::array({{{"nodes", GltfJson::array({0})}}});
  root["nodes"] = GltfJson::array({{{"mesh", 0}}});
  look_.add_materials(root, buffers);
  for (GltfJson& target : targets_) {
    // All targets have the same attributes.
    if (!base_normals_.empty() && !target.contains("NORMAL")) {
      target["NORMAL"] =
          buffers.add_zero_vectors(static_cast<std::uint32_t>(mesh_.vertex.size()));
    }
  }
  GltfJson mesh = {{"primitives", primitives_of(mesh_, attributes_, targets_, buffers)}};
  if (!targets_.empty()) mesh["weights"] = std::vector<int>(targets_.size(), 0);
  root["meshes"] = GltfJson::array({std::move(mesh)});
  if (num_frames_ == 1) return true;
  GltfJson animations = GltfJson::array();
  for (const Clip& clip : spans) {
    GlbAnimation animation(buffers, clip, frame_rate);
    animation.add_channel(0, "weights", animation.all_frames(), weights_of(clip));
    animations.push_back(animation.json());
  }
  root["animations"] = std::move(animations);
  return true;
}

}  // namespace rlpc
