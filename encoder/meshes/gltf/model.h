// A glTF document, read completely: everything that determines its vertices at any time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "encoder/meshes/gltf/clip.h"
#include "encoder/meshes/gltf/document/document.h"
#include "encoder/meshes/gltf/primitive.h"
#include "encoder/meshes/gltf/scene.h"

namespace rlpc {

// Limits of a document, in addition to memory. They are necessary because a few bytes can
// describe any number of frames, zeros or instances.
struct GltfLimits {
  std::uint64_t max_vertices = 3 * std::uint64_t{kLevels.back().max_triangles};  // not welded
  std::uint64_t max_triangles = 3 * std::uint64_t{kLevels.back().max_triangles};
  std::uint64_t max_frames = kMaxFrames;
  std::uint64_t max_positions = std::uint64_t{1} << 34;  // vertices x frames
  std::uint64_t spare_values = std::uint64_t{1} << 22;   // see GltfValues
};

struct GltfModel {
  struct Skin {
    std::vector<std::uint32_t> joints;  // nodes
    std::vector<Affine> inverse_bind;   // [joint]
  };
  // A primitive in the scene, placed by a node.
  struct Instance {
    std::uint32_t node = 0;
    std::optional<std::uint32_t> skin;
    std::size_t geometry = 0;
    std::uint64_t first_vertex = 0;  // in the order of the scene
    std::optional<std::uint32_t> material;
  };

  std::vector<GltfNode> nodes;
  // [mesh], default weights of its targets, for nodes without weights of their own.
  std::vector<std::vector<double>> weights;
  GltfScene scene;
  std::vector<Skin> skins;
  std::vector<GltfClip> clips;  // in playing order
  std::vector<GltfGeometry> geometries;
  std::vector<Instance> instances;
  std::uint64_t num_vertices = 0;
  std::size_t num_materials = 0;
  std::vector<std::size_t> equal_uv;    // EqualUv
  std::optional<FrameRate> frame_rate;  // asset.extras.frame_rate, "N/D", as rlpcdec writes it
  std::vector<std::string> notes;       // see FrameSource
  std::vector<std::string> dropped;     // contents that are not read: "cameras"
  std::vector<std::string> files;       // see FrameSource
  std::string asset;                    // see FrameSource
  std::uint64_t memory_bytes = 0;       // estimate for the model and the source made from it
};

// Reads a document; of the options, uses path, animations, images and max_memory_bytes.
InputResult<GltfModel> read_gltf_model(const InputOptions& options, const GltfLimits& limits);

}  // namespace rlpc
