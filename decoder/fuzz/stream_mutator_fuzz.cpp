// Mutations of whole streams, for libFuzzer. They mutate units and then repair sizes and CRCs;
// otherwise almost all mutated streams would fail R-UNT-03. Linked into the targets whose input
// is a stream.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <random>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/bits/crc32.h"
#include "common/codec/syntax/stream_format.h"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size,
                                        std::size_t max_size);

namespace {

using Bytes = std::vector<std::uint8_t>;
using Random = std::minstd_rand;

struct Unit {
  std::uint8_t type_byte;
  Bytes payload;
};

struct Stream {
  Bytes header;
  std::vector<Unit> units;
  Bytes rest;  // bytes that are not units
};

std::size_t below(Random& random, std::size_t n) { return random() % n; }

Stream split(std::span<const std::uint8_t> bytes) {
  Stream stream;
  std::size_t at = std::min(bytes.size(), rlpc::kStreamHeaderBytes);
  stream.header.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(at));
  constexpr std::size_t kFrame = rlpc::kUnitHeaderBytes + rlpc::kUnitCrcBytes;
  while (bytes.size() - at >= kFrame) {
    std::size_t size = 0;
    for (std::size_t i = 1; i < rlpc::kUnitHeaderBytes; ++i) size = size << 8 | bytes[at + i];
    if (size > bytes.size() - at - kFrame) break;
    const auto payload = bytes.subspan(at + rlpc::kUnitHeaderBytes, size);
    stream.units.push_back({bytes[at], Bytes(payload.begin(), payload.end())});
    at += kFrame + size;
  }
  const auto rest = bytes.subspan(at);
  stream.rest.assign(rest.begin(), rest.end());
  return stream;
}

void append_u32(Bytes& bytes, std::size_t value) {
  for (int shift = 24; shift >= 0; shift -= 8) {
    bytes.push_back(static_cast<std::uint8_t>(value >> shift));
  }
}

Bytes join(const Stream& stream) {
  Bytes bytes = stream.header;
  for (const Unit& unit : stream.units) {
    const std::size_t first = bytes.size();
    bytes.push_back(unit.type_byte);
    append_u32(bytes, unit.payload.size());
    bytes.insert(bytes.end(), unit.payload.begin(), unit.payload.end());
    append_u32(bytes, rlpc::crc32_of(std::span<const std::uint8_t>(bytes).subspan(first)));
  }
  bytes.insert(bytes.end(), stream.rest.begin(), stream.rest.end());
  return bytes;
}

void mutate_payload(Unit& unit, std::size_t room, Random& random) {
  const std::size_t size = unit.payload.size();
  unit.payload.resize(size + std::min<std::size_t>(room, 1 + below(random, 64)));
  unit.payload.resize(LLVMFuzzerMutate(unit.payload.data(), size, unit.payload.size()));
}

void mutate(Stream& stream, std::size_t room, Random& random) {
  auto& units = stream.units;
  const std::size_t i = below(random, units.size());
  const std::size_t j = below(random, units.size());
  constexpr std::uint8_t kTypes[] = {1, 2, 3, 4, 5, 6, 7, 0x80, 0x81, 0x82, 0x83};
  switch (below(random, 16)) {
    case 0:
      units.erase(units.begin() + static_cast<std::ptrdiff_t>(i));
      break;
    case 1: {
      Unit copy = units[j];
      units.insert(units.begin() + static_cast<std::ptrdiff_t>(i), std::move(copy));
      break;
    }
    case 2:
      std::swap(units[i], units[j]);
      break;
    case 3:
      units[i].type_byte = kTypes[below(random, std::size(kTypes))];
      break;
    case 4:
      stream.rest.clear();
      break;
    default:
      mutate_payload(units[i], room, random);
      break;
  }
}

std::optional<std::size_t> store(const Stream& stream, std::uint8_t* data,
                                 std::size_t max_size) {
  const Bytes bytes = join(stream);
  if (bytes.empty() || bytes.size() > max_size) return std::nullopt;
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned int seed) {
  Random random(seed);
  Stream stream = split({data, size});
  // Occasionally without repair, because sizes, CRCs and the stream header are input as well.
  if (stream.units.empty() || below(random, 16) == 0) {
    return LLVMFuzzerMutate(data, size, max_size);
  }
  mutate(stream, max_size - std::min(size, max_size), random);
  return store(stream, data, max_size).value_or(std::min(size, max_size));
}

// Inserts a unit of the second stream into the first, in place of or after a unit of the same
// type.
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data1, std::size_t size1,
                                                 const std::uint8_t* data2, std::size_t size2,
                                                 std::uint8_t* out, std::size_t max_size,
                                                 unsigned int seed) {
  Random random(seed);
  Stream stream = split({data1, size1});
  const Stream other = split({data2, size2});
  if (stream.units.empty() || other.units.empty()) return 0;
  const Unit& donor = other.units[below(random, other.units.size())];
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < stream.units.size(); ++i) {
    if (stream.units[i].type_byte == donor.type_byte) places.push_back(i);
  }
  if (places.empty()) {
    stream.units.push_back(donor);
  } else {
    stream.units[places[below(random, places.size())]] = donor;
  }
  return store(stream, out, max_size).value_or(0);
}
