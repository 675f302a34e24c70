// Attributes of the primitives of a scene as those of one mesh.
#pragma once

#include "encoder/meshes/gltf/model_pose.h"
#include "encoder/meshes/gltf/sampled_poses.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// triangles: of the scene, as in FrameSource::Shape before welding, in the order of instances,
// those of mirrored instances turned. Sets that only some primitives have get usual values
// elsewhere, normals those of the faces. first: the pose of the first frame; sampled: of
// others.
SourceAttributes gltf_attributes(const GltfModel& model, std::span<const Triangle> triangles,
                                 const GltfPose& first, const SampledPoses& sampled);

}  // namespace rlpc
