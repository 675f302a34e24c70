// Fuzzes the whole decoder. stream_mutator_fuzz.cpp keeps the CRCs of the units valid.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/testing/fuzz_input.h"
#include "decoder/rlpc_decoder.h"

namespace {

using Positions = std::vector<std::int32_t>;

constexpr rlpc::DecodeLimits kLimits{2000, 4000, 200, 8 << 20};

rlpc::Result<rlpc::Decoder> open(std::span<const std::uint8_t> stream, bool verify_hashes) {
  rlpc::DecoderOptions options;
  options.limits = kLimits;
  options.verify_hashes = verify_hashes;
  return rlpc::Decoder::open(rlpc::memory_source({stream.begin(), stream.end()}), options);
}

// Checks, for a stream that was decoded completely, that seeking back decodes the same first
// frame, and that parsing succeeds.
void check_again(rlpc::Decoder& decoder, const Positions& first) {
  Positions again(first.size());
  rlpc::fuzz_check(static_cast<bool>(decoder.seek(0)));
  const auto more = decoder.next_frame(again);
  rlpc::fuzz_check(more && *more && again == first);
  rlpc::fuzz_check(static_cast<bool>(decoder.parse_rest()));
}

// Decodes frame after frame; returns the rule of the first error.
std::string_view decode(std::span<const std::uint8_t> stream, bool verify_hashes) {
  auto decoder = open(stream, verify_hashes);
  if (!decoder) return decoder.error().rule;
  Positions positions(3 * std::size_t{decoder->header().num_vertices});
  Positions first;
  std::uint32_t frames = 0;
  for (;;) {
    const auto more = decoder->next_frame(positions);
    if (!more) return more.error().rule;
    if (!*more) break;
    if (frames++ == 0) first = positions;
  }
  rlpc::fuzz_check(frames == decoder->header().num_frames);
  check_again(*decoder, first);
  return "";
}

// Seeks with the GOF index, if any; its contents may be wrong.
void decode_last(std::span<const std::uint8_t> stream) {
  auto decoder = open(stream, true);
  if (!decoder || !decoder->seek(decoder->header().num_frames - 1)) return;
  Positions positions(3 * std::size_t{decoder->header().num_vertices});
  (void)decoder->next_frame(positions);
}

// Drops some of the slices, if any.
void decode_cut(std::span<const std::uint8_t> stream) {
  rlpc::DecoderOptions options;
  options.limits = kLimits;
  options.cut = {static_cast<std::uint32_t>(stream.size() % 4),
                 static_cast<std::uint32_t>(1 + stream.size() % 3)};
  auto decoder =
      rlpc::Decoder::open(rlpc::memory_source({stream.begin(), stream.end()}), options);
  if (!decoder) return;
  Positions positions(3 * std::size_t{decoder->header().num_vertices});
  for (auto more = decoder->next_frame(positions); more && *more;) {
    more = decoder->next_frame(positions);
  }
}

// Checks, for a stream that was decoded as far as the limits allow, that a coarse mesh has the
// positions of the whole mesh.
void decode_coarse(std::span<const std::uint8_t> stream) {
  rlpc::DecoderOptions options;
  options.limits = kLimits;
  options.verify_hashes = false;
  options.coarse_layers = static_cast<std::uint32_t>(1 + stream.size() % 4);
  auto coarse =
      rlpc::Decoder::open(rlpc::memory_source({stream.begin(), stream.end()}), options);
  if (!coarse) {
    rlpc::fuzz_check(coarse.error().code == rlpc::Errc::kLimitExceeded);
    return;
  }
  auto whole = open(stream, false);
  rlpc::fuzz_check(static_cast<bool>(whole));
  const auto vertices = coarse->coarse_vertices();
  for (const rlpc::Triangle& t : coarse->triangles()) {
    for (const std::uint32_t v : t) rlpc::fuzz_check(v < vertices.size());
  }
  Positions all(3 * std::size_t{whole->num_vertices()});
  Positions some(3 * vertices.size());
  for (;;) {
    const auto more = coarse->next_frame(some);
    const auto expected = whole->next_frame(all);
    if (!more || !expected) {
      const rlpc::Errc code = more ? expected.error().code : more.error().code;
      rlpc::fuzz_check(code == rlpc::Errc::kLimitExceeded);
      return;
    }
    rlpc::fuzz_check(*expected == *more);
    if (!*more) return;
    for (std::size_t i = 0; i < some.size(); ++i) {
      rlpc::fuzz_check(some[i] == all[3 * std::size_t{vertices[i / 3]} + i % 3]);
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::span<const std::uint8_t> stream(data, size);
  std::string_view rule = decode(stream, true);
  // Continue past the hash of a mutated GOF.
  if (rule == "R-HSH-02") rule = decode(stream, false);
  if (rule.empty()) decode_coarse(stream);
  decode_last(stream);
  decode_cut(stream);
  return 0;
}
