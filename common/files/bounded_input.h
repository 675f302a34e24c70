// Reads input of unknown length (pipes, devices, standard input) up to a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>

#include "common/memory/owned.h"

namespace rlpc {

// Input that can be read only once, and is kept in memory.
class PipedInput {
 public:
  enum class State : std::uint8_t { kReading, kWhole, kTooLarge, kFailed };

  // file: not owned; nothing else may read it.
  explicit PipedInput(std::FILE* file);

  // Returns the first 64 bytes; fewer only if the input is shorter.
  std::span<const std::uint8_t> beginning();
  // Reads to the end. Keeps nothing if there are more than max_bytes.
  State read_rest(std::uint64_t max_bytes);
  // Waits for the first `end` bytes or the end of the input, and reads no more. Keeps nothing
  // if there are more than max_bytes to keep.
  State read_to(std::uint64_t end, std::uint64_t max_bytes);
  // Frees memory: may drop bytes before an offset, except the first 64.
  void forget(std::uint64_t before);

  State state() const { return state_; }
  std::uint64_t size() const { return size_; }  // bytes read so far
  std::uint64_t kept_bytes() const { return size_ - forgotten_; }
  bool keeps(std::uint64_t offset) const {
    return offset < beginning_.size() || offset >= beginning_.size() + forgotten_;
  }
  // Copies bytes, which must have been read and kept.
  void copy(std::uint64_t offset, std::span<std::uint8_t> out) const;

 private:
  // Reads up to `bytes` more bytes, at most to the end of a block.
  void read_more(std::uint64_t bytes);

  std::FILE* file_;
  State state_ = State::kReading;
  std::uint64_t size_ = 0;
  std::uint64_t forgotten_ = 0;  // whole blocks at the start of `blocks_`
  Vector<std::uint8_t> beginning_;
  Vector<Vector<std::uint8_t>> blocks_;  // after the beginning; all but the last are full
};

// Reads a small file. None if it cannot be read, or has more than max_bytes.
std::optional<std::string> read_small_file(const std::string& path, std::size_t max_bytes);

}  // namespace rlpc
