// GOFs that are parsed and prepared on other threads before they are wanted. They change
// nothing but the time that decoding takes: a GOF with an error is not given, and its decoder
// finds the error by itself.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <optional>

#include "decoder/recon/gof_recon.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// An access unit, and what gives its frames.
struct PreparedGof {
  GofHeader header;
  std::optional<GofHash> hash;
  bool is_cut = false;
  std::unique_ptr<GofRecon> recon;
};
PreparedGof prepare(AccessUnit access_unit, const StreamContext& context);

class Prefetch {
 public:
  struct Found {
    PreparedGof gof;
    std::uint64_t end;  // of its units, bytes from the start of the stream
  };

  // The stream must outlive it. max_memory_bytes: of each GOF.
  Prefetch(StreamReader& stream, std::uint64_t max_memory_bytes)
      : stream_(stream), max_memory_bytes_(max_memory_bytes) {}

  // Sees to it that up to `count` GOFs are here or on their way: those behind a byte offset, of
  // which the first one begins with first_frame. Forgets any before it.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // The GOF whose unit is at the offset, if it was prepared without an error. If not, all are
  // forgotten.
  std::optional<Found> take(std::uint64_t offset, std::uint32_t first_frame);
  void clear() { gofs_.clear(); }

 private:
  struct Ahead {
    CodedAccessUnit coded;
    std::optional<PreparedGof> gof;
    std::future<bool> done;
  };

  std::optional<CodedAccessUnit> collect(std::uint64_t offset, std::uint32_t first_frame);
  std::optional<PreparedGof> parse(const CodedAccessUnit& coded) const;

  StreamReader& stream_;
  std::uint64_t max_memory_bytes_;
  std::deque<Ahead> gofs_;
};

}  // namespace rlpc
