// Normals of a skin: normals of its rest shape, and morph targets for the motion that joints
// lack.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "decoder/meshes/gltf/gltf_look.h"
#include "decoder/meshes/gltf/principal_shapes.h"
#include "decoder/meshes/gltf/skin_joints.h"
#include "decoder/meshes/gltf/skin_shape.h"

namespace rlpc {

// Returns the unit vectors that joints turn into the directions of `normals`, as viewers do, by
// the linear part of the weighted sum of their maps; where that is singular, the normals
// themselves. vertex: the vertex of the skin that each normal belongs to.
std::vector<float> rest_normals(const SkinInfluences& influences, const JointMaps& maps,
                                std::span<const std::uint32_t> vertex,
                                std::span<const float> normals);

struct SkinNormals {
  std::vector<float> rest;   // [output vertex][3]; weights of 0 show the normals of frame 0
  PrincipalShapes moves;     // targets of output vertices; all weights are 0 in frame 0
  bool lacks_moves = false;  // moves were left out: they need more than max_bytes
};

// Vertices of the stream with normals that joints alone may not turn as the surface does.
struct NormalVertices {
  std::vector<bool> is_moving;  // normals may need targets
  std::vector<bool> is_bent;  // several joints move the triangles around it; implies is_moving
};

// Finds these vertices. missing: see missing_moves(). Time: proportional to triangles times
// frames, far less than computing normals.
NormalVertices normal_vertices(const GlbMesh& mesh, const SkinInfluences& influences,
                               std::span<const float> rest, const Eigen::MatrixXf& missing);

struct NormalLimits {
  std::size_t max_targets = 0;
  std::uint64_t max_bytes = 0;  // memory for the moves of all frames
};

// Computes the normals of a skin. look: has normals. maps: [frame].
SkinNormals skin_normals(const GltfLook& look, const SkinInfluences& influences,
                         std::span<const JointMaps> maps, std::span<const float> rest,
                         ShownFrames frames, const NormalVertices& vertices,
                         const NormalLimits& limits);

}  // namespace rlpc
