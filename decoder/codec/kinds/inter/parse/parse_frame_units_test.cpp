// 7.14.2 and 8.19.1: which frame units can follow others, and units that a cut drops.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <vector>

#include "common/testing/inter_gof_recipe.h"
#include "decoder/testing/inter_gof_units.h"

namespace rlpc {
namespace {

// Variables and functions of 8.19.1, as they are written.
struct UnitsOfText {
  FramePattern pattern;
  std::uint32_t num_frames = 0;
  std::uint32_t num_groups = 1;
  bool open_end = false;
  std::vector<FramePlace> order;
  std::vector<std::uint32_t> place_of;
  std::vector<std::uint32_t> groups;  // FrameGroups
  std::vector<bool> repeats;
  std::uint32_t unit_place = 0;        // UnitPlace
  std::int64_t last_place = -1;        // LastPlace
  std::vector<std::uint32_t> unit;     // UnitFrames
  std::vector<std::uint32_t> to_come;  // FramesToCome

  void start() {
    const FrameOrder made(pattern, num_frames);
    place_of.resize(num_frames);
    for (std::uint32_t p = 0; p < num_frames; ++p) {
      order.push_back(made[p]);
      place_of[made[p].frame] = p;
    }
    groups.assign(num_frames, 0);
    repeats.assign(num_frames, false);
  }
  std::uint32_t layer(std::uint32_t f) const {
    const std::int64_t deeper = std::int64_t{pattern.num_depths()} - pattern.temporal_layers;
    return static_cast<std::uint32_t>(
        std::max<std::int64_t>(0, order[place_of[f]].depth - deeper));
  }
  bool is_whole(std::uint32_t f) const { return repeats[f] || groups[f] == num_groups; }
  bool find_unit_frames(std::uint32_t frame_idx, std::uint32_t group, std::uint32_t more) {
    unit.clear();
    for (std::uint32_t p = place_of[frame_idx]; p < num_frames && unit.size() <= more; ++p) {
      const std::uint32_t f = order[p].frame;
      if (layer(f) == layer(frame_idx)) {
        if (f == frame_idx || group == 0 || !is_whole(f)) unit.push_back(f);
      } else if (open_end) {
        break;
      }
    }
    return unit.size() > more;
  }
  bool is_next(std::uint32_t frame_idx, std::uint32_t group) const {
    for (const std::uint32_t f : unit) {
      if (groups[f] != group || is_whole(f)) return false;
    }
    if (open_end && group == 0) return place_of[frame_idx] > last_place;
    return !open_end || unit == to_come;
  }
  bool may_follow(std::uint32_t frame_idx, std::uint32_t group) const {
    if (!is_next(frame_idx, group)) return false;
    const std::uint32_t place = place_of[frame_idx];
    const std::uint32_t own = layer(frame_idx);
    const std::uint32_t last = place_of[unit.back()];
    for (std::uint32_t i = 0; i < last; ++i) {
      const std::uint32_t f = order[i].frame;
      const bool needed = layer(f) < own || (layer(f) == own && i < place);
      if (needed && groups[f] <= group && !is_whole(f)) return false;
    }
    return true;
  }
  // Returns whether a unit would follow if frames were only counted: of each temporal layer, as
  // many frames have the layer group as may_follow() needs, but not the same frames.
  bool has_enough(std::uint32_t frame_idx, std::uint32_t group) const {
    if (!is_next(frame_idx, group)) return false;
    const std::uint32_t own = layer(frame_idx);
    std::vector<int> surplus(own + 1);
    for (std::uint32_t i = 0; i < num_frames; ++i) {
      const std::uint32_t f = order[i].frame;
      if (layer(f) > own) continue;
      const std::uint32_t end = place_of[layer(f) == own ? frame_idx : unit.back()];
      surplus[layer(f)] += (groups[f] > group || is_whole(f) ? 1 : 0) - (i < end ? 1 : 0);
    }
    return *std::min_element(surplus.begin(), surplus.end()) >= 0;
  }
  void end_unit() {
    unit_place = place_of[unit[0]];
    last_place = std::max<std::int64_t>(last_place, place_of[unit.back()]);
    to_come.clear();
    for (const std::uint32_t f : unit) {
      if (!is_whole(f)) to_come.push_back(f);
    }
  }
};

FramePatternRecipe recipe_of(const FramePattern& pattern) {
  if (pattern.kind != FramePattern::kDyadic) {
    return {static_cast<std::uint32_t>(pattern.kind), 1, {}, {}};
  }
  return FramePatternRecipe::dyadic(static_cast<std::uint32_t>(pattern.period_log2),
                                    pattern.temporal_layers - 1);
}

class RandomUnits {
 public:
  explicit RandomUnits(unsigned seed) : random_(seed) {
    // Half of the GOFs have what a frame unit waits for: temporal layers and layer groups.
    lags_ = below(4) == 0;
    const bool is_rich = lags_ || below(2) == 0;
    text_.pattern.kind =
        is_rich ? FramePattern::kDyadic : static_cast<FramePattern::Kind>(below(3));
    if (text_.pattern.kind == FramePattern::kDyadic) {
      text_.pattern.period_log2 = 1 + static_cast<int>(below(3));
    }
    const std::uint32_t num_depths = text_.pattern.num_depths();
    text_.pattern.temporal_layers = is_rich ? 2 + below(num_depths - 1) : 1 + below(num_depths);
    text_.num_frames = 2 + below(9);
    text_.num_groups = is_rich ? 2 + below(2) : 1 + below(3);
    text_.open_end = !lags_ && below(3) == 0;
    has_earlier_ = lags_ || below(2) == 0;
    text_.start();
    InterGofRecipe gof;
    gof.num_gof_frames_minus1 = text_.num_frames - 1;
    gof.pattern = recipe_of(text_.pattern);
    gof.frame_step_minus1.assign(text_.pattern.num_depths(), 0);
    gof.num_layer_groups_minus1 = text_.num_groups - 1;
    gof.layer_group_layers_minus1.assign(text_.num_groups - 1, 0);
    gof.max_earlier_distance = has_earlier_ ? 100 : 0;
    gof_ = gof.payload();
    start_again();
    contexts_.emplace(mesh_.mesh(), text_.num_groups, text_.pattern.num_depths());
  }

  int num_taken = 0;
  int num_refused = 0;
  int num_stand_ins = 0;  // units refused although enough frames have their layer group

  // Parses any unit, or a layer group of the first frame of a temporal layer that lacks it.
  void step() {
    std::uint32_t frame_idx = below(text_.num_frames);
    std::uint32_t group = below(text_.num_groups);
    if (below(4) != 0) {
      std::uint32_t t = below(text_.pattern.temporal_layers);
      if (lags_) {
        const bool is_first = text_.groups[0] < text_.num_groups;
        if (is_first) t = 0;
        if (t == 0) group = is_first ? text_.groups[0] : 0;
      }
      for (std::uint32_t p = 0; p < text_.num_frames; ++p) {
        const std::uint32_t f = text_.order[p].frame;
        if (text_.is_whole(f) || text_.layer(f) != t || text_.groups[f] != group) continue;
        frame_idx = f;
        break;
      }
    }
    const bool is_rest = group > 0 && !text_.to_come.empty() && below(2) == 0;
    if (is_rest) frame_idx = text_.to_come[0];
    add(frame_idx, group,
        is_rest ? static_cast<std::uint32_t>(text_.to_come.size()) - 1 : below(3));
  }

 private:
  std::uint32_t below(std::uint32_t n) { return static_cast<std::uint32_t>(random_() % n); }

  // Starts a new parser with the units so far: one that has refused a unit takes no others.
  void start_again() {
    SequenceHeader header = high_header(9, 40);
    header.open_end_flag = text_.open_end;
    units_.emplace(header, kSquares);
    EXPECT_TRUE(units_->gof(gof_));
    for (const Bytes& unit : taken_) EXPECT_TRUE(units_->frame(unit));
  }

  void add(std::uint32_t frame_idx, std::uint32_t group, std::uint32_t more) {
    FrameRecipe recipe(frame_idx, group);
    if (text_.open_end) recipe.gof_end_flag = false;
    recipe.unit_frames_minus1 = more;
    if (!text_.find_unit_frames(frame_idx, group, more)) {
      ++num_refused;
      return expect_invalid(units_->frame(recipe.payload()), "R-FRM-09", "unit_frames_minus1");
    }
    const bool is_legal = text_.may_follow(frame_idx, group);
    recipe.has_section = false;
    for (const std::uint32_t f : text_.unit) {
      const std::uint32_t place = text_.place_of[f];
      const bool may_repeat = has_earlier_ && place > 0 && group == 0;
      const bool is_of_first = lags_ && below(2) == 0;
      const std::uint32_t distance = may_repeat ? (is_of_first ? place : 1 + below(place)) : 0;
      const std::uint32_t earlier = text_.order[place - distance].frame;
      const bool repeats =
          may_repeat && below(2) == 0 && text_.layer(earlier) <= text_.layer(f);
      if (may_repeat) {
        recipe.earlier.emplace_back();
        if (repeats) recipe.earlier.back() = {distance - 1, true};
      }
      if (!is_legal) continue;
      if (!repeats) text_.groups[f] = group + 1;
      text_.repeats[f] = repeats;
      if (repeats) continue;
      recipe.has_section = true;
      contexts_->start_group(place, text_.order[place].depth, group);
      const bool is_last = group + 1 == text_.num_groups;
      recipe.zeros(*contexts_, mesh_.mesh().vertices_of_layers(group, is_last ? 3 : group + 1));
    }
    const Bytes payload = recipe.payload();
    const auto parsed = units_->frame(payload);
    if (is_legal) {
      ++num_taken;
      text_.end_unit();
      ASSERT_TRUE(parsed) << parsed.error().rule << ' ' << frame_idx << ' ' << group;
      taken_.push_back(payload);
      check_completeness();
    } else {
      ++num_refused;
      if (text_.has_enough(frame_idx, group)) ++num_stand_ins;
      expect_invalid(parsed, "R-FRM-03", "frame_unit");
      ASSERT_FALSE(parsed);
      EXPECT_EQ(parsed.error().bit_pos, kUnitBitPos);
      start_again();
    }
  }

  // DecodeCompleteFrames( )
  void check_completeness() {
    std::uint32_t end = text_.unit_place;
    while (end <= text_.last_place && text_.is_whole(text_.order[end].frame)) ++end;
    EXPECT_EQ(units_->parser().complete_places(), end);
  }

  std::mt19937 random_;
  InterGofUnits mesh_{high_header(9, 1), kSquares};
  UnitsOfText text_;
  Bytes gof_;
  std::vector<Bytes> taken_;
  bool has_earlier_ = false;
  // The first temporal layer has layer groups after the first only in the first frame, and in
  // frames that repeat it: later frames have what earlier ones lack.
  bool lags_ = false;
  std::optional<InterGofUnits> units_;
  std::optional<InterContexts> contexts_;
};

TEST(ParseFrameUnits, FollowEachOtherAsTheTextSays) {
  int num_taken = 0;
  int num_refused = 0;
  int num_stand_ins = 0;
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    SCOPED_TRACE(seed);
    RandomUnits units(seed);
    for (int i = 0; i < 40; ++i) {
      units.step();
      if (testing::Test::HasFailure()) return;
    }
    num_taken += units.num_taken;
    num_refused += units.num_refused;
    num_stand_ins += units.num_stand_ins;
  }
  EXPECT_GT(num_taken, 3000);
  EXPECT_GT(num_refused, 3000);
  EXPECT_GT(num_stand_ins, 10);
}

// The order is 0, 4, 2, 1, 3, 8, ..., in three temporal layers, with two layer groups. Frame 4
// has the first group alone; frame 8 repeats frame 0, which has both. Frame 2, of the next
// temporal layer, cannot have the second group before frame 4.
TEST(ParseFrameUnits, RepeatedFramesDoNotStandInForEarlierOnes) {
  InterGofUnits units(high_header(9, 9), kSquares);
  ASSERT_TRUE(units.gof({0x89, 0xE4, 0x9C, 0x00, 0x03, 0x25, 0xFF, 0xE0, 0x82}));
  const std::vector<Bytes> legal{
      {0xE0, 0xFF}, {0xA8, 0xF5}, {0x2E, 0xFE}, {0x13, 0xCB}, {0x78, 0xFE}};
  for (const Bytes& unit : legal) ASSERT_TRUE(units.frame(unit));
  expect_invalid(units.frame(Bytes{0x6A, 0xEF}), "R-FRM-03", "frame_unit");
}

TEST(ParseFrameUnits, StartWithTheirFrame) {
  for (const bool open_end : {false, true}) {
    SequenceHeader header = high_header(9, 40);
    header.open_end_flag = open_end;
    const Bytes bytes{0b00110'1'01};
    BitReader r(bytes);
    const FrameUnitStart start = parse_frame_unit_start(r, header, 6);
    EXPECT_EQ(start.frame_idx, 5U);
    EXPECT_EQ(start.gof_end_flag, open_end);
    EXPECT_EQ(r.bit_pos(), open_end ? 6U : 5U);
    EXPECT_FALSE(r.error());
    BitReader beyond(bytes);
    parse_frame_unit_start(beyond, header, 5);
    ASSERT_TRUE(beyond.error());
    EXPECT_STREQ(beyond.error()->rule, "R-FRM-02");
  }
}

// Three layer groups, and three frames in two temporal layers, in the order 0, 2, 1.
struct CutGof {
  InterGofUnits units;
  InterContexts contexts;

  explicit CutGof(const SliceCut& cut)
      : units(high_header(9, 3), kSquares, std::uint64_t{1} << 30, cut),
        contexts(units.mesh(), 3, 2) {
    InterGofRecipe gof;
    gof.num_gof_frames_minus1 = 2;
    gof.pattern = FramePatternRecipe::dyadic(1, 1);
    gof.frame_step_minus1 = {0, 0};
    gof.num_layer_groups_minus1 = 2;
    gof.layer_group_layers_minus1 = {0, 0};
    EXPECT_TRUE(units.gof(gof.payload()));
  }
  bool keeps(std::uint32_t place, std::uint32_t group) {
    const FramePlace& at = units.parser().order()[place];
    FrameRecipe recipe(at.frame, group);
    contexts.start_group(place, at.depth, group);
    recipe.zeros(contexts, units.mesh().vertices_of_layers(group, group + 1));
    EXPECT_TRUE(units.frame(recipe.payload()));
    return units.parser().last_unit().has_value();
  }
};

TEST(ParseFrameUnits, ThatACutDropsAreAbsent) {
  struct Case {
    SliceCut cut;
    std::uint32_t groups;
    std::uint32_t temporal_layers;
  };
  const std::vector<Case> cases{{{}, 3, 2},
                                {{.max_layers = 2}, 2, 2},
                                {{.max_layers = 0}, 1, 2},
                                {{.needed_layers = 1}, 1, 2},
                                {{.max_temporal_layers = 1}, 3, 1},
                                {{.max_layers = 2, .max_temporal_layers = 1}, 2, 1}};
  for (const Case& k : cases) {
    CutGof gof(k.cut);
    EXPECT_FALSE(gof.units.parser().is_cut());
    for (std::uint32_t place = 0; place < 3; ++place) {
      for (std::uint32_t group = 0; group < 3; ++group) {
        const bool stays = group < k.groups && (place < 2 || k.temporal_layers > 1);
        EXPECT_EQ(gof.keeps(place, group), stays) << place << ' ' << group;
      }
    }
    EXPECT_EQ(gof.units.parser().is_cut(), k.cut.cuts());
    const InterGof parsed = gof.units.parser().finish();
    EXPECT_EQ((*parsed.frames)[0].layer_groups, k.groups);
    EXPECT_EQ((*parsed.frames)[2].layer_groups, k.groups);
    EXPECT_EQ((*parsed.frames)[1].layer_groups, k.temporal_layers > 1 ? k.groups : 0);
  }
}

}  // namespace
}  // namespace rlpc
