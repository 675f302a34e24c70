// The bytes of a glTF document: in its binary chunk, in data URIs, in files beside it.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/input/gltf/document/file.h"
#include "encoder/input/gltf/document/json.h"

namespace rlpc {

struct GltfBuffer {
  std::uint64_t size = 0;          // byteLength: what the document claims
  std::optional<std::string> uri;  // none: the binary chunk
};

// Opens what is asked for when it is asked for. Files are read in the folder of the document
// (of standard input: the current one) and below it only, also by way of links: a document
// cannot make the tools read anything else.
class GltfBuffers {
 public:
  GltfBuffers(std::vector<GltfBuffer> buffers, GltfFile& file, GltfErrors& errors);

  // Bytes that the document and its buffers really have, as far as they can be found.
  std::uint64_t bytes_at_hand() const { return bytes_at_hand_; }
  // Is all of a buffer there? To be asked before memory is made for what is in it.
  bool available(std::uint32_t buffer);
  // The buffer is available, and offset + bytes.size() not more than its size.
  void read(std::uint32_t buffer, std::uint64_t offset, std::span<char> bytes);
  // The document, and the files that it points to, of those asked for.
  std::vector<std::string> files() const;

 private:
  // Where the bytes of a buffer are: in `file` from `offset` on, or in `text`.
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
  std::map<std::string, InputFile> others_;  // by path
  std::map<std::uint32_t, Place> places_;    // of the buffers asked for
  std::uint64_t bytes_at_hand_;
};

}  // namespace rlpc
