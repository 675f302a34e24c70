// The container of binary glTF 2.0 (.glb): a header, a chunk of JSON, and a chunk of the bytes
// that the JSON refers to.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/result.h"

namespace rlpc {

inline constexpr std::uint64_t kMaxGlbBytes = 0xFFFFFFFF;  // its header has 32 bits for them

// The contents of a chunk, bytes from the start of the file.
struct GlbChunk {
  std::uint64_t offset = 0;
  std::uint64_t size = 0;
};

struct GlbChunks {
  GlbChunk json;  // not empty
  std::optional<GlbChunk> binary;
};

// The same in memory.
struct GlbView {
  std::string_view json;
  std::string_view binary;  // empty: there is none
};

// Whether a file that begins with these bytes is a .glb, if it is any kind of glTF.
bool begins_glb(std::string_view beginning);

// Finds the chunks of a file of `size` bytes, which they must cover exactly. Skips further
// chunks. read: fills `bytes` from `offset` on, or returns false. Errors: the place, what was
// found, and what was expected; empty if read() failed.
Result<GlbChunks, std::string> find_glb_chunks(
    std::uint64_t size,
    const std::function<bool(std::uint64_t offset, std::span<char> bytes)>& read);
Result<GlbView, std::string> view_glb(std::string_view glb);

// Returns a file up to the contents of its binary chunk, which the caller appends.
//
//   json         is padded by spaces to a multiple of 4
//   binary_size  a multiple of 4; 0: there is no binary chunk
std::string glb_head(std::string json, std::uint64_t binary_size);

}  // namespace rlpc
