// GOFs parsed and prepared on other threads before they are needed. This affects nothing but
// speed: a GOF with an error yields nothing, and the decoder parses it again to find the error.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <optional>

#include "decoder/recon/gof_recon.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// An access unit and its reconstruction.
struct PreparedGof {
  GofHeader header;
  std::optional<GofHash> hash;
  bool is_cut = false;
  std::unique_ptr<GofRecon> recon;
};
PreparedGof prepare(AccessUnit access_unit, const StreamContext& context,
                    std::uint32_t threads = 1);

class Prefetch {
 public:
  struct Found {
    PreparedGof gof;
    std::uint64_t end;  // of its units, bytes from the start of the stream
  };

  // The stream must outlive it. max_memory_bytes: of each GOF. threads: of all GOFs together.
  Prefetch(StreamReader& stream, std::uint64_t max_memory_bytes, std::uint32_t threads)
      : stream_(stream), max_memory_bytes_(max_memory_bytes), threads_(threads) {}

  // Keeps up to `count` GOFs ready or in progress, from a byte offset on; the first of them
  // begins with first_frame. Drops earlier ones.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // The GOF whose unit is at the offset, if it was prepared without an error; otherwise drops
  // all.
  std::optional<Found> take(std::uint64_t offset, std::uint32_t first_frame);
  void clear() { gofs_.clear(); }

 private:
  struct Ahead {
    CodedAccessUnit coded;
    std::optional<PreparedGof> gof;
    std::future<bool> done;
  };

  std::optional<CodedAccessUnit> collect(std::uint64_t offset, std::uint32_t first_frame);
  std::optional<PreparedGof> parse(const CodedAccessUnit& coded, std::uint32_t threads) const;

  StreamReader& stream_;
  std::uint64_t max_memory_bytes_;
  std::uint32_t threads_;
  std::deque<Ahead> gofs_;
};

}  // namespace rlpc
