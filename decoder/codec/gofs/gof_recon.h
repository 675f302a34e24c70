// The interface for reconstructing GOFs of any kind.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/mesh/skeleton.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "decoder/codec/gofs/rig_recons.h"

namespace rlpc {

class GofRecon : public Owned {
 public:
  GofRecon() = default;
  GofRecon(const GofRecon&) = delete;
  GofRecon& operator=(const GofRecon&) = delete;
  virtual ~GofRecon() = default;

  virtual std::uint32_t num_frames() const = 0;
  // Whether frames are best asked for one by one, in order: each has several threads to itself.
  virtual bool is_ordered() const { return false; }
  // Frames first to first + count - 1 of the GOF, in decoded order, grid units,
  // [count][num_vertices][3]. Several threads may call it.
  virtual void frames(std::uint32_t first, std::uint32_t count,
                      std::span<std::int32_t> positions) const = 0;
  void frame(std::uint32_t f, std::span<std::int32_t> positions) const {
    frames(f, 1, positions);
  }
  // The bones that move its vertices, in decoded order, and their places in a frame of the GOF;
  // none if no bones do.
  virtual std::optional<Skeleton> skeleton() const { return std::nullopt; }
  virtual Vector<BonePlace> places(std::uint32_t /*f*/) const { return {}; }
  virtual std::size_t values_of_frame() const { return 0; }
  // Of ordered ones: how many frames before the last one asked for are kept, so that the way
  // back takes no decoding. To be called before the first frame.
  virtual void keep_frames(std::uint32_t /*count*/) {}
  // Decodes what frame f is predicted from, so that asking for it takes little time. Any thread
  // may call it.
  virtual void make_ready(std::uint32_t /*f*/) const {}
};

// 8.1 Decoding a GOF. The access unit is only read, during the call; the context must outlive
// the result. rigs: of the same stream. Cannot fail: parsing has checked every range.
std::unique_ptr<GofRecon> make_recon(const AccessUnit& access_unit,
                                     const StreamContext& context, RigRecons& rigs);

}  // namespace rlpc
