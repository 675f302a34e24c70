#include "decoder/codec/parse/parse_gof_header.h"

#include <cstddef>

namespace rlpc {

// Every code of gof_kind is a kind.
static_assert(kGofKinds.size() == std::size_t{1} << 2);

std::uint32_t parse_first_frame(BitReader& r, Range range) {
  return r.ue("first_frame", range, "R-GOF-01");
}

std::uint32_t parse_num_gof_frames(BitReader& r, const SequenceHeader& header,
                                   std::uint32_t frames_left) {
  const Level& level = header.level();
  const std::uint64_t at = r.bit_pos();
  const std::uint32_t num_frames =
      r.ue("num_gof_frames_minus1", {0, std::int64_t{frames_left} - 1}, "R-GOF-02") + 1;
  const std::uint64_t num_values = std::uint64_t{num_frames} * header.num_vertices;
  r.require({"num_gof_frames_minus1", std::int64_t{num_frames} - 1, at},
            num_frames <= level.max_gof_frames && num_values <= level.max_gof_values,
            "R-LVL-04");
  return num_frames;
}

GofKind parse_gof_kind(BitReader& r, const SequenceHeader& header) {
  if (header.profile_idc == kProfileMain && r.flag("bones_flag")) return GofKind::kSkinned;
  if (header.profile_idc < kProfileHigh) return GofKind::kCluster;
  return static_cast<GofKind>(r.u(2, "gof_kind"));
}

// 6.5 gof( )
GofHeader parse_gof_header(BitReader& r, const SequenceHeader& header,
                           std::uint32_t expected_first_frame) {
  GofHeader gof;
  gof.first_frame = expected_first_frame;
  parse_first_frame(r, {expected_first_frame, expected_first_frame});
  gof.num_frames = parse_num_gof_frames(r, header, header.num_frames - expected_first_frame);
  gof.kind = parse_gof_kind(r, header);
  return gof;
}

}  // namespace rlpc
