// Reconstruction of a GOF of any kind.
#pragma once

#include <memory>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/stream_context.h"
#include "decoder/codec/recon/gof_recon.h"
#include "decoder/codec/recon/rig_recons.h"

namespace rlpc {

// 8.1 Decoding a GOF. The access unit is read only during the call; the context must outlive
// the result. rigs: from the same stream. Cannot fail: parsing has checked every range.
std::unique_ptr<GofRecon> make_recon(const AccessUnit& access_unit,
                                     const StreamContext& context, RigRecons& rigs);

}  // namespace rlpc
