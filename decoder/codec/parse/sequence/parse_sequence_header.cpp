#include "decoder/codec/parse/sequence/parse_sequence_header.h"

#include "common/codec/syntax/stream_format.h"

namespace rlpc {
namespace {

// Fails with kUnsupported, not kInvalid: this version does not define the profile or level.
void expect_supported(BitReader& r, bool supported, const char* rule, const char* element,
                      std::uint64_t at) {
  if (!supported) r.fail(Errc::kUnsupported, rule, element, at);
}

}  // namespace

// 6.3 sequence_header( )
SequenceHeader parse_sequence_header(BitReader& r, std::uint32_t version_minor,
                                     SequenceHeaderPlaces& p) {
  constexpr std::int64_t kAny = 0xFFFFFFFE;
  SequenceHeader h;
  std::uint64_t at = r.bit_pos();
  h.profile_idc = r.u(8, "profile_idc");
  expect_supported(r, h.profile_idc <= version_minor, "R-HDR-01", "profile_idc", at);
  if (h.profile_idc != version_minor) {
    const Error error = unsupported_minor_version();
    expect_supported(r, false, error.rule, error.element, error.bit_pos);
  }
  at = r.bit_pos();
  h.level_idc = r.u(8, "level_idc");
  expect_supported(r, h.level_idc >= 1 && h.level_idc <= kMaxLevelIdc, "R-HDR-02", "level_idc",
                   at);
  if (r.stopped()) return h;
  const Level& level = h.level();
  p.num_vertices_minus1 = r.bit_pos();
  h.num_vertices =
      r.ue("num_vertices_minus1", {0, std::int64_t{level.max_vertices} - 1}, "R-LVL-01") + 1;
  p.num_triangles = r.bit_pos();
  h.num_triangles = r.ue("num_triangles", {0, level.max_triangles}, "R-LVL-02");
  p.open_end_flag = r.bit_pos();
  if (h.profile_idc >= kProfileHigh) h.open_end_flag = r.flag("open_end_flag");
  p.num_frames_minus1 = r.bit_pos();
  h.num_frames = kMaxFrames;
  if (!h.open_end_flag) {
    h.num_frames = r.ue("num_frames_minus1", {0, std::int64_t{kMaxFrames} - 1}, "R-LVL-03") + 1;
  }
  if (r.stopped()) return h;
  p.frame_rate_numerator_minus1 = r.bit_pos();
  h.frame_rate.numerator = r.ue("frame_rate_numerator_minus1", {0, kAny}, "R-HDR-03") + 1;
  h.frame_rate.denominator = r.ue("frame_rate_denominator_minus1", {0, kAny}, "R-HDR-03") + 1;
  h.grid.log2_step = r.se("grid_log2_step", {kMinGridLog2Step, kMaxGridLog2Step}, "R-HDR-04");
  for (std::int32_t& origin : h.grid.origin) {
    origin = r.se("grid_origin", {-kMaxGridOrigin, kMaxGridOrigin}, "R-HDR-05");
  }
  h.position_bits = static_cast<int>(
      r.u(5, "position_bits", {kMinPositionBits, kMaxPositionBits}, "R-HDR-06"));
  r.byte_alignment();
  r.expect_end();
  return h;
}

Result<SequenceHeader> parse_sequence_header(BitReader& r, std::uint32_t version_minor,
                                             SequenceHeaderPlaces* places) {
  SequenceHeaderPlaces p;
  const SequenceHeader h = parse_sequence_header(r, version_minor, p);
  if (r.error()) return *r.error();
  if (places != nullptr) *places = p;
  return h;
}

}  // namespace rlpc
