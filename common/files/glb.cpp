#include "common/files/glb.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/files/binary_numbers.h"

namespace rlpc {
namespace {

using std::to_string;

constexpr std::size_t kHeaderBytes = 12;
constexpr std::size_t kChunkHeaderBytes = 8;
constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kVersion = 2;
constexpr std::string_view kJsonChunk = "JSON";
constexpr std::string_view kBinaryChunk("BIN\0", 4);

}  // namespace

bool begins_glb(std::string_view beginning) { return beginning.starts_with(kMagic); }

Result<GlbChunks, std::string> find_glb_chunks(
    std::uint64_t size,
    const std::function<bool(std::uint64_t offset, std::span<char> bytes)>& read) {
  std::array<char, kHeaderBytes> header{};
  if (size < header.size()) return std::string("a .glb file of less than 12 bytes; truncated?");
  if (!read(0, header)) return std::string();
  if (!begins_glb({header.data(), header.size()})) {
    return std::string("expected \"glTF\" at byte 0");
  }
  if (load_u32(header, 4) != kVersion) {
    return "version: found " + to_string(load_u32(header, 4)) +
           " at byte 4, expected 2; convert the file to glTF 2.0";
  }
  if (load_u32(header, 8) != size) {
    return "length: found " + to_string(load_u32(header, 8)) + " at byte 8, expected " +
           to_string(size) + ", the bytes of the file; is it complete?";
  }
  GlbChunks chunks;
  std::uint64_t at = kHeaderBytes;
  for (int number = 0; at < size; ++number) {
    const std::string name = "chunk " + to_string(number);
    std::array<char, kChunkHeaderBytes> chunk{};
    if (size - at < chunk.size()) return name + ": the file ends in its header";
    if (!read(at, chunk)) return std::string();
    at += chunk.size();
    const std::uint32_t bytes = load_u32(chunk, 0);
    const std::string_view type(&chunk[4], 4);
    if (bytes > size - at) {
      return name + ": found a length of " + to_string(bytes) + " bytes, expected at most " +
             to_string(size - at) + ", which are left in the file";
    }
    if ((number == 0) != (type == kJsonChunk)) {
      return name + (number == 0 ? ": expected JSON in the first chunk"
                                 : ": expected JSON in the first chunk only");
    }
    if (number == 0) chunks.json = {at, bytes};
    if (number == 1 && type == kBinaryChunk) chunks.binary = GlbChunk{at, bytes};
    at += bytes;
  }
  if (chunks.json.size == 0) return std::string("chunk 0: expected JSON, found nothing");
  return chunks;
}

Result<GlbView, std::string> view_glb(std::string_view glb) {
  const auto chunks =
      find_glb_chunks(glb.size(), [glb](std::uint64_t offset, std::span<char> bytes) {
        const std::string_view part = glb.substr(offset, bytes.size());
        std::copy(part.begin(), part.end(), bytes.begin());
        return true;
      });
  if (!chunks) return chunks.error();
  GlbView view;
  view.json = glb.substr(chunks->json.offset, chunks->json.size);
  if (chunks->binary) view.binary = glb.substr(chunks->binary->offset, chunks->binary->size);
  return view;
}

std::string glb_head(std::string json, std::uint64_t binary_size) {
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::uint64_t size = kHeaderBytes + kChunkHeaderBytes + json.size() +
                             (binary_size > 0 ? kChunkHeaderBytes + binary_size : 0);
  std::string head(kMagic);
  append_u32(head, kVersion);
  append_u32(head, static_cast<std::uint32_t>(size));
  append_u32(head, static_cast<std::uint32_t>(json.size()));
  head += kJsonChunk;
  head += json;
  if (binary_size > 0) {
    append_u32(head, static_cast<std::uint32_t>(binary_size));
    head += kBinaryChunk;
  }
  return head;
}

}  // namespace rlpc
