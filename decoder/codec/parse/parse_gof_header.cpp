#include "decoder/codec/parse/parse_gof_header.h"

#include <cstddef>

namespace rlpc {

// Every code of gof_kind is a kind.
static_assert(kGofKinds.size() == std::size_t{1} << 2);

std::uint32_t parse_first_frame(BitReader& r, Range range) {
  return r.ue("first_frame", range, "R-GOF-01");
}

// 6.5 gof( )
GofHeader parse_gof_header(BitReader& r, const SequenceHeader& header,
                           std::uint32_t expected_first_frame) {
  const Level& level = header.level();
  GofHeader gof;
  gof.first_frame = expected_first_frame;
  parse_first_frame(r, {expected_first_frame, expected_first_frame});
  const std::uint64_t at = r.bit_pos();
  const std::uint32_t frames_left = header.num_frames - expected_first_frame;
  gof.num_frames =
      r.ue("num_gof_frames_minus1", {0, std::int64_t{frames_left} - 1}, "R-GOF-02") + 1;
  const std::uint64_t num_values = std::uint64_t{gof.num_frames} * header.num_vertices;
  if (!r.error() &&
      (gof.num_frames > level.max_gof_frames || num_values > level.max_gof_values)) {
    r.fail(Errc::kInvalid, "R-LVL-04", "num_gof_frames_minus1", at);
  }
  if (header.profile_idc == kProfileMain) {
    if (r.flag("bones_flag")) gof.kind = GofKind::kSkinned;
  } else if (header.profile_idc >= kProfileHigh) {
    gof.kind = static_cast<GofKind>(r.u(2, "gof_kind"));
  }
  return gof;
}

}  // namespace rlpc
