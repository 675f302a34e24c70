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

// Input that can be read only once; its contents are kept in memory.
class PipedInput {
 public:
  enum class State : std::uint8_t { kReading, kWhole, kTooLarge, kFailed };

  // The file is not owned, and must not be read otherwise.
  explicit PipedInput(std::FILE* file);

  // The first 64 bytes; fewer only at the end.
  std::span<const std::uint8_t> beginning();
  // Reads to the end. If there are more than max_bytes, keeps nothing.
  State read_rest(std::uint64_t max_bytes);
  // Waits until the first `end` bytes have been read, and reads no more; or for the end. If
  // more than max_bytes are to be kept, keeps nothing.
  State read_to(std::uint64_t end, std::uint64_t max_bytes);
  // Frees memory: of the bytes before an offset, only the first 64 are kept for certain.
  void forget(std::uint64_t before);

  State state() const { return state_; }
  std::uint64_t size() const { return size_; }  // bytes read so far
  std::uint64_t kept_bytes() const { return size_ - forgotten_; }
  bool keeps(std::uint64_t offset) const {
    return offset < beginning_.size() || offset >= beginning_.size() + forgotten_;
  }
  // Bytes that have been read and are kept.
  void copy(std::uint64_t offset, std::span<std::uint8_t> out) const;

 private:
  // Reads up to `bytes` bytes more, at most to the end of a block.
  void read_more(std::uint64_t bytes);

  std::FILE* file_;
  State state_ = State::kReading;
  std::uint64_t size_ = 0;
  std::uint64_t forgotten_ = 0;  // whole blocks at the start of `blocks_`
  Vector<std::uint8_t> beginning_;
  Vector<Vector<std::uint8_t>> blocks_;  // after the beginning; all but the last are full
};

// Reads a small file. None: it cannot be read, or has more than max_bytes.
std::optional<std::string> read_small_file(const std::string& path, std::size_t max_bytes);

}  // namespace rlpc
