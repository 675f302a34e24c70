// Fuzzes the sequence header parser: accepted headers are within their level, and are rejected
// without their last byte.

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/codec/syntax/stream_format.h"
#include "common/testing/fuzz_input.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"

namespace {

void parse(std::span<const std::uint8_t> payload, std::uint32_t version_minor) {
  rlpc::BitReader r(payload);
  const auto header = rlpc::parse_sequence_header(r, version_minor);
  if (!header) return;
  const rlpc::Level& level = header->level();
  rlpc::fuzz_check(header->num_vertices >= 1 && header->num_vertices <= level.max_vertices);
  rlpc::fuzz_check(header->num_triangles <= level.max_triangles);
  rlpc::fuzz_check(header->num_frames >= 1 && header->num_frames <= rlpc::kMaxFrames);
  rlpc::fuzz_check(header->frame_rate.numerator >= 1 && header->frame_rate.denominator >= 1);
  rlpc::BitReader shorter(payload.first(payload.size() - 1));
  rlpc::fuzz_check(!rlpc::parse_sequence_header(shorter, version_minor));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  for (std::uint32_t minor = 0; minor <= rlpc::kVersionMinor; ++minor)
    parse({data, size}, minor);
  return 0;
}
