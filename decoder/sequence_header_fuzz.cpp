// Fuzzes the parser of the sequence header: what it accepts lies within the level, and is not
// accepted without its last byte.

#include <cstddef>
#include <cstdint>
#include <span>

#include "common/fuzz_input.h"
#include "decoder/parse_sequence_header.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> payload(data, size);
  rlpc::BitReader r(payload);
  const auto header = rlpc::parse_sequence_header(r);
  if (!header) return 0;
  const rlpc::Level& level = header->level();
  rlpc::fuzz_check(header->num_vertices >= 1 && header->num_vertices <= level.max_vertices);
  rlpc::fuzz_check(header->num_triangles <= level.max_triangles);
  rlpc::fuzz_check(header->num_frames >= 1 && header->num_frames <= rlpc::kMaxFrames);
  rlpc::fuzz_check(header->frame_rate.numerator >= 1 && header->frame_rate.denominator >= 1);
  rlpc::BitReader shorter(payload.first(size - 1));
  rlpc::fuzz_check(!rlpc::parse_sequence_header(shorter));
  return 0;
}
