// Tests the encoder as an application uses it: refused settings, and edge cases.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/files/glb.h"
#include "conformance/testing/small_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

// Returns the message of the error, or "" if there is none.
std::string error_of(FrameSource& source, const EncoderSettings& settings,
                     const ByteSink& sink = discard) {
  const auto report = encode(source, settings, sink);
  return report ? "" : report.error().message;
}
std::string error_of(const std::function<void(EncoderSettings&)>& change) {
  MemoryFrames source = bending_tube(4, 4);
  EncoderSettings settings;
  change(settings);
  return error_of(source, settings);
}

TEST(Settings, ThatContradictEachOtherAreRefused) {
  const auto paper = [](EncoderSettings& s) {
    s.profile = Profile::kBaseline;
    s.target = {Target::kNone, 0.0};
    s.baseline.qu = s.baseline.qc = 10;
    s.components = 2;
  };
  EXPECT_EQ(error_of(paper), "");
  EXPECT_NE(error_of([&](auto& s) { paper(s), s.baseline.qc = 0; }).find("go together"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) { paper(s), s.baseline.qu = 0; }).find("go together"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) {
              paper(s);
              s.target = {Target::kKg, 0.1};
            }).find("target"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) { paper(s), s.components = 0; }).find("components"),
            std::string::npos);
  const auto shared = [](EncoderSettings& s, bool rdo) {
    s.profile = Profile::kBaseline;
    s.baseline.rdo = rdo;
    s.baseline.rate_in_vectors = rdo;
  };
  EXPECT_NE(error_of([&](auto& s) { shared(s, false); }).find("'rdo = false' needs"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) { shared(s, true); }).find("'rate_in_vectors' needs"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) { paper(s), s.baseline.qu = 21; }).find("20 bits"),
            std::string::npos);
  EXPECT_NE(error_of([&](auto& s) { paper(s), s.baseline.qdelta = 25; }).find("24 bits"),
            std::string::npos);
}

TEST(Settings, KindsOfGofThatAProfileLacksAreRefused) {
  const auto error_with = [](Profile profile, GofKind kind) {
    return error_of([&](EncoderSettings& s) {
      s.profile = profile;
      s.gof_kind = kind;
    });
  };
  EXPECT_NE(
      error_with(Profile::kBaseline, GofKind::kSkinned).find("need 'profile = main' or high"),
      std::string::npos);
  EXPECT_NE(error_with(Profile::kMain, GofKind::kInter).find("need 'profile = high'"),
            std::string::npos);
  EXPECT_NE(error_with(Profile::kHigh, GofKind::kSharedRig).find("cannot be chosen"),
            std::string::npos);
  EXPECT_EQ(error_with(Profile::kMain, GofKind::kCluster), "");
}

// One parameter of a profile, and its name in the error message, in quotes.
struct Parameter {
  const char* setting;
  std::function<void(EncoderSettings&)> give;
};

void expect_only_of(Profile profile, const char* name, const std::vector<Parameter>& list) {
  const Profile other = profile == Profile::kMain ? Profile::kBaseline : Profile::kMain;
  for (const Parameter& p : list) {
    EXPECT_EQ(error_of([&](auto& s) { s.profile = profile, p.give(s); }), "") << p.setting;
    EXPECT_EQ(error_of([&](auto& s) { s.profile = other, p.give(s); }),
              std::string(p.setting) + " needs 'profile = " + name +
                  "': use that, or leave out " + p.setting);
  }
}

TEST(Settings, OfTheHighProfileAreRefusedInTheMainProfile) {
  for (const Parameter& p : std::vector<Parameter>{
           {"'adaptive_factors'", [](auto& s) { s.main.adaptive_factors = 4; }},
           {"'rest'", [](auto& s) { s.main.rest = RestTools::kOrder; }},
           {"'track_levels'", [](auto& s) { s.main.track_levels = 2; }},
           {"'temporal_layers'", [](auto& s) { s.main.temporal_layers = 2; }}}) {
    EXPECT_EQ(error_of([&](auto& s) { s.profile = Profile::kHigh, p.give(s); }), "");
    EXPECT_EQ(error_of([&](auto& s) { s.profile = Profile::kMain, p.give(s); }),
              std::string(p.setting) + " needs 'profile = high': use that, or leave out " +
                  p.setting);
  }
}

TEST(Settings, TemporalLayersNeedLevels) {
  const auto error = [](std::optional<std::uint32_t> levels, std::uint32_t layers) {
    return error_of([&](auto& s) {
      s.profile = Profile::kHigh;
      s.main.track_levels = levels;
      s.main.temporal_layers = layers;
    });
  };
  EXPECT_EQ(error({}, 8), "");
  EXPECT_EQ(error(2, 3), "");
  EXPECT_EQ(error(0, 1), "");
  EXPECT_NE(error({}, 9).find("1 to 8 temporal layers"), std::string::npos);
  EXPECT_NE(error(2, 4).find("1 to 3 temporal layers"), std::string::npos);
  EXPECT_NE(error({}, 0).find("('temporal_layers')"), std::string::npos);
}

TEST(Settings, OfTheBaselineProfileAreRefusedInTheMainProfile) {
  const auto given = [](EncoderSettings& s) {
    s.target = {Target::kNone, 0.0};
    s.components = 2;
  };
  expect_only_of(
      Profile::kBaseline, "baseline",
      {{"'clusters'", [](auto& s) { s.baseline.clusters = 2; }},
       {"'rdo = false'", [&](auto& s) { given(s), s.baseline.rdo = false; }},
       {"'rate_in_vectors'", [&](auto& s) { given(s), s.baseline.rate_in_vectors = true; }},
       {"'qu'", [&](auto& s) { given(s), s.baseline.qu = s.baseline.qc = 10; }},
       {"'qdelta'", [](auto& s) { s.baseline.qdelta = 10; }},
       {"'frame_mode'", [](auto& s) { s.baseline.frame_mode = FrameMode::kLcf; }},
       {"'seed_mode'", [](auto& s) { s.baseline.seed_mode = SeedMode::kSpread; }},
       {"'partition'", [](auto& s) { s.baseline.partition = PartitionMethod::kKway; }},
       {"'motion'", [](auto& s) { s.baseline.motion = MotionMeasure::kPlain; }}});
  EXPECT_NE(
      error_of([](auto& s) { s.baseline.qc = 10; }).find("'qc' needs 'profile = baseline'"),
      std::string::npos);
}

TEST(Settings, OfSeedsAreRefusedWithOtherPartitions) {
  const auto error = [](SeedMode seeds, MotionMeasure motion) {
    return error_of([&](auto& s) {
      s.profile = Profile::kBaseline;
      s.baseline.partition = PartitionMethod::kLloyd;
      s.baseline.seed_mode = seeds;
      s.baseline.motion = motion;
    });
  };
  EXPECT_EQ(error(SeedMode::kTriangle, MotionMeasure::kAuto), "");
  EXPECT_NE(error(SeedMode::kFirst, MotionMeasure::kAuto).find("'seed_mode = first' needs"),
            std::string::npos);
  EXPECT_NE(error(SeedMode::kAuto, MotionMeasure::kSquared).find("'motion' needs"),
            std::string::npos);
}

TEST(Settings, OfTheMainProfileAreRefusedInTheBaselineProfile) {
  expect_only_of(
      Profile::kMain, "main",
      {{"'bones'", [](auto& s) { s.main.bones = 2; }},
       {"'prediction'", [](auto& s) { s.main.prediction = Prediction::kNone; }},
       {"'influences'", [](auto& s) { s.main.influences = 2; }},
       {"'geometry_weights = false'", [](auto& s) { s.main.geometry_weights = false; }},
       {"'outer_ring = false'", [](auto& s) { s.main.outer_ring = false; }},
       {"'layer_steps = false'", [](auto& s) { s.main.layer_steps = false; }},
       {"'temporal_weights = false'", [](auto& s) { s.main.temporal_weights = false; }},
       {"'cobra_steps'", [](auto& s) { s.main.cobra_steps = true; }},
       {"'clusters = false'", [](auto& s) { s.main.clusters = false; }},
       {"'component_groups'", [](auto& s) { s.main.component_groups = 2; }},
       {"'layer_groups'", [](auto& s) { s.main.layer_groups = 2; }}});
}

TEST(Settings, OfLayersAreRefusedWithoutThem) {
  const std::vector<Parameter> list{
      {"'geometry_weights = false'", [](auto& s) { s.main.geometry_weights = false; }},
      {"'outer_ring = false'", [](auto& s) { s.main.outer_ring = false; }},
      {"'layer_steps = false'", [](auto& s) { s.main.layer_steps = false; }},
      {"'layer_groups'", [](auto& s) { s.main.layer_groups = 2; }}};
  for (const Parameter& p : list) {
    EXPECT_EQ(error_of([&](auto& s) { s.main.prediction = Prediction::kLayers, p.give(s); }),
              "");
    EXPECT_EQ(
        error_of([&](auto& s) { s.main.prediction = Prediction::kNone, p.give(s); }),
        std::string(p.setting) + " needs layers: leave it out, or use 'prediction = layers'");
  }
  EXPECT_EQ(error_of([](auto& s) {
              s.main.prediction = Prediction::kNone;
              s.main.layer_groups = 1;
            }),
            "");
}

TEST(Settings, TheLevelIsThatOfTheStream) {
  MemoryFrames source = bending_tube(40, 6);
  EncoderSettings settings;
  settings.preset = Preset::kFast;
  settings.components = 1024;
  settings.main.bones = 1024;
  const auto report = encode(source, settings, discard);
  ASSERT_TRUE(report);
  EXPECT_LT(report->components, 20U);
  EXPECT_EQ(report->header.level_idc, 1U);
}

TEST(Settings, AVertexFollowsAtMostFourBones) {
  EXPECT_EQ(error_of([](auto& s) { s.main.influences = 4; }), "");
  EXPECT_NE(error_of([](auto& s) { s.main.influences = 5; }).find("4 bones ('influences')"),
            std::string::npos);
}

TEST(Settings, ATargetIsAboveZero) {
  for (const auto kind : {Target::kKg, Target::kBpvf, Target::kMaxError}) {
    for (const double value : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(),
                               std::numeric_limits<double>::infinity()}) {
      EXPECT_NE(error_of([&](auto& s) {
                  s.target = {kind, value};
                }).find("above zero"),
                std::string::npos)
          << value;
    }
  }
}

TEST(Settings, NoLevelHasMoreClustersBonesOrComponents) {
  EXPECT_EQ(error_of([](auto& s) { s.main.bones = 1025; }),
            "no level allows more than 1024 bones ('bones')");
  EXPECT_EQ(error_of([](auto& s) {
              s.profile = Profile::kBaseline;
              s.baseline.clusters = 1025;
            }),
            "no level allows more than 1024 clusters ('clusters')");
  EXPECT_EQ(error_of([](auto& s) { s.components = 1025; }),
            "no level allows more than 1024 components ('components')");
}

// Targets larger than anything in the animation, and so large that sums overflow.
TEST(Settings, ATargetMayAllowAnyError) {
  for (const auto kind : {Target::kKg, Target::kBpvf, Target::kMaxError}) {
    for (const double value : {1e6, 1e300, std::numeric_limits<double>::max()}) {
      EXPECT_EQ(error_of([&](auto& s) { s.target = {kind, value}; }), "") << value;
    }
  }
}

TEST(Settings, AsManyClustersAsAskedForAreMade) {
  for (const Preset preset : {Preset::kFast, Preset::kMedium}) {
    MemoryFrames source = bending_tube(40, 6);
    EncoderSettings settings;
    settings.profile = Profile::kBaseline;
    settings.preset = preset;
    settings.baseline.clusters = 40;
    const auto report = encode(source, settings, discard);
    ASSERT_TRUE(report);
    EXPECT_EQ(report->clusters, 40U);
  }
}

TEST(Encoder, RefusesWhatNoLevelAllows) {
  // A GOF has at most 16384 frames.
  std::vector<std::vector<float>> frames(16385, std::vector<float>{0.0F, 1.0F, 2.0F});
  MemoryFrames source({}, std::move(frames));
  EncoderSettings settings;
  settings.gof_frames = EncoderSettings::kWholeSequence;
  EXPECT_NE(error_of(source, settings).find("smaller 'gof_frames'"), std::string::npos);
}

TEST(Encoder, RefusesWhatMayNeedMoreMemoryThanThereIs) {
  EncoderSettings settings;
  settings.max_memory_bytes = std::uint64_t{20} << 20;
  MemoryFrames small = bending_tube(4, 4);
  EXPECT_TRUE(encode(small, settings, discard));
  MemoryFrames large = bending_tube(300, 200);
  settings.gof_frames = EncoderSettings::kWholeSequence;
  const auto report = encode(large, settings, discard);
  ASSERT_FALSE(report);
  EXPECT_TRUE(report.error().is_limit);
  EXPECT_NE(report.error().message.find("the limit is 20 MiB ('max_memory_bytes')"),
            std::string::npos);
}

TEST(Encoder, ASinkThatFailsEndsIt) {
  for (int calls = 0; calls < 3; ++calls) {
    MemoryFrames source = bending_tube(4, 4);
    int left = calls;
    const auto sink = [&](std::span<const std::uint8_t>) { return left-- > 0; };
    EXPECT_NE(error_of(source, {}, sink).find("could not be written"), std::string::npos);
    EXPECT_EQ(left, -1) << "asked again after a failure";
  }
}

// Fails at one frame, the n-th time that it is read.
class FailingFrames final : public FrameSource {
 public:
  FailingFrames(std::uint32_t frame, int times)
      : FrameSource({12, 5, {}, {{0, 1, 2}}}), frame_(frame), times_(times) {}
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    if (frame == frame_ && --times_ == 0) return InputError{"disk unplugged"};
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = static_cast<float>((i * i + 3 * frame) % 7);
    }
    return std::nullopt;
  }

 private:
  std::uint32_t frame_;
  int times_;
};

TEST(Encoder, PassesOnTheErrorOfItsSource) {
  for (const int times : {1, 2, 3}) {
    FailingFrames source(3, times);
    EXPECT_EQ(error_of(source, {}), "disk unplugged");
  }
}

TEST(Encoder, RefusesCoordinatesBeyondItsGrid) {
  MemoryFrames source({}, {{0.0F, 0.0F, 0.0F, 1.0F, 3e38F, 1.0F}});
  EXPECT_NE(error_of(source, {}).find("scale the animation down"), std::string::npos);
}

// Frames of a tube with clips and an asset, as readers of glTF make them.
MemoryFrames tube_of_an_asset() {
  MemoryFrames plain = bending_tube(4, 6);
  FrameSource::Shape shape;
  shape.frame_rate = plain.frame_rate();
  shape.triangles = plain.triangles();
  shape.clips = {{"walk", 0, 4}, {"run", 4, 2}};
  shape.asset = glb_head(R"({"asset":{"version":"2.0"}})", 0);
  std::vector<std::vector<float>> frames(plain.num_frames());
  for (std::uint32_t f = 0; f < plain.num_frames(); ++f) {
    frames[f].resize(3 * std::size_t{plain.num_vertices()});
    plain.read_frame(f, frames[f]);
  }
  return {std::move(shape), std::move(frames)};
}

TEST(Encoder, TakesClipsAndAssetFromItsSource) {
  MemoryFrames source = tube_of_an_asset();
  for (const bool takes : {true, false}) {
    EncoderSettings settings;
    settings.takes_from_source = takes;
    const StreamBytes bytes = encode_to_memory(source, settings);
    ASSERT_FALSE(bytes.empty());
    auto decoder = Decoder::open(memory_source(bytes));
    ASSERT_TRUE(decoder);
    EXPECT_EQ(decoder->clips().size(), takes ? 2U : 0U);
    const auto asset = decoder->asset();
    ASSERT_TRUE(asset);
    EXPECT_EQ(std::string(asset->begin(), asset->end()), takes ? source.asset() : "");
  }
}

TEST(Encoder, ReportsProgressUpToOne) {
  MemoryFrames source = bending_tube(4, 8);
  std::vector<double> seen;
  ASSERT_TRUE(encode(source, {}, discard, [&](double fraction) { seen.push_back(fraction); }));
  ASSERT_FALSE(seen.empty());
  EXPECT_EQ(seen.back(), 1.0);
  EXPECT_GE(seen.front(), 0.0);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
}

// Edge cases: they encode, decode, and are within the target.
struct Edge {
  const char* name;
  std::vector<Triangle> triangles;
  std::vector<std::vector<float>> frames;
};

std::vector<float> repeated(const std::vector<float>& once, std::size_t times) {
  std::vector<float> all;
  for (std::size_t i = 0; i < times; ++i) all.insert(all.end(), once.begin(), once.end());
  return all;
}

std::vector<Edge> edges() {
  const std::vector<Triangle> one{{0, 1, 2}};
  const std::vector<float> corner{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::vector<float> line{0, 0, 0, 1, 0, 0, 2, 0, 0};
  const std::vector<float> sevens = repeated({7, 7, 7}, 5);
  std::vector<Edge> list;
  list.push_back({"one vertex", {}, {{1, 2, 3}}});
  list.push_back({"one vertex that moves", {}, {{1, 2, 3}, {2, 2, 3}, {4, 2, 3}}});
  list.push_back({"two vertices", {}, {{1, 2, 3, 3, 2, 1}, {1, 2, 3, 3, 2, 2}}});
  list.push_back({"one triangle", one, {corner, corner}});
  list.push_back({"one frame", one, {corner}});
  list.push_back({"no triangles", {}, {repeated({1, 2, 3, 0, 1, 0, 5, 5, 5}, 7)}});
  list.push_back(
      {"equal vertices", {{0, 1, 2}, {2, 3, 4}}, {sevens, sevens, repeated({8, 7, 7}, 5)}});
  list.push_back({"all at the origin", one, {repeated({0, 0, 0}, 3), repeated({0, 0, 0}, 3)}});
  list.push_back({"a degenerate triangle", {{0, 0, 1}}, {corner, corner}});
  list.push_back({"a line, a corner, a point", one, {line, corner, repeated({5, 5, 5}, 3)}});
  list.push_back({"huge", one, {{0, 0, 0, 1e30F, 0, 0, 0, 1e30F, 0}}});
  list.push_back({"tiny", one, {{0, 0, 0, 1e-38F, 0, 0, 0, 1e-38F, 0}}});
  list.push_back({"far away", one, {{1e6F, 0, 0, 1e6F, 1, 0, 1e6F, 1, 1}, corner}});
  return list;
}

// Encodes at 1 %, and decodes all frames.
void expect_edge_round_trip(const Edge& edge, EncoderSettings settings) {
  FrameSource::Shape shape;
  shape.triangles = edge.triangles;
  MemoryFrames source(std::move(shape), edge.frames);
  settings.target = {Target::kKg, 1.0};
  settings.keep_order = true;
  EncodeReport report;
  const StreamBytes stream = encode_to_memory(source, settings, &report);
  ASSERT_FALSE(stream.empty()) << error_of(source, settings);
  EXPECT_TRUE(!report.target_met || report.metrics.kg_error_percent <= 1.0);
  auto decoder = Decoder::open(memory_source(StreamBytes(stream)));
  ASSERT_TRUE(decoder) << decoder.error().rule;
  std::vector<std::int32_t> positions(3 * std::size_t{source.num_vertices()});
  std::uint32_t frames = 0;
  for (auto more = decoder->next_frame(positions);; more = decoder->next_frame(positions)) {
    ASSERT_TRUE(more) << more.error().rule << " " << more.error().element;
    if (!*more) break;
    ++frames;
  }
  EXPECT_EQ(frames, source.num_frames());
}

TEST(Encoder, AcceptsEdgeCases) {
  for (const Edge& edge : edges()) {
    for (const std::uint32_t parts : {0U, 1U, 3U}) {
      SCOPED_TRACE(testing::Message() << edge.name << ", " << parts << " bones or clusters");
      EncoderSettings settings;
      settings.main.bones = parts;
      expect_edge_round_trip(edge, settings);
      for (const FrameMode mode : {FrameMode::kAuto, FrameMode::kLcf, FrameMode::kWorld}) {
        SCOPED_TRACE(testing::Message() << "Baseline, mode " << static_cast<int>(mode));
        EncoderSettings baseline;
        baseline.profile = Profile::kBaseline;
        baseline.baseline.clusters = parts;
        baseline.baseline.frame_mode = mode;
        expect_edge_round_trip(edge, baseline);
      }
    }
  }
}

// Factors would not fit their widths at the finest steps; steps are then as fine as possible.
TEST(Encoder, IsExactWhereMoreThanThatIsAskedFor) {
  for (const std::uint32_t bones : {1U, 4U}) {
    for (const Prediction prediction : {Prediction::kNone, Prediction::kLayers}) {
      MemoryFrames source = bending_tube(40, 30);
      EncoderSettings settings;
      settings.main.bones = bones;
      settings.main.prediction = prediction;
      settings.target = {Target::kBpvf, 100.0};
      const auto report = encode(source, settings, discard);
      ASSERT_TRUE(report) << report.error().message;
      EXPECT_LT(report->metrics.kg_error_percent, 0.0005);
    }
  }
}

TEST(Encoder, SameInputAndSettingsGiveTheSameBytes) {
  EXPECT_EQ(rich_stream(), rich_stream());
  EXPECT_EQ(indexed_stream(), indexed_stream());
}

}  // namespace
}  // namespace rlpc
