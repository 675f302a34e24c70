// Buffer of a stream that is being written, so that it can be read back.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

namespace rlpc {

// Grows at its end. Used by one thread at a time, except that several may read.
class StreamBuffer {
 public:
  // kAll: bytes stay until the buffer ends. kNeeded: bytes that a reader forgets are released.
  enum class Keep : std::uint8_t { kAll, kNeeded };
  explicit StreamBuffer(Keep keep) : keep_(keep) {}

  void add(std::span<const std::uint8_t> bytes) {
    if (bytes.empty()) return;
    chunks_.push_back({size_, {bytes.begin(), bytes.end()}});
    size_ += bytes.size();
  }
  // Returns the number of bytes that have been added, including released ones.
  std::uint64_t size() const { return size_; }
  // Fills `out` from `offset`. Returns false if some bytes do not exist or have been released.
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) const {
    if (offset > size_ || out.size() > size_ - offset) return false;
    const auto after = std::upper_bound(
        chunks_.begin(), chunks_.end(), offset,
        [](std::uint64_t at, const Chunk& chunk) { return at < chunk.offset; });
    auto chunk = after - (after == chunks_.begin() ? 0 : 1);
    for (std::size_t done = 0; done < out.size(); ++chunk) {
      const std::uint64_t at = offset + done;
      if (chunk == chunks_.end() || at < chunk->offset) return false;
      const auto skipped = static_cast<std::size_t>(at - chunk->offset);
      const std::size_t count = std::min(out.size() - done, chunk->bytes.size() - skipped);
      std::copy_n(&chunk->bytes[skipped], count, &out[done]);
      done += count;
    }
    return true;
  }
  // Releases bytes before an offset, if the buffer keeps only needed bytes.
  void forget(std::uint64_t before) {
    while (keep_ == Keep::kNeeded && !chunks_.empty() &&
           chunks_.front().offset + chunks_.front().bytes.size() <= before) {
      chunks_.pop_front();
    }
  }
  // Calls pass(bytes) for all pieces in order, until a call returns false. Returns whether all
  // calls returned true.
  template <class Pass>
  bool for_each_piece(const Pass& pass) const {
    return std::all_of(chunks_.begin(), chunks_.end(), [&](const Chunk& chunk) {
      return pass(std::span<const std::uint8_t>(chunk.bytes));
    });
  }

 private:
  struct Chunk {
    std::uint64_t offset = 0;
    std::vector<std::uint8_t> bytes;
  };

  Keep keep_;
  std::uint64_t size_ = 0;
  std::deque<Chunk> chunks_;
};

}  // namespace rlpc
