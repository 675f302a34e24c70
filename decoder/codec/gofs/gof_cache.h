// GOFs that have been decoded from and may be needed again.
#pragma once

#include <cstdint>
#include <memory>

#include "common/memory/owned.h"
#include "decoder/codec/gofs/hash_check.h"
#include "decoder/codec/gofs/prepared_gof.h"

namespace rlpc {

// A GOF of the stream, and how far its hash has been verified.
struct LoadedGof : Owned {
  std::uint64_t offset = 0;  // of the GOF unit, bytes from the start of the stream
  std::uint64_t end = 0;     // of its units
  PreparedGof gof;
  HashCheck hash_check;

  const GofHeader& header() const { return gof.header; }
  std::uint32_t end_frame() const { return gof.header.first_frame + gof.header.num_frames; }
  bool has_frame(std::uint32_t frame) const {
    return frame >= gof.header.first_frame && frame < end_frame();
  }
};

// Drops those that have not been used for longest.
class GofCache {
 public:
  // max_bytes: of all GOFs, with the shared rigs that they use.
  explicit GofCache(std::uint64_t max_bytes) : max_bytes_(max_bytes) {}

  void set_max_bytes(std::uint64_t max_bytes);
  // May drop it at once. Nothing happens if it is null.
  void put(std::unique_ptr<LoadedGof> gof);
  // Removes and returns the GOF that has the frame, or whose unit is at the offset; null if
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
  LinkedList<std::unique_ptr<LoadedGof>> gofs_;  // the last used first
};

}  // namespace rlpc
