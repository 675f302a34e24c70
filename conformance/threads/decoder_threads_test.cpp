// Tests that a decoder with several threads outputs the same frames as one with a single
// thread, and the same error after them.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "conformance/testing/rig_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

struct DecoderOutcome {
  std::vector<std::vector<std::int32_t>> frames;
  std::vector<std::string> metadata;  // metadata known after each frame
  bool complete = false;
  Errc code{};
  std::string rule;
  std::string element;
  std::uint64_t bit_pos = 0;

  bool operator==(const DecoderOutcome&) const = default;

  void fail(const Error& error) {
    code = error.code;
    rule = error.rule;
    element = error.element;
    bit_pos = error.bit_pos;
  }
};

DecoderOptions with_threads(std::uint32_t threads) {
  DecoderOptions options;
  options.threads = threads;
  return options;
}

DecoderOutcome decode(const StreamBytes& stream, const DecoderOptions& options) {
  DecoderOutcome outcome;
  auto decoder = Decoder::open(memory_source(StreamBytes(stream)), options);
  if (!decoder) {
    outcome.fail(decoder.error());
    return outcome;
  }
  std::vector<std::int32_t> frame(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    if (!more) outcome.fail(more.error());
    outcome.complete = more && !*more;
    if (!more || !*more) return outcome;
    outcome.frames.push_back(frame);
    outcome.metadata.push_back(decoder->metadata());
  }
}

// Returns GOFs of 7 frames, the last one of 3, without a check by the validator.
template <Profile profile, HashMode hash_mode>
StreamBytes encoded_stream() {
  MemoryFrames source = bending_tube(20, 45);
  EncoderSettings settings;
  settings.profile = profile;
  settings.target = {Target::kKg, 0.5};
  settings.gof_frames = 7;
  settings.keep_order = true;
  settings.hash_mode = hash_mode;
  settings.metadata = R"({"title":"tube"})";
  StreamBytes bytes;
  const auto report = encode(source, settings, [&](std::span<const std::uint8_t> more) {
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  });
  EXPECT_TRUE(report);
  return bytes;
}

class Threads : public testing::TestWithParam<StreamBytes (*)()> {
 protected:
  void SetUp() override {
    stream_ = GetParam()();
    whole_ = decode(stream_, with_threads(1));
    ASSERT_TRUE(whole_.complete);
    ASSERT_GE(whole_.frames.size(), 14U);
  }

  // Expects the same outcome with 2, 3 and 9 threads as with one.
  static DecoderOutcome expect_the_same(const StreamBytes& stream, DecoderOptions options) {
    options.threads = 1;
    DecoderOutcome outcome = decode(stream, options);
    for (const std::uint32_t threads : {2U, 3U, 9U}) {
      options.threads = threads;
      EXPECT_TRUE(decode(stream, options) == outcome) << threads << " threads";
    }
    return outcome;
  }

  StreamBytes stream_;
  DecoderOutcome whole_;
};

TEST_P(Threads, GiveTheSameFrames) { expect_the_same(stream_, {}); }

TEST_P(Threads, GiveTheSameErrorForDamageAnywhere) {
  std::mt19937 random(1);
  int failed = 0;
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    StreamBytes damaged = stream_;
    damaged[kStreamHeaderBytes + random() % (damaged.size() - kStreamHeaderBytes)] ^=
        static_cast<std::uint8_t>(1U << (random() % 8));
    if (i % 3 != 0) repair_crcs(damaged);
    if (!expect_the_same(damaged, {}).complete) ++failed;
  }
  EXPECT_GT(failed, 100);
}

TEST_P(Threads, GiveTheSameErrorForAStreamCutAnywhere) {
  std::mt19937 random(2);
  for (int i = 0; i < 50; ++i) {
    SCOPED_TRACE(i);
    const StreamBytes cut(stream_.begin(),
                          stream_.begin() + static_cast<int>(random() % stream_.size()));
    EXPECT_FALSE(expect_the_same(cut, {}).complete);
  }
}

TEST_P(Threads, GiveTheSameErrorForUnitsLeftOutOrTwice) {
  for (const UnitPlace& unit : units_of(stream_)) {
    SCOPED_TRACE(unit.offset);
    const auto begin = stream_.begin() + static_cast<std::ptrdiff_t>(unit.offset);
    const auto end = stream_.begin() + static_cast<std::ptrdiff_t>(unit.end());
    StreamBytes without(stream_.begin(), begin);
    without.insert(without.end(), end, stream_.end());
    expect_the_same(without, {});
    StreamBytes twice(stream_.begin(), end);
    twice.insert(twice.end(), begin, stream_.end());
    expect_the_same(twice, {});
  }
}

TEST_P(Threads, GiveTheSameErrorForASliceAfterAnyUnit) {
  const Bytes slice = write_unit(UnitType::kSlice, Bytes{0xC0, 0, 0, 0, 0});
  for (const UnitPlace& unit : units_of(stream_)) {
    SCOPED_TRACE(unit.offset);
    StreamBytes more = stream_;
    more.insert(more.begin() + static_cast<std::ptrdiff_t>(unit.end()), slice.begin(),
                slice.end());
    EXPECT_FALSE(expect_the_same(more, {}).complete);
  }
}

TEST_P(Threads, GiveTheSameErrorForTooLittleMemory) {
  int too_little = 0;
  for (std::uint64_t bytes = 10'000; bytes < 4'000'000; bytes += bytes / 4) {
    SCOPED_TRACE(bytes);
    DecoderOptions options;
    options.limits.max_memory_bytes = bytes;
    const DecoderOutcome outcome = expect_the_same(stream_, options);
    if (outcome.code == Errc::kLimitExceeded && !outcome.complete) ++too_little;
  }
  EXPECT_GT(too_little, 0);
}

TEST_P(Threads, SeekToTheSameFrames) {
  for (const std::uint32_t threads : {2U, 5U}) {
    auto decoder = Decoder::open(memory_source(StreamBytes(stream_)), with_threads(threads));
    ASSERT_TRUE(decoder);
    std::mt19937 random(threads);
    std::vector<std::int32_t> frame(3 * std::size_t{decoder->header().num_vertices});
    for (int i = 0; i < 100; ++i) {
      const auto first = static_cast<std::uint32_t>(random() % whole_.frames.size());
      ASSERT_TRUE(decoder->seek(first));
      for (std::uint32_t f = first; f < whole_.frames.size() && f < first + random() % 20;
           ++f) {
        const auto more = decoder->next_frame(frame);
        ASSERT_TRUE(more && *more) << f;
        ASSERT_EQ(frame, whole_.frames[f]) << f;
      }
    }
  }
}

TEST_P(Threads, CountTheSameGofs) {
  for (const std::uint32_t threads : {1U, 4U}) {
    auto decoder = Decoder::open(memory_source(StreamBytes(stream_)), with_threads(threads));
    ASSERT_TRUE(decoder);
    const auto gofs = decoder->parse_rest();
    ASSERT_TRUE(gofs);
    const std::vector<UnitPlace> units = units_of(stream_);
    EXPECT_EQ(*gofs, std::count_if(units.begin(), units.end(), [](const UnitPlace& unit) {
      return unit.type == UnitType::kGof;
    }));
  }
}

// Attributes need the whole first frame, while threads parse the next GOFs for a cut.
TEST(ThreadsOfACut, LeaveAttributesWhole) {
  MemoryFrames source = tube_with_normals(20, 45);
  EncoderSettings settings;
  settings.target = {Target::kKg, 0.5};
  settings.gof_frames = 4;
  settings.gof_kind = GofKind::kSkinned;  // can be cut
  settings.attributes.normals = NormalChoice::kExact;
  const StreamBytes stream = encode_to_memory(source, settings);
  auto whole = Decoder::open(memory_source(StreamBytes(stream)), with_threads(1));
  ASSERT_TRUE(whole);
  const auto wanted = whole->attributes();
  ASSERT_TRUE(wanted);
  DecoderOptions options;
  options.cut.max_components = 1;
  const DecoderOutcome cut = decode(stream, options);
  ASSERT_EQ(cut.frames.size(), 45U);
  ASSERT_NE(cut.frames, decode(stream, {}).frames);
  options.threads = 4;
  for (const std::uint32_t before : {0U, 1U, 4U, 6U, 30U, 44U}) {
    SCOPED_TRACE(before);
    auto decoder = Decoder::open(memory_source(StreamBytes(stream)), options);
    ASSERT_TRUE(decoder);
    std::vector<std::int32_t> frame(3 * std::size_t{decoder->num_vertices()});
    for (std::uint32_t f = 0; f < 45; ++f) {
      if (f == before) {
        const auto sets = decoder->attributes();
        ASSERT_TRUE(sets);
        EXPECT_EQ((*sets)[0].values, (*wanted)[0].values);
      }
      const auto more = decoder->next_frame(frame);
      ASSERT_TRUE(more && *more) << f;
      ASSERT_EQ(frame, cut.frames[f]) << f;
    }
  }
}

std::string stream_name(const testing::TestParamInfo<StreamBytes (*)()>& stream) {
  constexpr std::array<const char*, 8> kNames{
      "Baseline", "BaselineFrameHashes", "Main", "MainFrameHashes",
      "Mixed",    "EncodedModels",       "Rigs", "IndexedRigs"};
  return kNames.at(stream.index);
}
INSTANTIATE_TEST_SUITE_P(Streams, Threads,
                         testing::Values(encoded_stream<Profile::kBaseline, HashMode::kGof>,
                                         encoded_stream<Profile::kBaseline, HashMode::kFrame>,
                                         encoded_stream<Profile::kMain, HashMode::kGof>,
                                         encoded_stream<Profile::kMain, HashMode::kFrame>,
                                         mixed_stream,
                                         encoded_stream<Profile::kHigh, HashMode::kGof>,
                                         rig_stream, indexed_rig_stream),
                         stream_name);

}  // namespace
}  // namespace rlpc
