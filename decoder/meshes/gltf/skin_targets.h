// Morph targets of a skin, and their weights over time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "decoder/meshes/gltf/eigen.h"
#include "decoder/meshes/gltf/glb_animation.h"
#include "decoder/meshes/gltf/glb_mesh.h"
#include "decoder/meshes/gltf/principal_shapes.h"

namespace rlpc {

// Targets of positions, then targets of normals. Each moves only one of the two, as their
// principal shapes differ and viewers add all targets up.
struct SkinTargets {
  PrincipalShapes places;   // targets of the vertices of the stream
  PrincipalShapes normals;  // targets of output vertices

  std::size_t count() const {
    return static_cast<std::size_t>(places.targets.cols() + normals.targets.cols());
  }
};

// Weights in a clip: keys, which are frames of the clip, and the weights of all targets at
// each.
struct TargetTrack {
  std::vector<std::uint32_t> keys;
  Eigen::MatrixXf weights;  // [target][key]
};

// Returns the track of a clip without keys that interpolation reproduces. tolerance: RMS error
// of a vertex.
TargetTrack target_track(const SkinTargets& targets, const Clip& clip, double tolerance);

// Returns the weights of the targets of positions as viewers interpolate them, [target][frame];
// in a frame of several clips, those of the first clip.
Eigen::MatrixXf shown_weights(const SkinTargets& targets, std::span<const TargetTrack> tracks,
                              std::span<const Clip> spans);

// Returns the targets of a primitive.
GltfJson targets_of(const SkinTargets& targets, const GlbMesh& mesh, GlbBuffers& buffers);
// Returns the weights of the targets in frame 0.
GltfJson first_weights(const SkinTargets& targets);
void add_weights(GlbAnimation& animation, std::uint32_t node, const SkinTargets& targets,
                 const TargetTrack& track, GlbBuffers& buffers);

}  // namespace rlpc
