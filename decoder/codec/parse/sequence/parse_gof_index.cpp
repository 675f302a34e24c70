#include "decoder/codec/parse/sequence/parse_gof_index.h"

#include "common/memory/owned.h"

namespace rlpc {

namespace {

constexpr std::int64_t kAny = 0xFFFFFFFE;

// 6.9 index_of_rigs( )
Vector<RigLocation> parse_rigs(BitReader& r, std::uint32_t num_frames) {
  Vector<RigLocation> rigs;
  const std::uint32_t count = r.ue("num_index_rigs", {0, num_frames}, "R-IDX-05");
  std::uint64_t offset = 0;
  for (std::uint32_t m = 0; m < count && !r.error(); ++m) {
    const std::uint32_t rig_idx = r.u(3, "index_rig_idx");
    offset += r.ue("index_rig_distance", {0, kAny}, "R-IDX-02");
    rigs.push_back({offset, rig_idx});
  }
  return rigs;
}

}  // namespace

// 6.9 gof_index( )
Result<GofIndex> parse_gof_index(BitReader& r, const SequenceHeader& header) {
  const std::uint32_t num_frames = header.num_frames;
  const std::uint32_t num_gofs =
      r.ue("num_index_gofs_minus1", {0, std::int64_t{num_frames} - 1}, "R-IDX-01") + 1;
  GofLocation next{r.ue("first_gof_offset", {0, kAny}, "R-IDX-02"), 0};
  GofIndex index;
  for (std::uint32_t g = 0; g < num_gofs && !r.error(); ++g) {
    index.gofs.push_back(next);
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
  if (header.profile_idc >= kProfileHigh && !r.error()) {
    index.rigs = parse_rigs(r, num_frames);
  }
  r.byte_alignment();
  r.expect_end();
  if (r.error()) return *r.error();
  return index;
}

}  // namespace rlpc
