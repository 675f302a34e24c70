// Reads one primitive of a glTF mesh, and computes its positions in a pose.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/meshes/gltf/document/affine.h"
#include "encoder/meshes/gltf/document/document.h"
#include "encoder/meshes/gltf/document/values.h"
#include "encoder/meshes/gltf/tangents.h"

namespace rlpc {

// A joint that a vertex follows.
struct GltfInfluence {
  std::uint32_t joint = 0;
  float weight = 0.0F;  // above 0
};

struct GltfGeometry {
  struct Target {
    std::size_t number = 0;  // index among the targets of the mesh
    std::vector<GltfDelta> deltas;
  };

  std::vector<float> base;             // xyz per vertex
  std::vector<Target> targets;         // only those that move a vertex
  std::vector<Target> normal_targets;  // only those that turn a normal
  // The influences of vertex v, at least one, are influences[first_influence[v]] up to, but not
  // including, influences[first_influence[v + 1]]. Both are empty without a skin.
  std::vector<GltfInfluence> influences;
  std::vector<std::uint64_t> first_influence;
  std::vector<Triangle> triangles;
  struct Attribute {
    std::string semantic;  // "TEXCOORD_0"
    std::uint32_t width = 0;
    std::uint32_t max_value = 0;  // maximum of normalised integers, otherwise 0
    std::vector<float> values;    // [vertex][width]; normalised integers as integers
  };
  std::vector<Attribute> attributes;
  TangentCount tangents;          // counted if the material needs tangents
  std::uint64_t num_clamped = 0;  // numbers of colours outside 0 to 1, which are clamped

  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(base.size() / 3); }
};

// num_joints: joints of the skin; 0: no skin, influences are not read. relief_uv: number of the
// texture coordinates that a normal map, or another texture that needs tangents, uses; none: no
// such texture. Joints and indices of the result are in range. Complete only if there are no
// errors.
GltfGeometry read_gltf_geometry(const GltfPrimitive& primitive, std::size_t num_joints,
                                std::optional<std::size_t> relief_uv, GltfValues& values,
                                GltfErrors& errors);

// Sets positions, or other values of vertices in threes, to base plus weighted targets, before
// nodes or joints are applied. weights: [target of the mesh].
void morph(std::span<const float> base, std::span<const GltfGeometry::Target> targets,
           std::span<const double> weights, std::vector<double>& out);

// Map positions to the scene, by the map of a node or the weighted maps of joints. out: 3
// values per vertex.
void place(const std::vector<double>& positions, const Affine& node, std::span<double> out);
void place_by_joints(const GltfGeometry& geometry, const std::vector<double>& positions,
                     const std::vector<Affine>& joints, std::span<double> out);

}  // namespace rlpc
