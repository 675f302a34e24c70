// Cache of GOFs that playback has left and may return to.
#pragma once

#include <cstdint>
#include <memory>

#include "common/memory/owned.h"
#include "decoder/codec/gofs/hash_check.h"
#include "decoder/codec/gofs/prepared_gof.h"

namespace rlpc {

// GOF of the stream, and the state of its hash check.
struct LoadedGof : Owned {
  std::uint64_t offset = 0;  // start of the GOF unit, bytes from the start of the stream
  std::uint64_t end = 0;     // end of its units
  PreparedGof gof;
  HashCheck hash_check;

  const GofHeader& header() const { return gof.header; }
  std::uint32_t end_frame() const { return gof.header.first_frame + gof.header.num_frames; }
  bool has_frame(std::uint32_t frame) const {
    return frame >= gof.header.first_frame && frame < end_frame();
  }
};

// Drops the least recently used GOFs.
class GofCache {
 public:
  // max_bytes: all GOFs, with the shared rigs that they use.
  explicit GofCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void set_max_bytes(std::uint64_t max_bytes);
  // Adds a GOF, unless it is null; may drop it at once.
  void put(std::unique_ptr<LoadedGof> gof);
  // Remove and return the GOF that has the frame, or whose unit is at the offset; null if
  // there is none.
  std::unique_ptr<LoadedGof> take_frame(std::uint32_t frame);
  std::unique_ptr<LoadedGof> take_at(std::uint64_t offset);
  bool has_frame(std::uint32_t frame) const;

  std::uint64_t bytes() const;
  bool is_empty() const { return gofs_.empty(); }
  void clear() { gofs_.clear(); }

 private:
  void drop_excess();

  std::uint64_t max_bytes_;
  LinkedList<std::unique_ptr<LoadedGof>> gofs_;  // most recently used first
};

}  // namespace rlpc
