#include "decoder/codec/gofs/prepared_gof.h"

#include <algorithm>
#include <utility>

#include "decoder/codec/gofs/make_recon.h"
#include "decoder/codec/kinds/kinds.h"

namespace rlpc {

PreparedGof prepare(AccessUnit access_unit, const StreamContext& context, RigRecons& rigs,
                    std::uint64_t max_frame_bytes) {
  PreparedGof gof;
  gof.recon = make_recon(access_unit, context, rigs);
  gof.header = access_unit.header();
  gof.hash = std::move(access_unit.hash);
  gof.frame_crcs = access_unit.frame_crcs();
  gof.is_cut = access_unit.is_cut;
  if (const auto* const skinned = std::get_if<SkinnedGof>(&access_unit.gof)) {
    gof.rig = skinned->rig;
  }
  visit_gof(access_unit.gof, [&](auto decoder, const auto& g) {
    gof.memory_bytes = decoder.memory_of_gof(g, context.header);
  });
  if (gof.recon->is_ordered()) {
    const std::uint64_t bytes_per_frame = 12 * std::uint64_t{context.header.num_vertices};
    const std::uint64_t max_frames =
        std::min<std::uint64_t>(gof.header.num_frames, max_frame_bytes / bytes_per_frame);
    gof.recon->keep_frames(static_cast<std::uint32_t>(max_frames));
    gof.frame_bytes = max_frames * bytes_per_frame;
    gof.memory_bytes += gof.frame_bytes;
  }
  return gof;
}

}  // namespace rlpc
