// Joins the attributes of the primitives of a scene to those of one mesh.
#pragma once

#include "encoder/meshes/gltf/model_pose.h"
#include "encoder/meshes/gltf/sampled_poses.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// triangles: those of the scene, as in FrameSource::Shape before welding, in the order of
// instances, with those of mirrored instances reversed. Sets that only some primitives have are
// filled with usual values elsewhere, normals with those of the faces. first: the pose of the
// first frame; sampled: poses of others.
SourceAttributes gltf_attributes(const GltfModel& model, std::span<const Triangle> triangles,
                                 const GltfPose& first, const SampledPoses& sampled);

}  // namespace rlpc
