// The validator and the decoder on damaged streams: the error at which the decoder stops is the
// first that the validator finds, at the same bit; what decodes is clean.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "conformance/rlpcval/validator.h"
#include "conformance/testing/rig_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

const DecodeLimits kLimits{1U << 12, 1U << 13, 1U << 12, std::uint64_t{16} << 20};

std::optional<Error> decode_error(const StreamBytes& bytes) {
  DecoderOptions options;
  options.limits = kLimits;
  auto decoder = Decoder::open(memory_source(bytes), options);
  if (!decoder) return decoder.error();
  std::vector<std::int32_t> frame(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    if (!more) return more.error();
    if (!*more) return std::nullopt;
  }
}

// 4.6: rules that decoding in order does not check, as it does nothing within a GOF index unit.
bool checked_by_decoding(const Finding& finding) {
  constexpr std::array<std::string_view, 9> kUnchecked{"R-END-03", "R-HSH-03", "R-IDX-01",
                                                       "R-IDX-02", "R-IDX-03", "R-IDX-04",
                                                       "R-IDX-05", "R-IDX-06", "R-MET-03"};
  // Units that are skipped when positions are decoded; only their CRC and place are checked.
  const auto is_in = [&](UnitType type) {
    return finding.unit && finding.unit->type_byte == static_cast<std::uint8_t>(type);
  };
  const bool is_skipped =
      is_in(UnitType::kGofIndex) || is_in(UnitType::kAttributes) || is_in(UnitType::kAsset);
  const std::string_view topic = std::string_view(finding.id).substr(0, 5);
  if (topic == "R-ATT" || topic == "R-AST") return false;
  return std::find(kUnchecked.begin(), kUnchecked.end(), finding.id) == kUnchecked.end() &&
         !(is_skipped && topic == "R-BIT");
}

class Damage : public testing::TestWithParam<StreamBytes (*)()> {
 protected:
  void SetUp() override {
    stream_ = GetParam()();
    ASSERT_FALSE(stream_.empty());
  }

  void compare(const StreamBytes& bytes) {
    const auto error = decode_error(bytes);
    ValidationOptions options;
    options.limits = kLimits;
    const auto source = memory_source(bytes);
    const ValidationReport report = validate(*source, options);
    if (error && error->code == Errc::kLimitExceeded) {
      ASSERT_TRUE(report.stopped);
      return;
    }
    const Finding* first = report.first_failure();
    ASSERT_EQ(error.has_value(), first != nullptr)
        << (error ? error->rule : first->id) << " at " << (error ? error->bit_pos : 0);
    // A stream that decodes can still break what decoding does not check.
    for (const Finding& f : report.findings) {
      if (f.severity == Severity::kWarning || !checked_by_decoding(f)) continue;
      ASSERT_EQ(&f, first) << f.id << " comes first";
      break;
    }
    if (!error) return;
    ASSERT_STREQ(error->rule, first->id) << error->bit_pos << " and " << first->bit_pos;
    ASSERT_STREQ(error->element, first->element);
    ASSERT_EQ(error->bit_pos, first->bit_pos) << error->rule;
    ASSERT_EQ(error->code == Errc::kUnsupported, first->severity == Severity::kUnsupported);
    ASSERT_FALSE(first->consequence);
  }
  void compare_repaired(StreamBytes bytes) {
    repair_crcs(bytes);
    compare(bytes);
  }

  StreamBytes stream_;
};

TEST_P(Damage, EveryProperPrefix) {
  for (std::size_t n = 0; n < stream_.size(); ++n) {
    SCOPED_TRACE(testing::Message() << n << " bytes");
    ASSERT_NO_FATAL_FAILURE(
        compare({stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(n)}));
  }
}

TEST_P(Damage, EveryFlippedBitWithAndWithoutFittingCrcs) {
  for (std::size_t bit = 0; bit < 8 * stream_.size(); ++bit) {
    SCOPED_TRACE(testing::Message() << "bit " << bit);
    StreamBytes damaged = stream_;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ (128U >> (bit % 8)));
    ASSERT_NO_FATAL_FAILURE(compare(damaged));
    ASSERT_NO_FATAL_FAILURE(compare_repaired(damaged));
  }
}

// Changes several places at a time, so that there is something to find after the first error.
TEST_P(Damage, RandomBytes) {
  constexpr unsigned kSeeds = 3;
  for (unsigned seed = 0; seed < kSeeds; ++seed) {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < stream_.size(); ++i) {
      SCOPED_TRACE(testing::Message() << "byte " << i << ", seed " << seed);
      StreamBytes damaged = stream_;
      damaged[i] = static_cast<std::uint8_t>(random());
      for (int more = 0; more < 4; ++more) {
        damaged[random() % damaged.size()] = static_cast<std::uint8_t>(random());
      }
      ASSERT_NO_FATAL_FAILURE(compare(damaged));
      ASSERT_NO_FATAL_FAILURE(compare_repaired(damaged));
    }
  }
}

TEST_P(Damage, ShorterAndLongerPayloads) {
  for (const UnitPlace& unit : units_of(stream_)) {
    const std::span<const std::uint8_t> payload(stream_.data() + unit.payload(), unit.size);
    for (std::size_t n = 0; n < unit.size; ++n) {
      SCOPED_TRACE(testing::Message() << "unit at " << unit.offset << ", payload " << n);
      ASSERT_NO_FATAL_FAILURE(compare(with_payload(stream_, unit, payload.first(n))));
    }
    for (const std::uint8_t last : std::array<std::uint8_t, 3>{0, 1, 255}) {
      StreamBytes longer(payload.begin(), payload.end());
      longer.push_back(last);
      ASSERT_NO_FATAL_FAILURE(compare(with_payload(stream_, unit, longer)));
    }
  }
}

// All orders of two units, and each unit left out or repeated.
TEST_P(Damage, UnitsInOtherPlaces) {
  const auto units = units_of(stream_);
  const auto stream_of = [&](const std::vector<std::size_t>& order) {
    StreamBytes out(stream_.begin(), stream_.begin() + kStreamHeaderBytes);
    for (const std::size_t u : order) {
      const auto first = stream_.begin() + static_cast<std::ptrdiff_t>(units[u].offset);
      const auto last = stream_.begin() + static_cast<std::ptrdiff_t>(units[u].end());
      out.insert(out.end(), first, last);
    }
    return out;
  };
  std::vector<std::size_t> order;
  for (std::size_t u = 0; u < units.size(); ++u) order.push_back(u);
  for (std::size_t a = 0; a < units.size(); ++a) {
    for (std::size_t b = 0; b < units.size(); ++b) {
      SCOPED_TRACE(testing::Message() << "units " << a << " and " << b);
      std::vector<std::size_t> changed = order;
      std::swap(changed[a], changed[b]);
      ASSERT_NO_FATAL_FAILURE(compare(stream_of(changed)));
      changed = order;
      changed.insert(changed.begin() + static_cast<std::ptrdiff_t>(b), a);
      ASSERT_NO_FATAL_FAILURE(compare(stream_of(changed)));
      if (a == b) changed.erase(changed.begin() + static_cast<std::ptrdiff_t>(a));
      changed.erase(std::find(changed.begin(), changed.end(), b));
      ASSERT_NO_FATAL_FAILURE(compare(stream_of(changed)));
    }
  }
}

// All known types, and some unknown ones.
TEST_P(Damage, OtherTypes) {
  for (const UnitPlace& unit : units_of(stream_)) {
    for (const int type : {0, 1, 2, 3, 4, 5, 6, 7, 8, 127, 128, 129, 130, 131, 132, 255}) {
      SCOPED_TRACE(testing::Message() << "unit at " << unit.offset << ", type " << type);
      StreamBytes damaged = stream_;
      damaged[unit.offset] = static_cast<std::uint8_t>(type);
      ASSERT_NO_FATAL_FAILURE(compare(damaged));
      ASSERT_NO_FATAL_FAILURE(compare_repaired(damaged));
    }
  }
}

// Vertices shared by several fans of triangles, degenerate triangles, several components.
StreamBytes tangled_stream() {
  FrameSource::Shape shape;
  shape.triangles = {{0, 1, 2}, {0, 3, 4}, {0, 5, 6}, {1, 2, 7}, {1, 7, 8},
                     {3, 3, 4}, {5, 6, 9}, {2, 1, 9}, {6, 5, 9}};
  std::vector<std::vector<float>> frames;
  std::mt19937 random(1);
  for (int f = 0; f < 4; ++f) {
    std::vector<float> xyz(30);
    for (float& x : xyz) x = static_cast<float>(random() % 1000);
    frames.push_back(std::move(xyz));
  }
  MemoryFrames source(std::move(shape), std::move(frames));
  EncoderSettings settings;
  settings.profile = Profile::kBaseline;
  settings.target = {Target::kKg, 5.0};
  settings.keep_order = true;
  return encode_to_memory(source, settings);
}

std::string stream_name(const testing::TestParamInfo<StreamBytes (*)()>& stream) {
  constexpr std::array<const char*, 6> kNames{"Rich",   "Indexed", "Tangled",
                                              "Sliced", "Mixed",   "Rigs"};
  return kNames.at(stream.index);
}
INSTANTIATE_TEST_SUITE_P(Streams, Damage,
                         testing::Values(rich_stream, indexed_stream, tangled_stream,
                                         sliced_stream, mixed_stream, indexed_rig_stream),
                         stream_name);

}  // namespace
}  // namespace rlpc
