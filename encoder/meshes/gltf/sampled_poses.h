// Samples poses of the sequence so that each part of a scene is visible in one of them.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "encoder/meshes/gltf/model.h"
#include "encoder/meshes/gltf/pose.h"

namespace rlpc {

struct SampledPoses {
  struct Later {
    std::uint32_t frame = 0;
    GltfPose pose;
  };

  std::vector<Later> later;  // frames after the first, ascending
  // [instance], whether its node mirrors in the frame in which it is largest.
  std::vector<bool> is_mirrored;
  // Number of instances that are mirrored in some frames and not in others.
  std::size_t num_turning_over = 0;
};

// Samples frames at equal distances and, for each node that is much smaller in these than in
// some other frame, that frame. pose_at: returns the pose of a frame. most: number of frames
// after the first. Takes as long as evaluating the nodes of some thousand frames.
SampledPoses sample_poses(const GltfModel& model, std::uint32_t num_frames, std::size_t max,
                          const std::function<GltfPose(std::uint32_t)>& pose_at);

}  // namespace rlpc
