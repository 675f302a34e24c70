// The binary part of a glTF file, and the JSON arrays that describe it: buffer views and
// accessors.
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/mesh/mesh.h"

namespace rlpc {

// A growing JSON array.
class JsonArray {
 public:
  // Index of the value in the array.
  std::uint32_t add(const std::string& value) {
    if (size_ > 0) text_ += ',';
    text_ += value;
    return size_++;
  }
  std::uint32_t size() const { return size_; }
  std::string text() const { return "[" + text_ + "]"; }

 private:
  std::string text_;
  std::uint32_t size_ = 0;
};

// The binary chunk, in an unnamed temporary file: the JSON chunk precedes it, but is known only
// at the end.
class BinaryChunk {
 public:
  BinaryChunk() : file_(std::tmpfile()) {}
  BinaryChunk(const BinaryChunk&) = delete;
  BinaryChunk& operator=(const BinaryChunk&) = delete;
  ~BinaryChunk();

  std::uint64_t size() const { return size_; }
  // Begins at a multiple of 4. False: see errno.
  bool append(std::string_view bytes);
  bool rewind() { return std::fseek(file_, 0, SEEK_SET) == 0; }
  std::size_t read(std::span<char> bytes) {
    return std::fread(bytes.data(), 1, bytes.size(), file_);
  }

 private:
  std::FILE* file_;
  std::uint64_t size_ = 0;
};

// Each add_*() appends values to the chunk and returns the index of their accessor.
class GltfBuffers {
 public:
  // xyz of each vertex.
  std::uint32_t add_vectors(std::span<const float> xyz);
  // The same, sparse if that is smaller; none if all are zero.
  std::optional<std::uint32_t> add_moves(std::span<const float> moves);
  // Zeros, which take no bytes.
  std::uint32_t add_zero_vectors(std::uint32_t count);
  std::uint32_t add_indices(const std::vector<Triangle>& triangles, std::uint32_t num_vertices);
  // In seconds, ascending.
  std::uint32_t add_times(std::span<const float> times);
  // `count` numbers: 1 at `places`, which ascend, otherwise 0; sparse if that is smaller.
  std::uint32_t add_ones(const std::vector<std::uint32_t>& places, std::uint64_t count);

  std::string accessors_text() const { return accessors_.text(); }
  std::string views_text() const { return views_.text(); }
  BinaryChunk& chunk() { return chunk_; }
  const BinaryChunk& chunk() const { return chunk_; }
  // errno of the first failure to append to the chunk, which then stays as it is; none so far.
  std::optional<int> failure() const { return failure_; }

 private:
  std::uint32_t add_view(std::string_view bytes, int target);
  std::uint32_t add_floats(std::span<const float> values, int target);
  std::string sparse_text(const std::vector<std::uint32_t>& places, std::uint64_t count,
                          std::span<const float> values);

  BinaryChunk chunk_;
  JsonArray views_;
  JsonArray accessors_;
  std::optional<int> failure_;
};

}  // namespace rlpc
