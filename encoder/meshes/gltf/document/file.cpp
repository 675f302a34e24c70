#include "encoder/meshes/gltf/document/file.h"

#include <array>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "common/files/binary_numbers.h"
#include "common/json/json.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;

struct Chunks {
  GltfFile::Chunk json;
  std::optional<GltfFile::Chunk> binary;
};

InputResult<bool> is_binary(InputFile& file) {
  std::array<char, 4> magic{};
  if (file.size() < magic.size()) return false;
  if (auto error = file.read(0, magic)) return *error;
  return std::string_view(magic.data(), magic.size()) == "glTF";
}

// Finds the chunks of a .glb, which must cover the file exactly. Unknown ones are skipped.
InputResult<Chunks> find_chunks(InputFile& file) {
  const auto fail = [&](const std::string& what) {
    return InputError{file.path() + ": " + what};
  };
  std::array<char, kHeaderBytes> header{};
  if (file.size() < header.size()) return fail("a .glb file of less than 12 bytes; truncated?");
  if (auto error = file.read(0, header)) return *error;
  if (load_u32(header, 4) != 2) {
    return fail("version: found " + to_string(load_u32(header, 4)) +
                " at byte 4, expected 2; convert the file to glTF 2.0");
  }
  if (load_u32(header, 8) != file.size()) {
    return fail("length: found " + to_string(load_u32(header, 8)) + " at byte 8, expected " +
                to_string(file.size()) + ", the bytes of the file; is it complete?");
  }
  Chunks chunks;
  std::uint64_t at = kHeaderBytes;
  for (int number = 0; at < file.size(); ++number) {
    const std::string name = "chunk " + to_string(number);
    std::array<char, kChunkHeaderBytes> chunk{};
    if (file.size() - at < chunk.size()) return fail(name + ": the file ends in its header");
    if (auto error = file.read(at, chunk)) return *error;
    at += chunk.size();
    const std::uint32_t size = load_u32(chunk, 0);
    const std::uint32_t type = load_u32(chunk, 4);
    if (size > file.size() - at) {
      return fail(name + ": found a length of " + to_string(size) +
                  " bytes, expected at most " + to_string(file.size() - at) +
                  ", which are left in the file");
    }
    if ((number == 0) != (type == kJsonChunk)) {
      return fail(name + (number == 0 ? ": expected JSON in the first chunk"
                                      : ": expected JSON in the first chunk only"));
    }
    if (number == 0) chunks.json = {at, size};
    if (number == 1 && type == kBinaryChunk) chunks.binary = {at, size};
    at += size;
  }
  if (chunks.json.size == 0) return fail("chunk 0: expected JSON, found nothing");
  return chunks;
}

// Returns an upper bound of the memory of a document. Each JSON value follows a bracket, comma
// or colon; the size per value includes the spare capacity of arrays and maps. The largest
// structure for an object is a node.
std::uint64_t bytes_of_document(std::string_view text) {
  constexpr std::uint64_t kOfValue = 112;
  constexpr std::uint64_t kOfObject = 1200;
  constexpr std::uint64_t kOfCharacter = 3;  // in the text, in the JSON, and in names or data
  std::uint64_t bytes = kOfCharacter * text.size();
  for (const char c : text) {
    if (c == '[' || c == ',' || c == ':') bytes += kOfValue;
    if (c == '{') bytes += kOfObject;
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
  Chunks chunks{{0, file->size()}, {}};
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
