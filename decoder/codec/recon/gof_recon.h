// Interface for reconstructing GOFs of any kind.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/mesh/skeleton.h"
#include "common/memory/owned.h"

namespace rlpc {

class GofRecon : public Owned {
 public:
  GofRecon() = default;
  GofRecon(const GofRecon&) = delete;
  GofRecon& operator=(const GofRecon&) = delete;
  virtual ~GofRecon() = default;

  virtual std::uint32_t num_frames() const = 0;
  // Returns whether frames should be decoded one at a time and in order, each on all threads.
  virtual bool is_ordered() const { return false; }
  // Decodes frames first to first + count - 1 of the GOF, in decoded order, grid units,
  // [count][num_vertices][3]. Several threads may call it.
  virtual void frames(std::uint32_t first, std::uint32_t count,
                      std::span<std::int32_t> positions) const = 0;
  void frame(std::uint32_t f, std::span<std::int32_t> positions) const {
    frames(f, 1, positions);
  }
  // Return the bones that move its vertices, in decoded order, and their places in a frame of
  // the GOF; none without bones.
  virtual std::optional<Skeleton> skeleton() const { return std::nullopt; }
  virtual Vector<BonePlace> places(std::uint32_t /*f*/) const { return {}; }
  virtual std::size_t values_of_frame() const { return 0; }
  // Sets the number of frames to cache before the last one for backward playback, if the GOF is
  // ordered. Must be called before the first frame.
  virtual void keep_frames(std::uint32_t /*count*/) {}
  // Decodes the frames that frame f is predicted from, so that decoding f takes little time.
  // Any thread may call it.
  virtual void make_ready(std::uint32_t /*f*/) const {}
};

}  // namespace rlpc
