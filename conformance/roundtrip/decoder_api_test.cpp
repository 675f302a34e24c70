// Tests the decoder as an application uses it: in order, by seeking, with limits, with a trace.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/codec/bits/crc32.h"
#include "conformance/testing/sliced_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

using Frame = std::vector<std::int32_t>;

Result<Decoder> open(const StreamBytes& bytes, const DecoderOptions& options = {}) {
  return Decoder::open(memory_source(StreamBytes(bytes)), options);
}

Error open_error(const StreamBytes& bytes, const DecoderOptions& options = {}) {
  const auto decoder = open(bytes, options);
  EXPECT_FALSE(decoder);
  return decoder ? Error{} : decoder.error();
}

Frame frame_buffer(const Decoder& decoder) {
  return Frame(3 * std::size_t{decoder.header().num_vertices});
}

std::vector<Frame> frames_of_decoder(Decoder& decoder) {
  std::vector<Frame> frames;
  Frame frame = frame_buffer(decoder);
  for (;;) {
    const auto more = decoder.next_frame(frame);
    EXPECT_TRUE(more) << (more ? "" : more.error().rule);
    if (!more || !*more) return frames;
    frames.push_back(frame);
  }
}

UnitPlace unit_of_type(const StreamBytes& bytes, UnitType type) {
  for (const UnitPlace& unit : units_of(bytes)) {
    if (unit.type == type) return unit;
  }
  ADD_FAILURE() << "no such unit";
  return {};
}

// Returns GOFs of 4 frames without an index, with one hash each.
StreamBytes plain_stream() {
  MemoryFrames source = bending_tube(6, 18);
  EncoderSettings settings;
  settings.target = {Target::kKg, 0.5};
  settings.gof_frames = 4;
  return encode_to_memory(source, settings);
}

class Seeking : public testing::TestWithParam<StreamBytes (*)()> {
 protected:
  void SetUp() override {
    stream_ = GetParam()();
    ASSERT_FALSE(stream_.empty());
    auto decoder = open(stream_);
    ASSERT_TRUE(decoder);
    frames_ = frames_of_decoder(*decoder);
    ASSERT_EQ(frames_.size(), decoder->header().num_frames);
  }

  StreamBytes stream_;
  std::vector<Frame> frames_;
};

TEST_P(Seeking, EveryFrameInRandomOrderIsThatOfDecodingInOrder) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    auto decoder = open(stream_);
    ASSERT_TRUE(decoder);
    Frame frame = frame_buffer(*decoder);
    for (int i = 0; i < 60; ++i) {
      const auto index = static_cast<std::uint32_t>(random() % frames_.size());
      const auto found = decoder->seek(index);
      ASSERT_TRUE(found) << found.error().rule << ", seed " << seed << ", frame " << index;
      ASSERT_EQ(decoder->position(), index);
      // Also decode some of the frames that follow.
      for (std::uint32_t f = index; f < frames_.size() && f < index + random() % 6; ++f) {
        const auto more = decoder->next_frame(frame);
        ASSERT_TRUE(more && *more) << "seed " << seed << ", frame " << f;
        ASSERT_EQ(frame, frames_[f]) << "seed " << seed << ", frame " << f;
      }
    }
  }
}

TEST_P(Seeking, TheEndCanBeLeftAgain) {
  auto decoder = open(stream_);
  ASSERT_TRUE(decoder);
  EXPECT_EQ(frames_of_decoder(*decoder), frames_);
  Frame frame = frame_buffer(*decoder);
  const auto after = decoder->next_frame(frame);
  ASSERT_TRUE(after);
  EXPECT_FALSE(*after);
  ASSERT_TRUE(decoder->seek(0));
  EXPECT_EQ(frames_of_decoder(*decoder), frames_);
}

TEST_P(Seeking, ParsingTheRestCountsAllGofs) {
  auto whole = open(stream_);
  ASSERT_TRUE(whole);
  const auto num_gofs = whole->parse_rest();
  ASSERT_TRUE(num_gofs);
  std::size_t units = 0;
  for (const UnitPlace& unit : units_of(stream_)) {
    if (unit.type == UnitType::kGof) ++units;
  }
  EXPECT_EQ(*num_gofs, units);
  EXPECT_EQ(whole->position(), frames_.size());
  Frame frame = frame_buffer(*whole);
  const auto more = whole->next_frame(frame);
  EXPECT_TRUE(more && !*more);

  auto from_the_middle = open(stream_);
  ASSERT_TRUE(from_the_middle);
  ASSERT_TRUE(from_the_middle->seek(static_cast<std::uint32_t>(frames_.size()) - 1));
  const auto again = from_the_middle->parse_rest();
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, units);
}

TEST_P(Seeking, ASeekGetsPastDamage) {
  const UnitPlace first = unit_of_type(stream_, UnitType::kGof);
  StreamBytes damaged = stream_;
  damaged[first.crc()] ^= 1;
  auto decoder = open(damaged);
  ASSERT_TRUE(decoder);
  Frame frame = frame_buffer(*decoder);
  for (int i = 0; i < 2; ++i) {
    const auto more = decoder->next_frame(frame);
    ASSERT_FALSE(more);
    EXPECT_STREQ(more.error().rule, "R-UNT-03");
  }
  const auto last = static_cast<std::uint32_t>(frames_.size()) - 1;
  ASSERT_TRUE(decoder->seek(last));
  const auto more = decoder->next_frame(frame);
  ASSERT_TRUE(more && *more);
  EXPECT_EQ(frame, frames_[last]);
  EXPECT_FALSE(decoder->seek(0));
  EXPECT_FALSE(decoder->next_frame(frame));
}

std::string decoded_stream_name(const testing::TestParamInfo<StreamBytes (*)()>& stream) {
  return std::array{"Rich", "Indexed", "Plain", "Mixed"}[stream.index];
}
INSTANTIATE_TEST_SUITE_P(Streams, Seeking,
                         testing::Values(rich_stream, indexed_stream, plain_stream,
                                         mixed_stream),
                         decoded_stream_name);

// The slices of a skipped GOF are skipped, too; but a cluster GOF has none.
TEST(Decoder, DoesNotSeekPastASliceAfterAClusterGof) {
  StreamBytes stream = mixed_stream();
  const std::size_t place = unit_of_type(stream, UnitType::kGof).end();
  const Bytes slice = write_unit(UnitType::kSlice, Bytes{0xC0});
  stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(place), slice.begin(),
                slice.end());
  auto decoder = open(stream);
  ASSERT_TRUE(decoder);
  const auto found = decoder->seek(5);
  ASSERT_FALSE(found);
  EXPECT_STREQ(found.error().rule, "R-UNT-05");
  EXPECT_EQ(found.error().bit_pos, 8 * place);
}

TEST(Decoder, GivesWhatTheEncoderWasGiven) {
  MemoryFrames source = bending_tube(6, 6);
  auto decoder = open(rich_stream());
  ASSERT_TRUE(decoder);
  EXPECT_TRUE(decoder->has_vertex_order());
  EXPECT_EQ(decoder->metadata(), rich_settings().metadata);
  EXPECT_EQ(decoder->header().frame_rate, (FrameRate{24, 1}));
  // The triangles of the input, in any order and from any corner.
  const auto turned = [](std::vector<Triangle> triangles) {
    for (Triangle& t : triangles) {
      t = std::min({t, Triangle{t[1], t[2], t[0]}, Triangle{t[2], t[0], t[1]}});
    }
    std::sort(triangles.begin(), triangles.end());
    return triangles;
  };
  EXPECT_EQ(turned({decoder->triangles().begin(), decoder->triangles().end()}),
            turned(source.triangles()));
  // With the vertex order of the input, each vertex is in its place, within the error.
  const std::vector<Frame> frames = frames_of_decoder(*decoder);
  std::vector<float> original(frames[0].size());
  for (std::uint32_t f = 0; f < 6; ++f) {
    ASSERT_FALSE(source.read_frame(f, original));
    for (std::size_t i = 0; i < original.size(); ++i) {
      ASSERT_NEAR(float_position(decoder->header().grid, i % 3, frames[f][i]), original[i],
                  0.05);
    }
  }
}

TEST(Decoder, HandsOverTheBonesOfAFrame) {
  auto decoder = open(rich_stream());
  ASSERT_TRUE(decoder);
  EXPECT_FALSE(decoder->pose());
  Frame frame = frame_buffer(*decoder);
  const Skeleton* skeleton = nullptr;
  std::size_t changes = 0;
  while (*decoder->next_frame(frame)) {
    const auto pose = decoder->pose();
    ASSERT_TRUE(pose);
    EXPECT_EQ(pose->skeleton->influences.size(), decoder->num_vertices());
    EXPECT_EQ(pose->places.size(), pose->skeleton->bones.size());
    changes += pose->skeleton.get() != skeleton;
    skeleton = pose->skeleton.get();
  }
  EXPECT_GE(changes, 1U);
  EXPECT_LT(changes, 6U);
}

TEST(Decoder, CanBeMoved) {
  auto opened = open(rich_stream());
  ASSERT_TRUE(opened);
  Decoder first = std::move(*opened);
  Frame frame = frame_buffer(first);
  ASSERT_TRUE(first.next_frame(frame));
  const Decoder second = std::move(first);
  EXPECT_EQ(second.position(), 1U);
}

TEST(Decoder, AMissingFileCannotBeRead) {
  const auto source = file_source("/nonexistent/clip.rlpc");
  ASSERT_FALSE(source);
  EXPECT_EQ(source.error().code, Errc::kIo);
}

// Every seek that needs the index reports the error, not only the first.
TEST(Decoder, ReportsABadIndexAgain) {
  StreamBytes stream = indexed_stream();
  const UnitPlace end = units_of(stream).back();
  const std::size_t distance = end.payload() + 3;  // its last byte
  stream[distance] = static_cast<std::uint8_t>(stream[distance] ^ 1);
  const std::uint32_t crc = crc32_of(std::span(stream).subspan(end.offset, 9));
  for (std::size_t i = 0; i < 4; ++i) {
    stream[end.crc() + i] = static_cast<std::uint8_t>(crc >> (24 - 8 * i));
  }
  auto decoder = open(stream);
  ASSERT_TRUE(decoder);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(decoder->seek(decoder->header().num_frames - 1));
}

// Records the first place of each element.
class FirstPlaces final : public Trace {
 public:
  void begin(const char* /*structure*/, std::uint64_t /*bit_pos*/) override {}
  void element(const char* name, std::int64_t /*value*/, std::uint64_t bit_pos) override {
    place.try_emplace(name, bit_pos);
  }
  std::map<std::string, std::uint64_t, std::less<>> place;
};

TEST(DecodeLimits, NameTheElementThatGoesBeyond) {
  const StreamBytes stream = rich_stream();
  FirstPlaces trace;
  DecoderOptions traced;
  traced.trace = &trace;
  ASSERT_TRUE(open(stream, traced));
  const auto expect = [&](const DecodeLimits& limits, std::string_view element) {
    DecoderOptions options;
    options.limits = limits;
    const Error error = open_error(stream, options);
    EXPECT_EQ(error.code, Errc::kLimitExceeded) << element;
    EXPECT_EQ(error.element, element);
    EXPECT_EQ(error.bit_pos, trace.place.find(element)->second) << element;
  };
  expect({.max_vertices = 29}, "num_vertices_minus1");
  expect({.max_triangles = 49}, "num_triangles");
  expect({.max_frames = 5}, "num_frames_minus1");
  expect({.max_memory_bytes = 1000}, "num_vertices_minus1");
  DecoderOptions exact;
  exact.limits = {30, 50, 6, 1U << 20};
  EXPECT_TRUE(open(stream, exact));
}

TEST(DecodeLimits, HoldForTheFactorsOfAGof) {
  MemoryFrames source = bending_tube(40, 40);
  EncoderSettings settings = rich_settings();
  settings.gof_frames = EncoderSettings::kWholeSequence;
  settings.components = 30;
  settings.baseline.rdo = false;
  const StreamBytes stream = encode_to_memory(source, settings);
  ASSERT_FALSE(stream.empty());
  DecoderOptions options;
  options.limits.max_memory_bytes = 100'000;  // enough for the mesh
  auto decoder = open(stream, options);
  ASSERT_TRUE(decoder);
  Frame frame = frame_buffer(*decoder);
  const auto more = decoder->next_frame(frame);
  ASSERT_FALSE(more);
  EXPECT_EQ(more.error().code, Errc::kLimitExceeded);
  EXPECT_STREQ(more.error().element, "num_components_delta");
}

TEST(Unsupported, IsNotInvalid) {
  const StreamBytes stream = rich_stream();
  const UnitPlace header = units_of(stream).front();
  const auto expect = [&](std::size_t at, std::uint8_t value, std::string_view rule,
                          std::string_view element) {
    StreamBytes changed = stream;
    changed[at] = value;
    repair_crcs(changed);
    const Error error = open_error(changed);
    EXPECT_EQ(error.code, Errc::kUnsupported) << rule;
    EXPECT_EQ(error.rule, rule);
    EXPECT_EQ(error.element, element);
    EXPECT_EQ(error.bit_pos, 8 * at);
  };
  expect(8, 2, "R-STR-02", "version_major");
  expect(9, 1, "R-STR-03", "version_minor");
  expect(header.payload(), 1, "R-HDR-01", "profile_idc");
  expect(header.payload() + 1, 5, "R-HDR-02", "level_idc");
  // A critical unit that this version does not know.
  expect(units_of(stream)[1].offset, 0x42, "R-UNT-04", "unit_type");
}

TEST(Unsupported, AncillaryUnitsAreSkipped) {
  const StreamBytes stream = rich_stream();
  auto plain = open(stream);
  ASSERT_TRUE(plain);
  const std::vector<Frame> expected = frames_of_decoder(*plain);
  for (const UnitPlace& unit : units_of(stream)) {
    if (unit.offset == kStreamHeaderBytes) continue;  // the sequence header is first
    if (unit.type == UnitType::kGofHash) continue;    // and a hash follows its GOF
    const StreamBytes extra{0xC5, 0, 0, 0, 2, 7, 7, 0, 0, 0, 0};
    StreamBytes longer = stream;
    longer.insert(longer.begin() + static_cast<std::ptrdiff_t>(unit.offset), extra.begin(),
                  extra.end());
    repair_crcs(longer);
    auto decoder = open(longer);
    ASSERT_TRUE(decoder) << decoder.error().rule;
    EXPECT_EQ(frames_of_decoder(*decoder), expected);
  }
}

TEST(Hashes, AWrongOneIsReportedWithItsFrame) {
  const StreamBytes stream = rich_stream();
  std::uint32_t frame_index = 0;
  for (const UnitPlace& unit : units_of(stream)) {
    if (unit.type != UnitType::kGofHash) continue;
    for (std::size_t at = unit.payload() + 1; at < unit.crc(); at += 4, ++frame_index) {
      StreamBytes changed = stream;
      changed[at + frame_index % 4] ^= 0x10;
      repair_crcs(changed);
      auto decoder = open(changed);
      ASSERT_TRUE(decoder);
      Frame frame = frame_buffer(*decoder);
      for (std::uint32_t f = 0; f < frame_index; ++f) ASSERT_TRUE(decoder->next_frame(frame));
      const auto more = decoder->next_frame(frame);
      ASSERT_FALSE(more) << "frame " << frame_index;
      EXPECT_EQ(more.error().code, Errc::kInvalid);
      EXPECT_STREQ(more.error().rule, "R-HSH-02");
      EXPECT_STREQ(more.error().element, "position_crc");

      DecoderOptions options;
      options.verify_hashes = false;
      auto trusting = open(changed, options);
      ASSERT_TRUE(trusting);
      EXPECT_EQ(frames_of_decoder(*trusting).size(), 6U);
    }
  }
  EXPECT_EQ(frame_index, 6U);
}

// Returns the number of frames compared with a hash, for each frame from `first` on.
std::vector<std::uint32_t> compared_from(Decoder& decoder, std::uint32_t first) {
  EXPECT_TRUE(decoder.seek(first));
  Frame frame = frame_buffer(decoder);
  std::vector<std::uint32_t> compared;
  while (decoder.position() < decoder.header().num_frames) {
    EXPECT_TRUE(decoder.next_frame(frame));
    compared.push_back(decoder.compared_frames());
  }
  return compared;
}

TEST(Hashes, ThoseOfAGofCoverItsFramesIfTheyCameInOrder) {
  auto decoder = open(plain_stream());
  ASSERT_TRUE(decoder);
  // Zeros, except at the last frame of each GOF, which has the length of the GOF.
  const std::vector<std::uint32_t> all = compared_from(*decoder, 0);
  std::size_t end = 0;
  while (end < all.size()) {
    const auto last = std::find_if(all.begin() + static_cast<std::ptrdiff_t>(end), all.end(),
                                   [](std::uint32_t count) { return count > 0; });
    ASSERT_NE(last, all.end());
    end += *last;
    ASSERT_EQ(end, static_cast<std::size_t>(last - all.begin()) + 1);
  }
  EXPECT_GT(all.back(), 1U);
  const std::uint32_t first_of_last = 18 - all.back();
  const std::vector<std::uint32_t> last_counts(all.begin() + first_of_last, all.end());
  EXPECT_EQ(compared_from(*decoder, first_of_last), last_counts);
  EXPECT_EQ(compared_from(*decoder, first_of_last + 1),
            std::vector<std::uint32_t>(all.back() - 1, 0));
  EXPECT_EQ(compared_from(*decoder, first_of_last),
            last_counts);  // the GOF that is loaded, again
}

TEST(Hashes, ThoseOfFramesCoverOneEach) {
  auto decoder = open(rich_stream());
  ASSERT_TRUE(decoder);
  EXPECT_EQ(compared_from(*decoder, 2), (std::vector<std::uint32_t>{1, 1, 1, 1}));
  DecoderOptions options;
  options.verify_hashes = false;
  auto none = open(rich_stream(), options);
  ASSERT_TRUE(none);
  EXPECT_EQ(compared_from(*none, 2), (std::vector<std::uint32_t>{0, 0, 0, 0}));
}

TEST(Hashes, AWrongOneOfAGofIsReportedWithItsLastFrame) {
  StreamBytes stream = plain_stream();
  stream[unit_of_type(stream, UnitType::kGofHash).payload() + 1] ^= 1;
  repair_crcs(stream);
  auto decoder = open(stream);
  ASSERT_TRUE(decoder);
  Frame frame = frame_buffer(*decoder);
  Result<bool> more = true;
  while (more && *more) more = decoder->next_frame(frame);
  ASSERT_FALSE(more);
  EXPECT_STREQ(more.error().rule, "R-HSH-02");
  // 18 frames in 5 GOFs: the first has 3.
  EXPECT_EQ(decoder->position(), 2U);
}

// Records the names, and whether the positions increase.
class Recorder final : public Trace {
 public:
  void begin(const char* structure, std::uint64_t bit_pos) override {
    ++structures[structure];
    at(bit_pos);
  }
  void element(const char* name, std::int64_t /*value*/, std::uint64_t bit_pos) override {
    ++elements[name];
    at(bit_pos);
  }

  std::map<std::string, int> structures;
  std::map<std::string, int> elements;
  std::uint64_t last = 0;
  bool rises = true;

 private:
  void at(std::uint64_t bit_pos) {
    rises = rises && bit_pos >= last;
    last = bit_pos;
  }
};

TEST(Tracing, GetsEveryElementInOrderAndChangesNothing) {
  const StreamBytes stream = rich_stream();
  auto plain = open(stream);
  ASSERT_TRUE(plain);
  Recorder trace;
  DecoderOptions options;
  options.trace = &trace;
  auto traced = open(stream, options);
  ASSERT_TRUE(traced);
  EXPECT_EQ(frames_of_decoder(*traced), frames_of_decoder(*plain));

  const int num_units = static_cast<int>(units_of(stream).size());
  EXPECT_EQ(trace.structures["unit"], num_units);
  EXPECT_EQ(trace.elements["unit_type"], num_units);
  EXPECT_EQ(trace.elements["unit_crc"], num_units);
  EXPECT_EQ(trace.elements["num_vertices_minus1"], 1);
  EXPECT_EQ(trace.elements["vertex_order_delta"], 30);
  EXPECT_EQ(trace.elements["first_frame"], 2);
  EXPECT_EQ(trace.elements["position_crc"], 6);
  for (const char* name : {"boundary_flag", "lcf_flag", "seed_vertex", "seed_residual",
                           "scale_idx_delta", "temporal_residual", "spatial_residual"}) {
    EXPECT_GT(trace.elements[name], 0) << name;
  }
  EXPECT_TRUE(trace.rises);
  EXPECT_EQ(trace.last, 8 * (stream.size() - kUnitCrcBytes));
}

}  // namespace
}  // namespace rlpc
