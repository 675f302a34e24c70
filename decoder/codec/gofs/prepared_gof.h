// GOF that is ready to decode frames: its reconstruction and its hashes.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/stream_context.h"
#include "decoder/codec/recon/gof_recon.h"
#include "decoder/codec/recon/rig_recons.h"

namespace rlpc {

struct PreparedGof {
  GofHeader header;
  std::optional<GofHash> hash;
  FrameCrcs frame_crcs;
  bool is_cut = false;
  std::unique_ptr<GofRecon> recon;
  // Shared rig in use; keeps its reconstruction alive.
  std::shared_ptr<const SharedRig> rig;
  // Upper bound of the memory in use, with cached frames and without the rig.
  std::uint64_t memory_bytes = 0;
  std::uint64_t frame_bytes = 0;  // part of memory_bytes for cached frames
};

// Prepares a GOF. max_frame_bytes: decoded frames of an inter GOF to cache for backward
// playback.
PreparedGof prepare(AccessUnit access_unit, const StreamContext& context, RigRecons& rigs,
                    std::uint64_t max_frame_bytes);

}  // namespace rlpc
