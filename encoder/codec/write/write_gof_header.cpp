#include "encoder/codec/write/write_gof_header.h"

namespace rlpc {

// 6.5 gof( )
void write_gof_header(BitWriter& w, const GofHeader& gof, std::uint32_t profile_idc) {
  w.ue(gof.first_frame);
  w.ue(gof.num_frames - 1);
  if (profile_idc == kProfileMain) {
    w.flag(gof.kind == GofKind::kSkinned);  // bones_flag
  } else if (profile_idc >= kProfileHigh) {
    w.u(2, static_cast<std::uint32_t>(gof.kind));  // gof_kind
  }
}

}  // namespace rlpc
