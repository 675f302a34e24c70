#include "encoder/meshes/gltf/pose.h"

namespace rlpc {

namespace {

// The properties of a node that tracks can animate.
struct Place {
  GltfVec3 translation;
  GltfQuaternion rotation;
  GltfVec3 scale;
};

}  // namespace

GltfPose pose_of(const std::vector<GltfNode>& nodes, const GltfScene& scene,
                 const GltfClip* clip, double time) {
  GltfPose pose;
  std::vector<Place> places;
  places.reserve(nodes.size());
  for (const GltfNode& node : nodes) {
    places.push_back({node.translation, node.rotation, node.scale});
  }
  for (std::size_t i = 0; clip && i < clip->channels.size(); ++i) {
    const auto& [node, path, track] = clip->channels[i];
    switch (path) {
      case GltfPath::kTranslation:
        sample(track, time, places[node].translation);
        break;
      case GltfPath::kRotation:
        places[node].rotation = sample_rotation(track, time);
        break;
      case GltfPath::kScale:
        sample(track, time, places[node].scale);
        break;
      case GltfPath::kWeights:
        sample(track, time, pose.weights.try_emplace(node, track.width).first->second);
        break;
    }
  }
  pose.to_scene.resize(nodes.size());
  for (const std::uint32_t n : scene.parents_first) {
    const Place& p = places[n];
    const Affine local =
        nodes[n].matrix ? *nodes[n].matrix : affine_of(p.translation, p.rotation, p.scale);
    pose.to_scene[n] = scene.parent[n] ? pose.to_scene[*scene.parent[n]] * local : local;
  }
  return pose;
}

}  // namespace rlpc
