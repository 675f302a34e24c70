// Reads the container of a glTF 2.0 document: .gltf is JSON, .glb is JSON and a binary chunk.
#pragma once

#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "common/files/glb.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/input_file.h"

namespace rlpc {

struct GltfFile {
  InputFile file;
  std::shared_ptr<const nlohmann::json> json;
  std::optional<GlbChunk> binary;  // .glb only; lies within the file
  // Upper bound of the memory for the document as JSON and as a GltfDocument.
  std::uint64_t document_bytes = 0;
};

// Opens a file; .gltf and .glb are distinguished by contents, not by name.
InputResult<GltfFile> open_gltf_file(const std::string& path, std::uint64_t max_memory_bytes);

}  // namespace rlpc
