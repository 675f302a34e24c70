// Tests frames in any order with GOFs that are kept and prefetched: frames are the same, and no
// GOF is decoded again without need.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "conformance/testing/rig_animation.h"
#include "conformance/testing/small_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

constexpr std::uint64_t kAmpleCache = std::uint64_t{64} << 20;

using Frame = std::vector<std::int32_t>;

// Counts what is read of a stream.
class CountedSource final : public ByteSource {
 public:
  CountedSource(const StreamBytes& bytes, std::uint64_t& num_bytes)
      : bytes_(bytes), num_bytes_(num_bytes) {}
  std::uint64_t size() const override { return bytes_.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > bytes_.size() || out.size() > bytes_.size() - offset) return false;
    num_bytes_ += out.size();
    std::copy_n(bytes_.begin() + static_cast<std::ptrdiff_t>(offset), out.size(), out.begin());
    return true;
  }

 private:
  const StreamBytes& bytes_;
  std::uint64_t& num_bytes_;
};

StreamBytes main_stream() {
  MemoryFrames source = tube_with_normals(6, 26);
  EncoderSettings settings;
  settings.target = {Target::kKg, 0.5};
  settings.gof_frames = 8;
  settings.attributes.normals = NormalChoice::kExact;
  return encode_to_memory(source, settings);
}

StreamBytes stream_of_frames(const std::optional<FramePattern>& pattern, InterWeights weights) {
  MemoryFrames source = tube_with_normals(6, 26);
  EncoderSettings settings;
  settings.profile = Profile::kHigh;
  settings.gof_kind = GofKind::kInter;
  settings.target = {Target::kKg, 0.5};
  settings.gof_frames = 8;
  settings.attributes.normals = NormalChoice::kExact;
  settings.inter.pattern = pattern;
  settings.inter.weights = weights;
  settings.hash_mode = HashMode::kFrame;
  return encode_to_memory(source, settings);
}
StreamBytes chained_stream() {
  return stream_of_frames(FramePattern{}, InterWeights::kLearned);
}
StreamBytes dyadic_stream() {
  return stream_of_frames(FramePattern{FramePattern::kDyadic, 2, {}, 1},
                          InterWeights::kLearned);
}
// Each frame but the first can be decoded alone.
StreamBytes independent_stream() {
  return stream_of_frames(FramePattern{FramePattern::kFirst, 1, {}, 1},
                          InterWeights::kGeometry);
}

class RandomAccess : public testing::TestWithParam<StreamBytes (*)()> {
 protected:
  void SetUp() override {
    stream_ = GetParam()();
    ASSERT_FALSE(stream_.empty());
    auto decoder = open({});
    Frame frame(3 * std::size_t{decoder->num_vertices()});
    while (*decoder->next_frame(frame)) frames_.push_back(frame);
    ASSERT_GE(frames_.size(), 12U);
    ASSERT_EQ(frames_.size(), decoder->header().num_frames);
  }

  Result<Decoder> open(const DecoderOptions& options) {
    auto decoder = Decoder::open(std::make_unique<CountedSource>(stream_, num_bytes_), options);
    EXPECT_TRUE(decoder);
    return decoder;
  }
  void expect_frame(Decoder& decoder, std::uint32_t f) {
    Frame frame(3 * std::size_t{decoder.num_vertices()});
    const auto ok = decoder.frame(f, frame);
    ASSERT_TRUE(ok && *ok) << f << (ok ? "" : ok.error().element);
    ASSERT_EQ(frame, frames_[f]) << f;
    ASSERT_EQ(decoder.position(), f + 1);
  }
  std::uint32_t last() const { return static_cast<std::uint32_t>(frames_.size()) - 1; }

  StreamBytes stream_;
  std::vector<Frame> frames_;
  std::uint64_t num_bytes_ = 0;
};

TEST_P(RandomAccess, GivesTheFramesOfDecodingInOrder) {
  for (const std::uint32_t threads : {1U, 2U, 4U}) {
    for (const std::uint64_t cached : {std::uint64_t{0}, std::uint64_t{20000}, kAmpleCache}) {
      DecoderOptions options;
      options.threads = threads;
      options.max_cached_bytes = cached;
      auto decoder = open(options);
      std::mt19937 random(threads);
      for (int i = 0; i < 60; ++i) {
        const auto f = static_cast<std::uint32_t>(random() % frames_.size());
        if (random() % 3 == 0) {
          ASSERT_TRUE(decoder->prefetch(static_cast<std::uint32_t>(random() % frames_.size())));
        }
        // Runs in either direction.
        const auto count = static_cast<std::uint32_t>(random() % 8);
        const bool back = random() % 2 == 0;
        for (std::uint32_t k = 0; k <= count; ++k) {
          if (back ? k > f : f + k > last()) break;
          ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, back ? f - k : f + k))
              << threads << " threads, " << cached << " bytes";
        }
      }
      EXPECT_LE(decoder->memory().cached_bytes, cached);
    }
  }
}

TEST_P(RandomAccess, BackwardGivesTheSameFrames) {
  for (const std::uint32_t threads : {1U, 2U}) {
    DecoderOptions options;
    options.threads = threads;
    options.max_cached_bytes = kAmpleCache;
    auto decoder = open(options);
    for (std::uint32_t f = last() + 1; f-- > 0;) {
      ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, f));
    }
  }
}

TEST_P(RandomAccess, AlternatingBetweenGofsReadsNothingAgain) {
  DecoderOptions options;
  options.max_cached_bytes = kAmpleCache;
  auto decoder = open(options);
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, 0));
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, last()));
  const std::uint64_t before = num_bytes_;
  for (int i = 0; i < 6; ++i) {
    ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, i % 2 == 0 ? 1 : last() - 1));
  }
  EXPECT_EQ(num_bytes_, before);
  EXPECT_GT(decoder->memory().cached_bytes, 0U);

  auto without = open({});
  ASSERT_NO_FATAL_FAILURE(expect_frame(*without, 0));
  ASSERT_NO_FATAL_FAILURE(expect_frame(*without, last()));
  const std::uint64_t then = num_bytes_;
  ASSERT_NO_FATAL_FAILURE(expect_frame(*without, 1));
  EXPECT_GT(num_bytes_, then);
  EXPECT_EQ(without->memory().cached_bytes, 0U);
}

TEST_P(RandomAccess, APrefetchedGofIsThereWithOneThread) {
  DecoderOptions options;
  options.max_cached_bytes = kAmpleCache;
  auto decoder = open(options);
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, 0));
  ASSERT_TRUE(decoder->prefetch(last()));
  EXPECT_EQ(decoder->position(), 1U);
  const std::uint64_t before = num_bytes_;
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, last()));
  EXPECT_EQ(num_bytes_, before);
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, 1));
}

TEST_P(RandomAccess, GofsCoverTheSequence) {
  auto decoder = open({});
  const auto gofs = decoder->gofs();
  ASSERT_TRUE(gofs);
  ASSERT_GE(gofs->size(), 3U);
  std::uint32_t next = 0;
  for (const GofRange& gof : *gofs) {
    EXPECT_EQ(gof.first_frame, next);
    for (const std::uint32_t f : {gof.first_frame, gof.first_frame + gof.num_frames - 1}) {
      const auto found = decoder->gof_of(f);
      ASSERT_TRUE(found);
      EXPECT_EQ(*found, gof);
    }
    next += gof.num_frames;
  }
  EXPECT_EQ(next, frames_.size());
  // None of that has moved the decoder.
  EXPECT_EQ(decoder->position(), 0U);
  ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, 0));
}

TEST_P(RandomAccess, GoesOnAfterDamage) {
  StreamBytes whole = stream_;
  for (const UnitPlace& unit : units_of(whole)) {
    if (unit.type != UnitType::kGof) continue;
    stream_[unit.crc()] ^= 1;
    break;
  }
  for (const std::uint32_t threads : {1U, 2U}) {
    DecoderOptions options;
    options.threads = threads;
    options.max_cached_bytes = kAmpleCache;
    auto decoder = open(options);
    Frame frame(3 * std::size_t{decoder->num_vertices()});
    ASSERT_TRUE(decoder->prefetch(1));  // its error comes with the frame
    const auto failed = decoder->frame(1, frame);
    ASSERT_FALSE(failed);
    EXPECT_STREQ(failed.error().rule, "R-UNT-03");
    ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, last()));
    EXPECT_FALSE(decoder->frame(0, frame));
    ASSERT_NO_FATAL_FAILURE(expect_frame(*decoder, last()));
  }
}

class AttributesOfStreams : public RandomAccess {};

TEST_P(AttributesOfStreams, LeaveTheDecoderWhereItIs) {
  auto wanted = open({})->attributes();
  ASSERT_TRUE(wanted);
  ASSERT_EQ(wanted->size(), 1U);
  for (const std::uint64_t cached : {std::uint64_t{0}, kAmpleCache}) {
    for (const std::uint32_t before : {0U, 1U, 7U, 8U, 9U, last(), last() + 1}) {
      DecoderOptions options;
      options.max_cached_bytes = cached;
      auto decoder = open(options);
      Frame frame(3 * std::size_t{decoder->num_vertices()});
      for (std::uint32_t f = 0; f < std::min(before, last() + 1); ++f) {
        ASSERT_TRUE(*decoder->next_frame(frame));
      }
      if (before > last()) {
        ASSERT_FALSE(*decoder->next_frame(frame));
      }
      const auto sets = decoder->attributes();
      ASSERT_TRUE(sets);
      EXPECT_EQ((*sets)[0].values, (*wanted)[0].values);
      EXPECT_EQ(decoder->position(), std::min(before, last() + 1));
      for (std::uint32_t f = before; f <= last(); ++f) {
        ASSERT_TRUE(*decoder->next_frame(frame)) << before;
        ASSERT_EQ(frame, frames_[f]) << before;
      }
      ASSERT_FALSE(*decoder->next_frame(frame)) << before;
    }
  }
}

TEST_P(AttributesOfStreams, NeedTheFirstGofAlone) {
  std::vector<UnitPlace> gofs;
  for (const UnitPlace& unit : units_of(stream_)) {
    if (unit.type == UnitType::kGof) gofs.push_back(unit);
  }
  stream_[gofs[1].crc()] ^= 1;
  auto decoder = open({});
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  const std::uint32_t second = (*decoder->gofs())[1].first_frame;
  for (std::uint32_t f = 0; f < second; ++f) ASSERT_TRUE(*decoder->next_frame(frame));
  EXPECT_TRUE(decoder->attributes());
  EXPECT_FALSE(decoder->next_frame(frame));
  EXPECT_TRUE(decoder->attributes());
  EXPECT_FALSE(decoder->next_frame(frame)) << "still";
  stream_[gofs[1].crc()] ^= 1;
  stream_[gofs[0].crc()] ^= 1;
  EXPECT_FALSE(open({})->attributes());
}

TEST_P(RandomAccess, PrefetchingAtTheEndLeavesItThere) {
  DecoderOptions options;
  options.max_cached_bytes = kAmpleCache;
  auto decoder = open(options);
  Frame frame(3 * std::size_t{decoder->num_vertices()});
  while (*decoder->next_frame(frame)) {
  }
  ASSERT_TRUE(decoder->prefetch(0));
  const auto more = decoder->next_frame(frame);
  ASSERT_TRUE(more);
  EXPECT_FALSE(*more);
}

TEST_P(RandomAccess, KeptGofsGiveWayToTheLimit) {
  // The least memory that decoding without kept GOFs takes.
  DecoderOptions options;
  const auto is_enough = [&] {
    auto decoder = Decoder::open(memory_source(StreamBytes(stream_)), options);
    Frame frame(frames_[0].size());
    return decoder && decoder->frame(last(), frame) && decoder->frame(0, frame);
  };
  options.limits.max_memory_bytes = open({})->memory().stream_bytes;
  while (!is_enough()) options.limits.max_memory_bytes += 1000;
  options.max_cached_bytes = kAmpleCache;
  auto tight = open(options);
  for (int i = 0; i < 8; ++i) {
    ASSERT_NO_FATAL_FAILURE(expect_frame(*tight, i % 2 == 0 ? 1 : last() - 1));
  }
}

std::string accessed_stream_name(const testing::TestParamInfo<StreamBytes (*)()>& stream) {
  return std::array{"Main", "Rigs", "Chained", "Dyadic", "Independent"}[stream.index];
}
INSTANTIATE_TEST_SUITE_P(Streams, RandomAccess,
                         testing::Values(main_stream, rig_stream, chained_stream, dyadic_stream,
                                         independent_stream),
                         accessed_stream_name);
INSTANTIATE_TEST_SUITE_P(Streams, AttributesOfStreams,
                         testing::Values(main_stream, chained_stream, dyadic_stream,
                                         independent_stream),
                         accessed_stream_name);

}  // namespace
}  // namespace rlpc
