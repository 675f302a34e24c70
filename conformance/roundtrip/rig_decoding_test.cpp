// Tests decoding of streams with shared rigs: random access, memory, and failures.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <new>
#include <random>
#include <string>
#include <vector>

#include "conformance/testing/count_memory.h"
#include "conformance/testing/cut_streams.h"
#include "conformance/testing/rig_animation.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

DecoderOptions with_threads(std::uint32_t threads) {
  DecoderOptions options;
  options.threads = threads;
  return options;
}

// Decodes a frame by seeking. Returns the broken rule if that fails.
std::string seek_to(Decoder& decoder, std::uint32_t f, Frame& frame) {
  frame.resize(3 * std::size_t{decoder.header().num_vertices});
  if (const auto found = decoder.seek(f); !found) return found.error().rule;
  const auto more = decoder.next_frame(frame);
  return more ? "" : more.error().rule;
}

// A unit that would be a legal rig is refused, also by threads that read ahead.
TEST(RigDecoding, BaselineStreamsHaveNoRigs) {
  StreamBytes stream = rich_stream();
  Bytes payload{0x10, 0x0C};  // prediction_idc 0, all other elements of rig_header( ) 0
  payload.resize(22);
  const Bytes rig = write_unit(UnitType::kRig, payload);
  const UnitPlace gof = units_of_type(stream, UnitType::kGof).at(1);
  stream.insert(stream.begin() + static_cast<std::ptrdiff_t>(gof.offset), rig.begin(),
                rig.end());
  for (const std::uint32_t threads : {1U, 2U, 3U}) {
    auto decoder = Decoder::open(memory_source(stream), with_threads(threads));
    ASSERT_TRUE(decoder);
    Frame frame(3 * std::size_t{decoder->header().num_vertices});
    std::string rule;
    for (int f = 0; f < 6 && rule.empty(); ++f) {
      if (const auto more = decoder->next_frame(frame); !more) rule = more.error().rule;
    }
    EXPECT_EQ(rule, "R-UNT-04") << threads;
  }
}

// Seeks backwards, over rigs that are replaced; and to each frame first of all.
TEST(RigSeeking, FindsEveryFrame) {
  const std::vector<Frame> expected = decode_all(rig_stream());
  ASSERT_EQ(expected.size(), 16U);
  for (const StreamBytes& stream : {rig_stream(), indexed_rig_stream()}) {
    for (const std::uint32_t threads : {1U, 2U, 3U, 4U}) {
      auto decoder = Decoder::open(memory_source(stream), with_threads(threads));
      ASSERT_TRUE(decoder);
      Frame frame;
      for (std::uint32_t f = 16; f-- > 0;) {
        ASSERT_EQ(seek_to(*decoder, f, frame), "");
        ASSERT_EQ(frame, expected[f]) << f;
        auto first = Decoder::open(memory_source(stream), with_threads(threads));
        ASSERT_EQ(seek_to(*first, f, frame), "");
        ASSERT_EQ(frame, expected[f]) << f;
      }
      std::mt19937 random(threads);
      for (int i = 0; i < 60; ++i) {
        const auto f = static_cast<std::uint32_t>(random() % 16);
        ASSERT_EQ(seek_to(*decoder, f, frame), "");
        ASSERT_EQ(frame, expected[f]) << f;
      }
    }
  }
}

// A damaged rig does no harm to GOFs at which it is not alive.
TEST(RigSeeking, PassesDamagedRigsThatAreNotNeeded) {
  const StreamBytes good = indexed_rig_stream();
  const std::vector<Frame> expected = decode_all(good);
  const auto rigs = units_of_type(good, UnitType::kRig);
  for (std::size_t m = 0; m < 3; ++m) {
    StreamBytes damaged = good;
    damaged[rigs[m].payload() + 3] ^= 4;
    for (std::uint32_t f = 0; f < 16; ++f) {
      SCOPED_TRACE(testing::Message() << "rig " << m << ", frame " << f);
      auto decoder = Decoder::open(memory_source(damaged));
      ASSERT_TRUE(decoder);
      // The first is replaced after frame 11; the second stays to the end.
      const bool alive = m == 0 ? f < 12 : m == 1 ? f >= 2 : f >= 12;
      Frame frame;
      EXPECT_EQ(seek_to(*decoder, f, frame), alive ? "R-UNT-03" : "");
      if (!alive) {
        EXPECT_EQ(frame, expected[f]);
      }
    }
  }
}

TEST(RigSeeking, ReportsAnIndexWithAnotherRig) {
  const StreamBytes good = indexed_rig_stream();
  const UnitPlace index = units_of_type(good, UnitType::kGofIndex).at(0);
  const auto gofs = units_of_type(good, UnitType::kGof);
  const auto rigs = units_of_type(good, UnitType::kRig);
  const auto with_rigs = [&](const std::vector<RigIndexEntry>& list) {
    GofIndexEntries entries;
    entries.first_gof_offset = gofs[0].offset;
    for (std::size_t g = 0; g < gofs.size(); ++g) {
      const std::size_t next = g + 1 < gofs.size() ? gofs[g + 1].offset : index.offset;
      entries.gofs.push_back({2, next - gofs[g].offset});
    }
    entries.rigs = list;
    const Bytes payload = write_gof_index(entries, kProfileHigh);
    const auto end = units_of(good).back();
    const auto size = static_cast<std::uint32_t>(payload.size() + 9);
    return with_payload(with_payload(good, end, write_end_of_sequence(size)), index, payload);
  };
  const auto rule_at = [&](const std::vector<RigIndexEntry>& list, std::uint32_t f) {
    auto decoder = Decoder::open(memory_source(with_rigs(list)));
    EXPECT_TRUE(decoder);
    Frame frame;
    return seek_to(*decoder, f, frame);
  };
  const std::vector<RigIndexEntry> right{
      {0, rigs[0].offset}, {5, rigs[1].offset}, {0, rigs[2].offset}};
  for (std::uint32_t f = 0; f < 16; ++f) EXPECT_EQ(rule_at(right, f), "");
  auto list = right;
  list[1].rig_idx = 6;
  EXPECT_EQ(rule_at(list, 0), "");
  EXPECT_EQ(rule_at(list, 2), "R-IDX-06");
  list = right;
  list[1].offset = gofs[0].offset;
  EXPECT_EQ(rule_at(list, 2), "R-UNT-05");
  list = right;
  list.erase(list.begin() + 1);
  EXPECT_EQ(rule_at(list, 2), "R-MOD-01");
  list.assign(17, right[0]);
  EXPECT_EQ(rule_at(list, 0), "R-IDX-05");
}

// Each GOF that has lost its rig, up to the next one, is unsupported by itself.
TEST(RigSeeking, GoesOnAfterALostRig) {
  const StreamBytes good = rig_stream();
  const std::vector<Frame> expected = decode_all(good);
  const auto units = units_of(good);
  const auto rig = units_of_type(good, UnitType::kRig).at(0);
  std::size_t end = rig.end();
  for (const UnitPlace& unit : units) {
    if (unit.offset == end && unit.type == UnitType::kSlice) end = unit.end();
  }
  StreamBytes joined(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(rig.offset));
  joined.insert(joined.end(), good.begin() + static_cast<std::ptrdiff_t>(end), good.end());
  auto decoder = Decoder::open(memory_source(joined));
  ASSERT_TRUE(decoder);
  for (std::uint32_t f = 0; f < 16; f += 2) {
    Frame frame;
    const std::string rule = seek_to(*decoder, f, frame);
    const std::uint32_t gof = f / 2;
    const bool lost = gof == 0 || gof == 2 || gof == 4;
    EXPECT_EQ(rule, lost ? "R-MOD-01" : "") << f;
    if (!lost) {
      EXPECT_EQ(frame, expected[f]);
    }
  }
}

// Tests the rigs that a decoder holds.
TEST(StreamRigs, KeepsThoseAliveAtTheGof) {
  for (const StreamBytes& stream : {rig_stream(), indexed_rig_stream()}) {
    StreamReader reader(memory_source(stream), {});
    ASSERT_TRUE(reader.open());
    std::vector<std::weak_ptr<const SharedRig>> seen;
    std::vector<std::size_t> alive;
    const auto gofs = units_of_type(stream, UnitType::kGof);
    for (const UnitPlace& gof : gofs) {
      const auto unit = reader.find_gof();
      ASSERT_TRUE(unit && *unit);
      ASSERT_TRUE(reader.read(**unit));
      const auto rigs = reader.rigs().at(gof.offset);
      ASSERT_TRUE(rigs);
      for (const auto& rig : rigs->slots) {
        const bool known = std::any_of(seen.begin(), seen.end(),
                                       [&](const auto& w) { return w.lock() == rig; });
        if (rig && !known) seen.emplace_back(rig);
      }
      alive.push_back(static_cast<std::size_t>(std::count_if(
          rigs->slots.begin(), rigs->slots.end(), [](const auto& m) { return m != nullptr; })));
    }
    EXPECT_EQ(alive, (std::vector<std::size_t>{1, 2, 2, 2, 2, 2, 2, 2}));
    ASSERT_EQ(seen.size(), 3U);
    EXPECT_TRUE(seen[0].expired());
    EXPECT_FALSE(seen[1].expired());
    EXPECT_FALSE(seen[2].expired());
    // Going backwards drops later rigs.
    ASSERT_TRUE(reader.rigs().at(gofs[0].offset));
    EXPECT_TRUE(seen[1].expired());
    EXPECT_TRUE(seen[2].expired());
  }
}

TEST(RigRecons, AreSharedAndDropped) {
  const StreamBytes stream = rig_stream();
  StreamReader reader(memory_source(stream), {});
  ASSERT_TRUE(reader.open());
  RigRecons recons(reader.context());
  std::vector<const RigRecon*> used;
  std::vector<std::weak_ptr<const RigRecon>> made;
  for (;;) {
    const auto access_unit = reader.next();
    ASSERT_TRUE(access_unit);
    if (!*access_unit) break;
    const auto* gof = std::get_if<SkinnedGof>(&(*access_unit)->gof);
    if (gof == nullptr || !gof->rig) continue;
    const auto recon = recons.of(gof->rig);
    EXPECT_EQ(recons.of(gof->rig), recon);
    used.push_back(recon.get());
    made.emplace_back(recon);
  }
  // GOFs 0, 2 and 4 of the first rig, 1 of the second, 6 and 7 of the third.
  ASSERT_EQ(made.size(), 6U);
  EXPECT_EQ(used[0], used[2]);
  EXPECT_EQ(used[0], used[3]);
  EXPECT_EQ(used[4], used[5]);
  EXPECT_NE(used[0], used[1]);
  EXPECT_TRUE(made[0].expired());
  EXPECT_FALSE(made[1].expired());
  EXPECT_FALSE(made[5].expired());
}

std::size_t peak_of_decoding(const StreamBytes& stream, bool backwards) {
  auto source = memory_source(stream);
  const std::size_t before = memory_count.now;
  memory_count.peak = before;
  auto decoder = Decoder::open(std::move(source));
  EXPECT_TRUE(decoder);
  const std::uint32_t num_frames = decoder->header().num_frames;
  Frame frame(3 * std::size_t{decoder->header().num_vertices});
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    if (backwards) {
      EXPECT_TRUE(decoder->seek(num_frames - 1 - f));
    }
    EXPECT_TRUE(decoder->next_frame(frame));
  }
  return memory_count.peak - before;
}

// Rigs that are replaced again and again.
TEST(RigMemory, DoesNotGrowWithTheNumberOfRigs) {
  for (const bool backwards : {false, true}) {
    const std::size_t few = peak_of_decoding(RigAnimation().many_rigs(10), backwards);
    const std::size_t many = peak_of_decoding(RigAnimation().many_rigs(60), backwards);
    // A few numbers of each GOF and each rig are kept.
    EXPECT_LT(many, few + 50 * 500) << backwards;
    EXPECT_GT(few, 50000U);
  }
}

// Each allocation fails in turn, then samples of them; frames decoded before are right.
TEST(RigMemory, FailedAllocationsEndDecoding) {
  const StreamBytes stream = indexed_rig_stream();
  const std::vector<Frame> expected = decode_all(stream);
  for (const std::uint32_t threads : {1U, 3U}) {
    int ended = 0;
    for (std::size_t calls = 0;; calls += 1 + calls / 60) {
      std::vector<Frame> frames(16, Frame(expected[0].size()));
      std::size_t count = 0;
      const std::size_t before = memory_count.now;
      try {
        auto source = memory_source(stream);
        memory_count.failures = 0;
        memory_count.calls_left = calls;
        auto decoder = Decoder::open(std::move(source), with_threads(threads));
        while (decoder && count < 16 && decoder->next_frame(frames[count])) ++count;
      } catch (const std::bad_alloc&) {
        ++ended;
      }
      memory_count.calls_left = std::numeric_limits<std::size_t>::max();
      ASSERT_EQ(memory_count.now, before) << calls;
      for (std::size_t f = 0; f < count; ++f) ASSERT_EQ(frames[f], expected[f]) << calls;
      if (memory_count.failures > 0) continue;
      EXPECT_EQ(count, 16U);
      break;
    }
    EXPECT_GT(ended, 50);
  }
}

// A stream can have any number of rigs before a GOF.
TEST(RigMemory, ManyRigsBeforeAGofDecode) {
  const StreamBytes one = rig_stream();
  const std::vector<Frame> expected = decode_all(one);
  const auto units = units_of(one);
  const UnitPlace rig = units_of_type(one, UnitType::kRig).at(0);
  const Bytes unit(one.begin() + static_cast<std::ptrdiff_t>(rig.offset),
                   one.begin() + static_cast<std::ptrdiff_t>(rig.end()));
  StreamBytes many(one.begin(), one.begin() + static_cast<std::ptrdiff_t>(rig.offset));
  for (int i = 0; i < 20000; ++i) many.insert(many.end(), unit.begin(), unit.end());
  many.insert(many.end(), one.begin() + static_cast<std::ptrdiff_t>(rig.offset), one.end());
  for (const std::uint32_t threads : {1U, 4U}) {
    EXPECT_EQ(decode_all(many, with_threads(threads)), expected);
    auto decoder = Decoder::open(memory_source(many), with_threads(threads));
    ASSERT_TRUE(decoder);
    Frame frame;
    for (const std::uint32_t f : {13U, 1U}) {
      EXPECT_EQ(seek_to(*decoder, f, frame), "");
      EXPECT_EQ(frame, expected[f]);
    }
  }
}

}  // namespace
}  // namespace rlpc
