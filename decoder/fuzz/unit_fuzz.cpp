// Fuzzes the unit reader: units are consecutive and lie within the stream, and their payloads
// have the stated size or a CRC error.

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "common/testing/fuzz_input.h"
#include "decoder/codec/units/unit_reader.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::uint32_t kStartBytes = 16;
  rlpc::UnitReader reader(rlpc::memory_source(std::vector<std::uint8_t>(data, data + size)),
                          nullptr);
  if (!reader.stream_header()) return 0;
  for (std::uint64_t offset = rlpc::kStreamHeaderBytes;;) {
    const auto unit = reader.header_at(offset);
    if (!unit) return 0;
    rlpc::fuzz_check(unit->end() > offset && unit->end() <= size);
    const auto start = reader.payload_start(*unit, kStartBytes);
    rlpc::fuzz_check(start && start->size() == std::min(unit->size, kStartBytes));
    const auto payload = reader.payload(*unit);
    rlpc::fuzz_check(payload ? payload->size() == unit->size
                             : std::string_view(payload.error().rule) == "R-UNT-03");
    offset = unit->end();
  }
}
