// Fuzzes the validator, and compares it with the decoder: the error at which a decoder stops is
// the one that the validator reports as such. The first byte of an input decides whether CRCs
// are repaired; otherwise few inputs would pass them.

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/stream_format.h"
#include "conformance/rlpcval/validator.h"
#include "decoder/rlpc_decoder.h"

namespace {

constexpr rlpc::DecodeLimits kLimits{5000, 10000, 1000, 64 << 20};

void repair_crcs(std::vector<std::uint8_t>& stream) {
  std::size_t at = rlpc::kStreamHeaderBytes;
  while (at + rlpc::kUnitHeaderBytes + rlpc::kUnitCrcBytes <= stream.size()) {
    std::size_t size = 0;
    for (std::size_t i = 1; i < rlpc::kUnitHeaderBytes; ++i) size = size << 8 | stream[at + i];
    const std::size_t crc_at = at + rlpc::kUnitHeaderBytes + size;
    if (crc_at + rlpc::kUnitCrcBytes > stream.size()) return;
    const std::uint32_t crc = rlpc::crc32_of(std::span(stream).subspan(at, crc_at - at));
    for (std::size_t i = 0; i < rlpc::kUnitCrcBytes; ++i) {
      stream[crc_at + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
    }
    at = crc_at + rlpc::kUnitCrcBytes;
  }
}

std::optional<rlpc::Error> decode(const std::vector<std::uint8_t>& stream) {
  rlpc::DecoderOptions options;
  options.limits = kLimits;
  auto decoder = rlpc::Decoder::open(rlpc::memory_source(stream), options);
  if (!decoder) return decoder.error();
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(positions);
    if (!more) return more.error();
    if (!*more) return std::nullopt;
  }
}

void compare(const std::optional<rlpc::Error>& error, const rlpc::ValidationReport& report) {
  const rlpc::Finding* first = report.first_failure();
  if (report.stopped && (!error || error->code == rlpc::Errc::kLimitExceeded)) return;
  if (!error && first == nullptr) return;
  if (error && first != nullptr && std::strcmp(error->rule, first->id) == 0 &&
      error->bit_pos == first->bit_pos) {
    return;
  }
  std::fprintf(stderr, "decoder: %s, validator: %s\n", error ? error->rule : "decodes",
               first != nullptr ? first->id : "decodes");
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::vector<std::uint8_t> stream(data + 1, data + size);
  if (data[0] % 4 != 0) repair_crcs(stream);
  rlpc::ValidationOptions options;
  options.limits = kLimits;
  const auto source = rlpc::memory_source(stream);
  compare(decode(stream), rlpc::validate(*source, options));
  return 0;
}
