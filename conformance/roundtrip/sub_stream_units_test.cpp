// Tests cuts of streams with arbitrary units in arbitrary order: each cut fails or conforms.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "conformance/testing/cut_streams.h"

namespace rlpc {
namespace {

constexpr SliceCut kCuts[] = {{}, {0, 1}, {1, 1}, {1, SliceCut::kAll}, {SliceCut::kAll, 1}};

// Returns the rules that a stream breaks: either those that stop a decoder, or the others.
std::vector<std::string> broken_rules(const StreamBytes& stream, bool stops_decoder) {
  const auto source = memory_source(stream);
  std::vector<std::string> rules;
  for (const Finding& f : validate(*source).findings) {
    if (f.severity == Severity::kWarning || f.stops_decoder != stops_decoder) continue;
    rules.emplace_back(f.id);
  }
  return rules;
}

struct CutResult {
  std::string error;  // "" if there is a stream
  StreamBytes stream;
};

CutResult try_cut(const StreamBytes& stream, const SliceCut& cut) {
  auto extractor = SubStreamExtractor::open(memory_source(stream), cut);
  if (!extractor) return {extractor.error().rule, {}};
  StreamBytes out;
  for (;;) {
    const auto bytes = extractor->next();
    if (!bytes) return {bytes.error().rule, {}};
    if (bytes->empty()) return {"", out};
    out.insert(out.end(), bytes->begin(), bytes->end());
  }
}

// Expects that a stream that decodes is cut to one that conforms, and that cutting fails where
// decoding does. Returns whether there is a cut stream.
bool check_cut(const StreamBytes& stream, const SliceCut& cut) {
  const CutResult result = try_cut(stream, cut);
  const std::vector<std::string> stops = broken_rules(stream, true);
  const std::vector<std::string> others = broken_rules(stream, false);
  const bool bad_metadata = std::count(others.begin(), others.end(), "R-MET-03") > 0;
  if (!stops.empty()) {
    EXPECT_EQ(result.error, stops.front());
  } else {
    EXPECT_EQ(result.error, bad_metadata ? "R-MET-03" : "");
  }
  if (!result.error.empty()) return false;
  EXPECT_NO_THROW(require_conforming(result.stream));
  DecoderOptions as_cut;
  as_cut.cut = cut;
  EXPECT_EQ(decode_all(result.stream), decode_all(stream, as_cut));
  return true;
}

std::vector<std::filesystem::path> streams_of_suites() {
  const std::filesystem::path root = std::string(RLPC_SOURCE_DIR) + "/streams";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(root)) {
    const std::string path = entry.path().string();
    const bool accept = path.find("/accept/") != std::string::npos;
    if (accept && entry.path().extension() == ".rlpc") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

StreamBytes stream_in(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return StreamBytes(std::istreambuf_iterator<char>(file), {});
}

TEST(SubStreamUnits, StreamsOfTheSuitesAreCut) {
  const auto paths = streams_of_suites();
  EXPECT_GT(paths.size(), 180U);
  std::size_t shorter = 0;
  for (const auto& path : paths) {
    SCOPED_TRACE(path.filename().string());
    const StreamBytes stream = stream_in(path);
    EXPECT_EQ(try_cut(stream, {}).stream, stream);
    for (const SliceCut& cut : kCuts) {
      EXPECT_TRUE(check_cut(stream, cut));
      if (try_cut(stream, cut).stream.size() < stream.size()) ++shorter;
    }
  }
  EXPECT_GT(shorter, 100U);
}

Bytes unit_at(const StreamBytes& stream, const UnitPlace& unit) {
  const auto begin = stream.begin() + static_cast<std::ptrdiff_t>(unit.offset);
  return Bytes(begin, begin + static_cast<std::ptrdiff_t>(unit.end() - unit.offset));
}

Bytes metadata_unit(std::string_view text) {
  // Append one stored block and its Adler-32.
  const auto size = static_cast<std::uint8_t>(text.size());
  Bytes payload{0, 0, 0, size, 0x78, 0x01, 1, size, 0, static_cast<std::uint8_t>(~size), 0xFF};
  payload.insert(payload.end(), text.begin(), text.end());
  std::uint32_t a = 1;
  std::uint32_t b = 0;
  for (const char c : text) {
    a = (a + static_cast<std::uint8_t>(c)) % 65521;
    b = (b + a) % 65521;
  }
  for (const std::uint32_t half : {b, a}) {
    payload.push_back(static_cast<std::uint8_t>(half >> 8));
    payload.push_back(static_cast<std::uint8_t>(half));
  }
  return write_unit(UnitType::kMetadata, payload);
}

class UnitShuffler {
 public:
  explicit UnitShuffler(const StreamBytes& stream)
      : header_(stream.begin(), stream.begin() + kStreamHeaderBytes) {
    for (const UnitPlace& unit : units_of(stream)) units_.push_back(unit_at(stream, unit));
    strange_ = {
        write_unit(static_cast<UnitType>(0xC8), {1, 2, 3}),
        write_unit(UnitType::kGofHash, write_gof_hash(std::vector{1U, 2U}, true)),
        write_unit(UnitType::kGofHash, write_gof_hash(std::vector{1U}, false)),
        write_unit(UnitType::kGofHash, {}),
        write_unit(UnitType::kGofIndex, write_gof_index({70, {{2, 9}}, {}}, kProfileMain)),
        write_unit(UnitType::kGofIndex, {7}),
        metadata_unit("{\"a\": 1}"),
        metadata_unit("{\"a\": 1"),
    };
  }

  // Returns the units after some changes; the first and the last unit stay.
  StreamBytes stream(std::mt19937& random) const {
    std::vector<Bytes> units = units_;
    const auto below = [&random](std::size_t n) { return random() % n; };
    const auto at = [&](std::size_t n) {
      return units.begin() + static_cast<std::ptrdiff_t>(n);
    };
    for (std::size_t changes = 1 + below(3); changes > 0; --changes) {
      const std::size_t from = 1 + below(units.size() - 2);
      const std::size_t to = 1 + below(units.size() - 1);
      switch (below(8)) {
        case 0:
          std::swap(units[from], units[1 + below(units.size() - 2)]);
          break;
        case 1:
          units.insert(at(to), Bytes(units[from]));
          break;
        case 2:
          if (units.size() > 4) units.erase(at(from));
          break;
        default:
          units.insert(at(to), strange_[below(strange_.size())]);
      }
    }
    StreamBytes out = header_;
    for (const Bytes& unit : units) out.insert(out.end(), unit.begin(), unit.end());
    return out;
  }

 private:
  StreamBytes header_;
  std::vector<Bytes> units_;
  std::vector<Bytes> strange_;
};

TEST(SubStreamUnits, AnyOrderOfUnitsFailsOrConforms) {
  std::mt19937 random(4);
  for (const StreamBytes& stream :
       {sliced_stream(), ordered_stream(), mixed_stream(), indexed_stream()}) {
    const UnitShuffler shuffler(stream);
    std::size_t cut = 0;
    constexpr std::size_t kCases = 400;
    for (std::size_t i = 0; i < kCases && !testing::Test::HasFailure(); ++i) {
      SCOPED_TRACE(testing::Message() << "case " << i);
      if (check_cut(shuffler.stream(random), kCuts[i % std::size(kCuts)])) ++cut;
    }
    EXPECT_GT(cut, kCases / 20);
    EXPECT_LT(cut, kCases * 9 / 10);
  }
}

// Without the index between them, the hash would be that of the GOF.
TEST(SubStreamUnits, AStrayHashStaysNoHash) {
  const StreamBytes stream = sliced_stream();
  const Bytes index =
      write_unit(UnitType::kGofIndex, write_gof_index({70, {{4, 9}}, {}}, kProfileMain));
  StreamBytes stray(stream.begin(), stream.begin() + kStreamHeaderBytes);
  for (const UnitPlace& unit : units_of(stream)) {
    if (unit.type == UnitType::kGofHash) stray.insert(stray.end(), index.begin(), index.end());
    const Bytes bytes = unit_at(stream, unit);
    stray.insert(stray.end(), bytes.begin(), bytes.end());
  }
  const CutResult result = try_cut(stray, {1, 1});
  EXPECT_EQ(result.error, "");
  require_conforming(result.stream);
  std::vector<UnitType> ends;
  for (const UnitPlace& unit : units_of(result.stream)) {
    EXPECT_NE(unit.type, UnitType::kGofHash);
    ends.push_back(unit.type);
  }
  EXPECT_EQ(ends[ends.size() - 2], UnitType::kGofIndex);
  EXPECT_EQ(decode_all(result.stream), decode_all(cut_stream(stream, {1, 1})));
}

// A hash that does not fit is not replaced by one that does.
TEST(SubStreamUnits, CuttingDoesNotRepairAWrongHash) {
  StreamBytes wrong = sliced_stream();
  for (const UnitPlace& unit : units_of(wrong)) {
    if (unit.type == UnitType::kGofHash) wrong[unit.payload() + 3] ^= 1;
  }
  repair_crcs(wrong);
  for (const SliceCut& cut : kCuts) EXPECT_EQ(try_cut(wrong, cut).error, "R-HSH-02");
}

}  // namespace
}  // namespace rlpc
