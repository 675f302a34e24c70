// Input without an end that is known: pipes, devices, standard input. It is read with a bound.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rlpc {

// What can be read once, from its beginning, is kept in memory.
class PipedInput {
 public:
  enum class State : std::uint8_t { kReading, kWhole, kTooLarge, kFailed };

  // The file is not owned, and nobody else reads it.
  explicit PipedInput(std::FILE* file) : file_(file) {}

  // The first bytes, up to 64; fewer only if there are no more.
  std::span<const std::uint8_t> beginning();
  // Up to the end, or until there are more than max_bytes, none of which are kept.
  State read_rest(std::uint64_t max_bytes);

  State state() const { return state_; }
  std::uint64_t size() const { return size_; }  // so far
  // Those bytes have been read.
  void copy(std::uint64_t offset, std::span<std::uint8_t> out) const;

 private:
  // A block more, of up to `bytes` bytes.
  void read_block(std::size_t bytes);

  std::FILE* file_;
  State state_ = State::kReading;
  std::uint64_t size_ = 0;
  std::vector<std::uint8_t> beginning_;
  std::vector<std::vector<std::uint8_t>> blocks_;  // behind it; each but the last is full
};

// All of a file of a few bytes. None: it cannot be read, or has more than max_bytes.
std::optional<std::string> read_small_file(const std::string& path, std::size_t max_bytes);

}  // namespace rlpc
