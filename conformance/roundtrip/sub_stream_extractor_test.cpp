// Tests that a stream cut by the extractor decodes like the original in a decoder with the same
// cut.
#include "decoder/codec/extract/sub_stream_extractor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "conformance/testing/cut_streams.h"
#include "conformance/testing/rig_animation.h"

namespace rlpc {
namespace {

DecoderOptions cut_options(const SliceCut& cut) {
  DecoderOptions options;
  options.cut = cut;
  return options;
}

std::vector<SliceCut> some_cuts() {
  std::vector<SliceCut> cuts;
  for (const std::uint32_t components : {0U, 1U, 2U, 3U, 4U, 5U, 6U, SliceCut::kAll}) {
    for (const std::uint32_t layers : {0U, 1U, 2U, 100U, SliceCut::kAll}) {
      cuts.push_back({components, layers});
    }
  }
  return cuts;
}

// Component group and layer group of each slice, for each GOF.
using Places = std::vector<std::vector<std::pair<std::uint32_t, std::uint32_t>>>;
Places places_of(const StreamBytes& stream) {
  const auto cutter = SubStreamExtractor::open(memory_source(stream), {});
  EXPECT_TRUE(cutter);
  Places places;
  for (const GofSummary& gof : cutter->summary().gofs) {
    places.emplace_back();
    for (const SliceEntry& s : gof.slices) {
      places.back().emplace_back(s.component_group_idx, s.layer_group_idx);
    }
  }
  return places;
}

TEST(LayerGroups, StayWhole) {
  const std::vector<std::uint32_t> sizes{2, 1, 4};
  const std::vector<std::uint32_t> expected{1, 1, 1, 2, 2, 2, 2, 3, 3};
  for (std::uint32_t layers = 0; layers < expected.size(); ++layers) {
    EXPECT_EQ(layer_groups_that_stay(sizes, {SliceCut::kAll, layers}), expected[layers])
        << layers;
  }
  EXPECT_EQ(layer_groups_that_stay(sizes, {}), 3U);
}

TEST(LayerGroups, StayIfTheyAreNeeded) {
  const std::vector<std::uint32_t> sizes{2, 1, 4};
  const std::vector<std::uint32_t> expected{1, 1, 1, 2, 3, 3, 3, 3};
  for (std::uint32_t layers = 0; layers < expected.size(); ++layers) {
    SliceCut cut;
    cut.needed_layers = layers;
    EXPECT_EQ(layer_groups_that_stay(sizes, cut), expected[layers]) << layers;
    cut.max_layers = 3;
    EXPECT_EQ(layer_groups_that_stay(sizes, cut), std::min(expected[layers], 2U)) << layers;
  }
}

// The first GOF has groups of 1 and 2 trajectories, and two layer groups, the first of one
// layer; the second has one trajectory and one layer group.
TEST(SubStreamExtractor, LeavesOutWholeGroups) {
  const StreamBytes stream = sliced_stream();
  EXPECT_EQ(places_of(cut_stream(stream, {0, SliceCut::kAll})),
            (Places{{{0, 0}, {0, 1}}, {{0, 0}}}));
  EXPECT_EQ(places_of(cut_stream(stream, {2, SliceCut::kAll})),
            (Places{{{0, 0}, {0, 1}, {1, 0}, {1, 1}}, {{0, 0}, {1, 0}}}));
  EXPECT_EQ(places_of(cut_stream(stream, {SliceCut::kAll, 1})),
            (Places{{{0, 0}, {1, 0}, {2, 0}}, {{0, 0}, {1, 0}}}));
  EXPECT_EQ(places_of(cut_stream(stream, {1, 1})),
            (Places{{{0, 0}, {1, 0}}, {{0, 0}, {1, 0}}}));
  EXPECT_EQ(places_of(cut_stream(stream, {0, 0})), (Places{{{0, 0}}, {{0, 0}}}));
}

TEST(SubStreamExtractor, KeepsClusterGofsWhole) {
  const StreamBytes out = cut_stream(mixed_stream(), {1, 1});
  const Places::value_type none;
  const Places::value_type cut{{0, 0}, {1, 0}};
  EXPECT_EQ(places_of(out), (Places{none, cut, none, cut, none, cut, none}));
  const std::vector<Frame> before = decode_all(mixed_stream());
  const std::vector<Frame> after = decode_all(out);
  ASSERT_EQ(after.size(), before.size());
  for (std::size_t f = 0; f < before.size(); ++f) {
    const bool has_bones = f / 2 % 2 == 1;
    EXPECT_EQ(before[f] != after[f], has_bones) << f;
  }
}

TEST(SubStreamExtractor, WritesConformingStreamsThatDecodeAsIfCut) {
  for (const StreamBytes& stream : {sliced_stream(), ordered_stream(), mixed_stream(),
                                    rig_stream(), indexed_rig_stream()}) {
    for (const SliceCut& cut : some_cuts()) {
      SCOPED_TRACE(testing::Message() << cut.max_components << ", " << cut.max_layers);
      const StreamBytes out = cut_stream(stream, cut);
      require_conforming(out);  // its hashes and its index too
      EXPECT_EQ(decode_all(out), decode_all(stream, cut_options(cut)));
      EXPECT_EQ(cut_stream(out, cut), out);
    }
  }
  EXPECT_NE(decode_all(cut_stream(sliced_stream(), {SliceCut::kAll, 1})),
            decode_all(sliced_stream()));
  EXPECT_NE(decode_all(cut_stream(sliced_stream(), {1, SliceCut::kAll})),
            decode_all(sliced_stream()));
}

TEST(SubStreamExtractor, CopiesTheOtherUnits) {
  const StreamBytes stream = ordered_stream();
  const StreamBytes out = cut_stream(stream, {1, 1});
  EXPECT_LT(out.size(), stream.size());
  const auto units = [](const StreamBytes& bytes) {
    std::vector<StreamBytes> list;
    for (const UnitPlace& unit : units_of(bytes)) {
      const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(unit.offset);
      list.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(unit.end() - unit.offset));
    }
    return list;
  };
  const std::vector<StreamBytes> before = units(stream);
  std::size_t changed = 0;
  for (const StreamBytes& unit : units(out)) {
    if (std::find(before.begin(), before.end(), unit) == before.end()) ++changed;
  }
  // These change: the hash of the GOF that was cut, the index, and the end of the sequence if
  // the index is shorter.
  EXPECT_GE(changed, 2U);
  EXPECT_LE(changed, 3U);
}

TEST(SubStreamExtractor, KeepsTheKindOfHashes) {
  const StreamBytes stream = ordered_stream();
  const auto hash_sizes = [](const StreamBytes& bytes) {
    std::vector<std::size_t> sizes;
    for (const UnitPlace& unit : units_of(bytes)) {
      if (unit.type == UnitType::kGofHash) sizes.push_back(unit.size);
    }
    return sizes;
  };
  EXPECT_EQ(hash_sizes(stream), (std::vector<std::size_t>{9, 5}));
  EXPECT_EQ(hash_sizes(cut_stream(stream, {0, 1})), hash_sizes(stream));
}

TEST(SubStreamExtractor, CopiesAStreamThatHasNoMore) {
  for (const StreamBytes& stream :
       {sliced_stream(), ordered_stream(), mixed_stream(), rich_stream(), rig_stream()}) {
    EXPECT_EQ(cut_stream(stream, {6, 100}), stream);
  }
}

TEST(SubStreamExtractor, RefusesDamagedStreams) {
  const StreamBytes stream = sliced_stream();
  for (std::size_t size = 0; size < stream.size(); size += 7) {
    const StreamBytes prefix(stream.begin(),
                             stream.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(SubStreamExtractor::open(memory_source(prefix), {0, 1})) << size;
  }
  for (std::size_t at = 0; at < stream.size(); at += 7) {
    StreamBytes damaged = stream;
    damaged[at] ^= 16;
    EXPECT_FALSE(SubStreamExtractor::open(memory_source(damaged), {0, 1})) << at;
  }
}

TEST(CutDecoding, SeeksToTheFramesOfDecodingInOrder) {
  for (const StreamBytes& stream : {sliced_stream(), ordered_stream(), mixed_stream(),
                                    rig_stream(), indexed_rig_stream()}) {
    for (const SliceCut& cut : some_cuts()) {
      const StreamBytes out = cut_stream(stream, cut);
      const std::vector<Frame> expected = decode_all(out);
      auto whole = Decoder::open(memory_source(stream), cut_options(cut));
      auto written = Decoder::open(memory_source(out));
      ASSERT_TRUE(whole && written);
      std::mt19937 random(cut.max_components + 5);
      for (int i = 0; i < 30; ++i) {
        const auto f = static_cast<std::uint32_t>(random() % expected.size());
        for (Decoder* const decoder : {&*whole, &*written}) {
          Frame frame(expected[f].size());
          ASSERT_TRUE(decoder->seek(f));
          ASSERT_TRUE(decoder->next_frame(frame));
          ASSERT_EQ(frame, expected[f]);
        }
      }
    }
  }
}

TEST(CutDecoding, ReportsWhetherAnythingWasDropped) {
  const auto was_cut = [](const StreamBytes& stream, const SliceCut& cut) {
    auto decoder = Decoder::open(memory_source(stream), cut_options(cut));
    EXPECT_FALSE(decoder->was_cut());
    EXPECT_TRUE(decoder->parse_rest());
    return decoder->was_cut();
  };
  EXPECT_TRUE(was_cut(sliced_stream(), {2, SliceCut::kAll}));
  EXPECT_TRUE(was_cut(sliced_stream(), {SliceCut::kAll, 1}));
  EXPECT_FALSE(was_cut(sliced_stream(), {3, 100}));
  EXPECT_FALSE(was_cut(sliced_stream(), {}));
  EXPECT_FALSE(was_cut(rich_stream(), {0, 1}));
}

// Returns the first broken rule when decoding the stream with the cut; "" if none.
std::string rule_of(const StreamBytes& stream, const SliceCut& cut) {
  auto decoder = Decoder::open(memory_source(stream), cut_options(cut));
  EXPECT_TRUE(decoder);
  Frame frame(3 * std::size_t{decoder->header().num_vertices});
  for (;;) {
    const auto more = decoder->next_frame(frame);
    if (!more) return more.error().rule;
    if (!*more) return "";
  }
}

TEST(CutDecoding, ComparesHashesOfGofsThatAreWhole) {
  const StreamBytes stream = sliced_stream();
  const auto hashes = units_of_type(stream, UnitType::kGofHash);
  const SliceCut first_only{1, SliceCut::kAll};  // the second GOF has no more
  for (std::size_t gof = 0; gof < 2; ++gof) {
    StreamBytes wrong = stream;
    wrong[hashes[gof].payload() + 3] ^= 1;
    repair_crcs(wrong);
    EXPECT_EQ(rule_of(wrong, {}), "R-HSH-02");
    EXPECT_EQ(rule_of(wrong, first_only), gof == 0 ? "" : "R-HSH-02");
  }
}

TEST(CutDecoding, ParsesNothingOfWhatIsLeftOut) {
  const StreamBytes stream = sliced_stream();
  const auto slices = units_of_type(stream, UnitType::kSlice);
  // Slices of the first GOF, of the finer layers and of the second group.
  for (const std::size_t s : {std::size_t{1}, std::size_t{3}, std::size_t{4}, std::size_t{5}}) {
    const StreamBytes garbled =
        with_payload(stream, slices[s],
                     std::span(stream).subspan(slices[s].payload(),
                                               std::min<std::size_t>(2, slices[s].size)));
    EXPECT_NE(rule_of(garbled, {}), "");
    EXPECT_EQ(rule_of(garbled, {1, 1}), "");
    EXPECT_EQ(decode_all(garbled, cut_options({1, 1})), decode_all(cut_stream(stream, {1, 1})));
    StreamBytes damaged = stream;
    damaged[slices[s].crc()] ^= 1;
    EXPECT_EQ(rule_of(damaged, {1, 1}), "R-UNT-03");
  }
}

}  // namespace
}  // namespace rlpc
