// Vertices and triangles of one primitive of a glTF mesh, and their positions in a pose.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"
#include "encoder/input/gltf/document/affine.h"
#include "encoder/input/gltf/document/document.h"
#include "encoder/input/gltf/document/values.h"

namespace rlpc {

// One of the joints that a vertex follows.
struct GltfInfluence {
  std::uint32_t joint = 0;
  float weight = 0.0F;  // above 0
};

struct GltfGeometry {
  struct Target {
    std::size_t number = 0;  // of the mesh
    std::vector<GltfDelta> deltas;
  };

  std::vector<float> base;      // xyz per vertex
  std::vector<Target> targets;  // those that move a vertex
  // Of vertex v: from influences[first_influence[v]] up to, not including, that of v + 1; at
  // least one. Both are empty without a skin.
  std::vector<GltfInfluence> influences;
  std::vector<std::uint64_t> first_influence;
  std::vector<Triangle> triangles;

  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(base.size() / 3); }
};

// num_joints: of its skin; 0: none, and influences are not read. Joints and indices are in
// range. Complete only if there are no errors.
GltfGeometry read_gltf_geometry(const GltfPrimitive& primitive, std::size_t num_joints,
                                GltfValues& values, GltfErrors& errors);

// Base plus weighted targets, before nodes or joints are applied: 3 per vertex. Weights: of all
// targets of the mesh.
void morph(const GltfGeometry& geometry, std::span<const double> weights,
           std::vector<double>& positions);

// To the scene, by the map of a node, or by the weighted maps of the joints. out: 3 per vertex.
void place(const std::vector<double>& positions, const Affine& node, std::span<float> out);
void place_by_joints(const GltfGeometry& geometry, const std::vector<double>& positions,
                     const std::vector<Affine>& joints, std::span<float> out);

}  // namespace rlpc
