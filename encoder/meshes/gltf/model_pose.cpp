#include "encoder/meshes/gltf/model_pose.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace rlpc {
namespace {

GltfVec3 linear(const Affine& map, const GltfVec3& n) {
  GltfVec3 image{};
  for (std::size_t i = 0; i < 3; ++i) {
    image[i] = map.row[i][0] * n[0] + map.row[i][1] * n[1] + map.row[i][2] * n[2];
  }
  return image;
}

// Returns the image of a normal: the direction of the inverse transpose.
GltfVec3 normal_image(const Affine& map, const GltfVec3& n) {
  const auto& m = map.row;
  const double sign = determinant(map) < 0.0 ? -1.0 : 1.0;
  GltfVec3 image{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& a = m[(i + 1) % 3];
    const auto& b = m[(i + 2) % 3];
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t k = (j + 1) % 3;
      const std::size_t l = (j + 2) % 3;
      image[i] += sign * (a[k] * b[l] - a[l] * b[k]) * n[j];
    }
  }
  return image;
}

void append_unit(const GltfVec3& n, std::vector<float>& out) {
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (const double x : n) out.push_back(length > 0.0 ? static_cast<float>(x / length) : 0.0F);
}

const GltfGeometry::Attribute* normals_of(const GltfGeometry& geometry) {
  const auto found =
      std::find_if(geometry.attributes.begin(), geometry.attributes.end(),
                   [](const auto& attribute) { return attribute.semantic == "NORMAL"; });
  return found == geometry.attributes.end() || found->width != 3 ? nullptr : &*found;
}

}  // namespace

const std::vector<double>& target_weights(const GltfModel& model, std::uint32_t node,
                                          const GltfPose& pose) {
  const auto moved = pose.weights.find(node);
  if (moved != pose.weights.end()) return moved->second;
  const GltfNode& n = model.nodes[node];
  return n.weights ? *n.weights : model.weights[*n.mesh];
}

std::vector<Affine> joint_maps(const GltfModel& model, std::uint32_t skin,
                               const GltfPose& pose) {
  const GltfModel::Skin& s = model.skins[skin];
  std::vector<Affine> joints;
  for (std::size_t j = 0; j < s.joints.size(); ++j) {
    joints.push_back(pose.to_scene[s.joints[j]] * s.inverse_bind[j]);
  }
  return joints;
}

void PosedModel::positions(const GltfModel::Instance& instance, std::span<float> out) {
  placed_.resize(out.size());
  positions(instance, std::span<double>(placed_));
  std::transform(placed_.begin(), placed_.end(), out.begin(),
                 [](double x) { return static_cast<float>(x); });
}

void PosedModel::positions(const GltfModel::Instance& instance, std::span<double> out) {
  const GltfGeometry& geometry = model_.geometries[instance.geometry];
  morph(geometry.base, geometry.targets, target_weights(model_, instance.node, pose_),
        morphed_);
  if (!instance.skin) return place(morphed_, pose_.to_scene[instance.node], out);
  const auto [maps, is_new] = joints_.try_emplace(*instance.skin);
  if (is_new) maps->second = joint_maps(model_, *instance.skin, pose_);
  place_by_joints(geometry, morphed_, maps->second, out);
}

std::vector<float> posed_normals(const GltfModel& model, const GltfPose& pose) {
  std::vector<float> all;
  for (const GltfModel::Instance& instance : model.instances) {
    const GltfGeometry& geometry = model.geometries[instance.geometry];
    const auto* const normals = normals_of(geometry);
    if (normals == nullptr) {
      all.resize(all.size() + geometry.base.size());
      continue;
    }
    std::vector<double> morphed;
    morph(normals->values, geometry.normal_targets, target_weights(model, instance.node, pose),
          morphed);
    std::vector<Affine> joints;
    if (instance.skin) joints = joint_maps(model, *instance.skin, pose);
    for (std::size_t v = 0; v < geometry.num_vertices(); ++v) {
      const GltfVec3 n{morphed[3 * v], morphed[3 * v + 1], morphed[3 * v + 2]};
      if (!instance.skin) {
        append_unit(normal_image(pose.to_scene[instance.node], n), all);
        continue;
      }
      GltfVec3 sum{};
      for (auto i = geometry.first_influence[v]; i < geometry.first_influence[v + 1]; ++i) {
        const GltfInfluence& influence = geometry.influences[static_cast<std::size_t>(i)];
        const GltfVec3 moved = linear(joints[influence.joint], n);
        for (std::size_t c = 0; c < 3; ++c) sum[c] += influence.weight * moved[c];
      }
      append_unit(sum, all);
    }
  }
  return all;
}

}  // namespace rlpc
