// A .glb file under construction: its JSON chunk and its binary chunk.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/files/output_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/gltf/glb_buffers.h"

namespace rlpc {

struct GlbDocument {
  explicit GlbDocument(FrameRate frame_rate);

  GltfJson root;  // without accessors, bufferViews and buffers
  GlbBuffers buffers;
};

// Returns the JSON text; bytes of names that are not UTF-8 are replaced.
std::string glb_text(const GltfJson& root);

OutputError too_large_for_glb(const std::string& path);

// Returns why the document so far cannot be written; none if it can. limit: null for none.
std::optional<OutputError> failure_of(const GlbDocument& document, const std::string& path,
                                      const std::shared_ptr<OutputLimit>& limit);

// Writes the document and completes the file.
std::optional<OutputError> write_glb(GlbDocument& document, OutputFile& file);

}  // namespace rlpc
