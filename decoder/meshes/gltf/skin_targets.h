// The morph targets of a skin, and their weights over time.
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

// Of positions first, then of normals. Each of them moves one of the two: what is principal for
// one is not for the other, and viewers add them up all the same.
struct SkinTargets {
  PrincipalShapes places;   // of the vertices of the stream
  PrincipalShapes normals;  // of output vertices

  std::size_t count() const {
    return static_cast<std::size_t>(places.targets.cols() + normals.targets.cols());
  }
};

// The weights in a clip: keys, frames of the clip, and the weights of all targets for each.
struct TargetTrack {
  std::vector<std::uint32_t> keys;
  Eigen::MatrixXf weights;  // [target][key]
};

// Without keys between which the weights change linearly; tolerance: RMS of a vertex.
TargetTrack target_track(const SkinTargets& targets, const Clip& clip, double tolerance);

// The weights of the targets of positions as viewers interpolate them, [target][frame]; of a
// frame in several clips, those of the first.
Eigen::MatrixXf shown_weights(const SkinTargets& targets, std::span<const TargetTrack> tracks,
                              std::span<const Clip> spans);

// The targets of a primitive.
GltfJson targets_of(const SkinTargets& targets, const GlbMesh& mesh, GlbBuffers& buffers);
// Their weights in frame 0.
GltfJson first_weights(const SkinTargets& targets);
void add_weights(GlbAnimation& animation, std::uint32_t node, const SkinTargets& targets,
                 const TargetTrack& track, GlbBuffers& buffers);

}  // namespace rlpc
