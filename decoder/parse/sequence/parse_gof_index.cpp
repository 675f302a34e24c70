#include "decoder/parse/sequence/parse_gof_index.h"

namespace rlpc {

// 6.9 gof_index( )
Result<std::vector<GofLocation>> parse_gof_index(BitReader& r, std::uint32_t num_frames) {
  constexpr std::int64_t kAny = 0xFFFFFFFE;
  const std::uint32_t num_gofs =
      r.ue("num_index_gofs_minus1", {0, std::int64_t{num_frames} - 1}, "R-IDX-01") + 1;
  GofLocation next{r.ue("first_gof_offset", {0, kAny}, "R-IDX-02"), 0};
  std::vector<GofLocation> gofs;
  for (std::uint32_t g = 0; g < num_gofs && !r.error(); ++g) {
    gofs.push_back(next);
    const std::int64_t left = std::int64_t{num_frames} - next.first_frame;
    next.first_frame += r.ue("index_gof_frames_minus1", {0, left - 1}, "R-IDX-01") + 1;
    next.offset += r.ue("index_gof_bytes", {0, kAny}, "R-IDX-02");
    if (next.first_frame == num_frames && g + 1 < num_gofs) {
      r.fail(Errc::kInvalid, "R-IDX-01", "num_index_gofs_minus1", r.bit_pos());
    }
  }
  if (!r.error() && next.first_frame != num_frames) {
    r.fail(Errc::kInvalid, "R-IDX-01", "num_index_gofs_minus1", r.bit_pos());
  }
  r.byte_alignment();
  r.expect_end();
  if (r.error()) return *r.error();
  return gofs;
}

}  // namespace rlpc
