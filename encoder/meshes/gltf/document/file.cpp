#include "encoder/meshes/gltf/document/file.h"

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/files/glb.h"
#include "common/json/json.h"

namespace rlpc {

namespace {

InputResult<bool> is_binary(InputFile& file) {
  std::array<char, 4> magic{};
  if (file.size() < magic.size()) return false;
  if (auto error = file.read(0, magic)) return *error;
  return begins_glb({magic.data(), magic.size()});
}

InputResult<GlbChunks> find_chunks(InputFile& file) {
  std::optional<InputError> failure;
  const auto read = [&](std::uint64_t offset, std::span<char> bytes) {
    failure = file.read(offset, bytes);
    return !failure;
  };
  auto chunks = find_glb_chunks(file.size(), read);
  if (failure) return *failure;
  if (!chunks) return InputError{file.path() + ": " + chunks.error()};
  return *chunks;
}

// Returns an upper bound of the memory of a document. Each JSON value follows a bracket, comma
// or colon; the size per value includes the spare capacity of arrays and maps. The largest
// structure for an object is a node.
std::uint64_t bytes_of_document(std::string_view text) {
  constexpr std::uint64_t kValueBytes = 112;
  constexpr std::uint64_t kObjectBytes = 1200;
  constexpr std::uint64_t kCharacterBytes =
      3;  // in the text, in the JSON, and in names or data
  std::uint64_t bytes = kCharacterBytes * text.size();
  for (const char c : text) {
    if (c == '[' || c == ',' || c == ':') bytes += kValueBytes;
    if (c == '{') bytes += kObjectBytes;
  }
  return bytes;
}

}  // namespace

InputResult<GltfFile> open_gltf_file(const std::string& path, std::uint64_t max_memory_bytes) {
  auto file = InputFile::open(path, max_memory_bytes);
  if (!file) return file.error();
  if (file->size() == 0) return InputError{file->path() + ": the file is empty"};
  const auto binary = is_binary(*file);
  if (!binary) return binary.error();
  GlbChunks chunks{{0, file->size()}, {}};
  if (*binary) {
    const auto found = find_chunks(*file);
    if (!found) return found.error();
    chunks = *found;
  }
  const std::string name = file->path();
  const InputError too_large{name + ": " + memory_problem(max_memory_bytes)};
  if (chunks.json.size > max_memory_bytes - file->memory_bytes()) return too_large;
  auto text = read_text(*file, chunks.json.offset, chunks.json.size);
  if (!text) return text.error();
  const std::uint64_t document_bytes = bytes_of_document(*text);
  if (document_bytes > max_memory_bytes - file->memory_bytes()) return too_large;
  JsonProblem problem;
  auto json =
      read_json<nlohmann::json>(*text, max_memory_bytes - file->memory_bytes(), problem);
  if (!json && problem.kind == JsonProblem::kTooLarge) return too_large;
  if (!json) return InputError{name + ": not a glTF document: " + problem.message};
  return GltfFile{std::move(*file), std::make_shared<const nlohmann::json>(*std::move(json)),
                  chunks.binary, document_bytes};
}

}  // namespace rlpc
