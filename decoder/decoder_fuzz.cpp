// Fuzzes the whole decoder. The CRCs of the units are repaired first, or hardly an input would
// get past them.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/crc32.h"
#include "common/stream_format.h"
#include "decoder/rlpc_decoder.h"

namespace {

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

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::vector<std::uint8_t> stream(data, data + size);
  repair_crcs(stream);
  rlpc::DecoderOptions options;
  options.limits = {5000, 10000, 1000, 64 << 20};
  auto decoder = rlpc::Decoder::open(rlpc::memory_source(std::move(stream)), options);
  if (!decoder) return 0;
  std::vector<std::int32_t> positions(3 * std::size_t{decoder->header().num_vertices});
  if (!decoder->seek(decoder->header().num_frames - 1)) return 0;
  if (!decoder->seek(0)) return 0;
  for (;;) {
    const auto more = decoder->next_frame(positions);
    if (!more || !*more) return 0;
  }
}
