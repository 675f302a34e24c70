// Reads input of unknown length (pipes, devices, standard input) up to a limit.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rlpc {

// Input that can be read only once; its contents are kept in memory.
class PipedInput {
 public:
  enum class State : std::uint8_t { kReading, kWhole, kTooLarge, kFailed };

  // The file is not owned, and must not be read otherwise.
  explicit PipedInput(std::FILE* file) : file_(file) {}

  // The first 64 bytes; fewer only at the end.
  std::span<const std::uint8_t> beginning();
  // Reads to the end. If there are more than max_bytes, keeps nothing.
  State read_rest(std::uint64_t max_bytes);

  State state() const { return state_; }
  std::uint64_t size() const { return size_; }  // bytes read so far
  // Moves the bytes out.
  void copy(std::uint64_t offset, std::span<std::uint8_t> out) const;

 private:
  // Reads one more block of up to `bytes` bytes.
  void read_block(std::size_t bytes);

  std::FILE* file_;
  State state_ = State::kReading;
  std::uint64_t size_ = 0;
  std::vector<std::uint8_t> beginning_;
  std::vector<std::vector<std::uint8_t>>
      blocks_;  // after the beginning; all but the last are full
};

// Reads a small file. None: it cannot be read, or has more than max_bytes.
std::optional<std::string> read_small_file(const std::string& path, std::size_t max_bytes);

}  // namespace rlpc
