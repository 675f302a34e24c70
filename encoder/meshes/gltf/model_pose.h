// Applies a pose to the meshes of a model: weights of morph targets, maps of joints.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/gltf/pose.h"

namespace rlpc {

// Returns the weights of the targets of the mesh of a node.
const std::vector<double>& target_weights(const GltfModel& model, std::uint32_t node,
                                          const GltfPose& pose);
// Returns maps from the mesh to scene coordinates, [joint of the skin].
std::vector<Affine> joint_maps(const GltfModel& model, std::uint32_t skin,
                               const GltfPose& pose);

// Computes positions of instances in a pose. Keeps references to both.
class PosedModel {
 public:
  PosedModel(const GltfModel& model, const GltfPose& pose) : model_(model), pose_(pose) {}

  // out: xyz of the vertices of the instance.
  void positions(const GltfModel::Instance& instance, std::span<double> out);
  void positions(const GltfModel::Instance& instance, std::span<float> out);

 private:
  const GltfModel& model_;
  const GltfPose& pose_;
  std::map<std::uint32_t, std::vector<Affine>> joints_;  // [skin]
  std::vector<double> morphed_;
  std::vector<double> placed_;
};

// Returns the normals of all vertices, in the order of instances, as viewers compute them in a
// pose: for skins by the linear part of the weighted joints, for others by the inverse
// transpose of their node's map, both after morph targets; of length 1, or zero, as where a
// primitive has none.
std::vector<float> posed_normals(const GltfModel& model, const GltfPose& pose);

}  // namespace rlpc
