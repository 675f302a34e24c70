#include "decoder/codec/parse/parse_gof_hash.h"

namespace rlpc {

// 6.7 gof_hash( )
Result<GofHash> parse_gof_hash(BitReader& r, std::uint32_t num_frames) {
  GofHash hash;
  hash.per_frame_flag = r.flag("per_frame_flag");
  r.byte_alignment();
  const std::uint32_t count = hash.per_frame_flag ? num_frames : 1;
  if (!r.error() && r.remaining_bytes().size() != std::size_t{4} * count) {
    r.fail(Errc::kInvalid, "R-HSH-01", "position_crc", r.bit_pos());
  }
  for (std::uint32_t i = 0; i < count && !r.error(); ++i) {
    hash.position_crc.push_back(r.u(32, "position_crc"));
  }
  if (r.error()) return *r.error();
  return hash;
}

}  // namespace rlpc
