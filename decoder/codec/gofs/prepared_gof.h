// A GOF that is ready to give its frames: its reconstruction, and what its frames are compared
// with.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/stream_context.h"
#include "decoder/codec/gofs/gof_recon.h"
#include "decoder/codec/gofs/rig_recons.h"

namespace rlpc {

struct PreparedGof {
  GofHeader header;
  std::optional<GofHash> hash;
  FrameCrcs frame_crcs;
  bool is_cut = false;
  std::unique_ptr<GofRecon> recon;
  // That it uses; as long as it is there, so is its reconstruction.
  std::shared_ptr<const SharedRig> rig;
  // An upper bound of the memory that this keeps, with the frames that it may keep and without
  // the rig.
  std::uint64_t memory_bytes = 0;
  std::uint64_t frame_bytes = 0;  // of it, the frames
};

// max_frame_bytes: of decoded frames that an inter GOF keeps for the way back.
PreparedGof prepare(AccessUnit access_unit, const StreamContext& context, RigRecons& rigs,
                    std::uint64_t max_frame_bytes);

}  // namespace rlpc
