#include "decoder/meshes/gltf/glb_document.h"

#include <cerrno>
#include <string>
#include <vector>

#include "common/files/glb.h"
#include "common/json/json.h"
#include "decoder/meshes/mesh_bytes.h"

namespace rlpc {

GlbDocument::GlbDocument(FrameRate frame_rate) {
  root["asset"] = {{"version", "2.0"},
                   {"generator", "rlpcdec"},
                   {"extras", {{"frame_rate", frame_rate_text(frame_rate)}}}};
}

OutputError too_large_for_glb(const std::string& path) {
  return OutputError{path +
                     ": more than 4 GB, which a .glb file cannot hold; write fewer frames "
                     "('num_frames'), or a point cache"};
}

std::optional<OutputError> failure_of(const GlbDocument& document, const std::string& path,
                                      const std::shared_ptr<OutputLimit>& limit) {
  const std::uint64_t size = document.buffers.chunk().size();
  if (limit != nullptr && size > limit->left) return limit->exceeded(path);
  if (const auto reason = document.buffers.failure()) {
    return output_error(path, "store its binary part temporarily", *reason);
  }
  if (size > kMaxGlbBytes) return too_large_for_glb(path);
  return std::nullopt;
}

std::string glb_text(const GltfJson& root) { return json_text(root); }

std::optional<OutputError> write_glb(GlbDocument& document, OutputFile& file) {
  BinaryChunk& chunk = document.buffers.chunk();
  document.root["accessors"] = document.buffers.accessors();
  document.root["bufferViews"] = document.buffers.views();
  document.root["buffers"] = GltfJson::array({{{"byteLength", chunk.size()}}});
  const std::string head = glb_head(glb_text(document.root), chunk.size());
  if (head.size() + chunk.size() > kMaxGlbBytes) return too_large_for_glb(file.path());
  if (auto error = file.write(head)) return error;
  std::vector<char> block(std::size_t{1} << 16);
  std::uint64_t left = chunk.size();
  bool ok = chunk.rewind();
  while (ok && left > 0) {
    const std::size_t read = chunk.read(block);
    if (auto error = file.write({block.data(), read})) return error;
    ok = read > 0;
    left -= read;
  }
  if (!ok) return output_error(file.path(), "read its binary part back", errno);
  if (auto error = file.close()) return error;
  return file.commit();
}

}  // namespace rlpc
