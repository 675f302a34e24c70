// Reads the buffers of a glTF document: from its binary chunk, data URIs and other files.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/meshes/gltf/document/file.h"
#include "encoder/meshes/gltf/document/json.h"

namespace rlpc {

struct GltfBuffer {
  std::uint64_t size = 0;          // byteLength, as claimed by the document
  std::optional<std::string> uri;  // none: the binary chunk
};

// Opens buffers on demand. For security, reads only files in or below the folder of the
// document (for standard input, the current folder), after resolving links.
class GltfBuffers {
 public:
  GltfBuffers(std::vector<GltfBuffer> buffers, GltfFile& file, GltfErrors& errors);

  // Returns the actual bytes of the document and its buffers, as far as known.
  std::uint64_t bytes_at_hand() const { return bytes_at_hand_; }
  // Whether a buffer is complete; check this before allocating memory for its contents.
  bool available(std::uint32_t buffer);
  // Returns the actual bytes of an available buffer.
  std::uint64_t size(std::uint32_t buffer) const { return places_.at(buffer).size; }
  // Reads part of a buffer, which must be available; offset + bytes.size() is at most its size.
  void read(std::uint32_t buffer, std::uint64_t offset, std::span<char> bytes);
  // Returns the document and the files it refers to, as far as used.
  std::vector<std::string> files() const;

 private:
  // Place of the bytes of a buffer: in `file` from `offset` on, or in `text`.
  struct Place {
    InputFile* file = nullptr;
    std::uint64_t offset = 0;
    std::uint64_t size = 0;
    std::string text;
  };

  std::optional<Place> find(std::uint32_t buffer);
  std::optional<Place> find_binary(std::uint32_t buffer);
  std::optional<Place> find_file(const std::string& place, const std::string& uri);

  std::vector<GltfBuffer> buffers_;
  GltfFile& file_;
  GltfErrors& errors_;
  std::map<std::string, InputFile> others_;  // [path]
  std::map<std::uint32_t, Place> places_;    // [buffer], as far as used
  std::uint64_t bytes_at_hand_;
};

}  // namespace rlpc
