// Streams of the Main profile from the encoder to the decoder, as applications use them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"
#include "decoder/rlpc_decoder.h"
#include "encoder/codec/metrics/metrics.h"

namespace rlpc {
namespace {

Encoded encoded_in_order(MemoryFrames& source, EncoderSettings settings) {
  settings.profile = Profile::kMain;
  settings.keep_order = true;
  return encode_with_report(source, settings);
}

EncoderSettings settings_with_hashes(Target target, Preset preset = Preset::kFast) {
  EncoderSettings settings;
  settings.target = target;
  settings.preset = preset;
  settings.hash_mode = HashMode::kFrame;  // hashes of the encoder, verified below
  return settings;
}

// Decodes all frames, hashes checked, in input order, and compares with the source.
Metrics decoded_metrics(MemoryFrames& source, const StreamBytes& bytes) {
  auto decoder = Decoder::open(memory_source(bytes));
  EXPECT_TRUE(decoder) << decoder.error().rule;
  const std::uint32_t n = source.num_vertices();
  MetricsAccumulator metrics(n);
  if (!decoder) return {};
  std::vector<std::int32_t> positions(3 * std::size_t{n});
  std::vector<float> original(positions.size());
  std::vector<float> decoded(positions.size());
  std::uint32_t count = 0;
  for (;;) {
    const auto more = decoder->next_frame(positions);
    EXPECT_TRUE(more) << more.error().rule << " " << more.error().element;
    if (!more || !*more) break;
    EXPECT_FALSE(source.read_frame(count++, original));
    for (std::size_t i = 0; i < positions.size(); ++i) {
      decoded[i] = float_position(decoder->header().grid, i % 3, positions[i]);
    }
    metrics.add_frame(original, decoded);
  }
  EXPECT_EQ(count, source.num_frames());
  return metrics.result();
}

// Moves frame 0 of bending_tube as a whole.
MemoryFrames moved_tube(std::uint32_t num_frames, bool moves) {
  MemoryFrames tube = bending_tube(12, 1);
  std::vector<float> first(3 * std::size_t{tube.num_vertices()});
  EXPECT_FALSE(tube.read_frame(0, first));
  std::vector<std::vector<float>> frames;
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    const double angle = moves ? 0.9 * std::sin(0.3 * f) : 0.0;
    std::vector<float> xyz;
    for (std::size_t i = 0; i < first.size(); i += 3) {
      const double x = first[i] * std::cos(angle) - first[i + 1] * std::sin(angle);
      const double y = first[i] * std::sin(angle) + first[i + 1] * std::cos(angle);
      for (const double c : {x, y + (moves ? 0.1 * f : 0.0), double{first[i + 2]}}) {
        xyz.push_back(static_cast<float>(c));
      }
    }
    frames.push_back(std::move(xyz));
  }
  FrameSource::Shape shape;
  shape.frame_rate = {24, 1};
  shape.triangles.assign(tube.triangles().begin(), tube.triangles().end());
  return {std::move(shape), std::move(frames)};
}

TEST(MainProfile, DecodesToWhatTheEncoderReports) {
  for (const Preset preset : {Preset::kFast, Preset::kMedium}) {
    for (const std::uint32_t gof : {0U, 7U}) {
      MemoryFrames source = bending_tube(12, 20);
      EncoderSettings settings = settings_with_hashes({Target::kKg, 0.5}, preset);
      settings.gof_frames = gof;
      const Encoded e = encoded_in_order(source, settings);
      const Metrics metrics = decoded_metrics(source, e.bytes);
      EXPECT_EQ(metrics.kg_error_percent, e.report.metrics.kg_error_percent);
      EXPECT_EQ(metrics.max_error, e.report.metrics.max_error);
      EXPECT_EQ(e.bytes.size(), e.report.bytes);
      EXPECT_EQ(e.report.header.profile_idc, kProfileMain);
      EXPECT_TRUE(e.report.target_met);
      EXPECT_LE(metrics.kg_error_percent, 0.5);
    }
  }
}

TEST(MainProfile, HoldsTheLargestErrorOfAVertex) {
  for (const double bound : {0.05, 0.005, 0.0005}) {
    MemoryFrames source = bending_tube(12, 16);
    const Encoded e =
        encoded_in_order(source, settings_with_hashes({Target::kMaxError, bound}));
    EXPECT_TRUE(e.report.target_met) << bound;
    EXPECT_LE(decoded_metrics(source, e.bytes).max_error, bound);
  }
}

TEST(MainProfile, FramesOfAStillOrRigidMeshCostNextToNothing) {
  const auto bytes = [](std::uint32_t num_frames, bool moves) {
    MemoryFrames source = moved_tube(num_frames, moves);
    return encoded_in_order(
               source,
               [] {
                 EncoderSettings settings = settings_with_hashes({Target::kMaxError, 0.01});
                 settings.hash_mode = HashMode::kNone;
                 return settings;
               }())
        .bytes.size();
  };
  const std::size_t one = bytes(1, false);
  EXPECT_LT(bytes(60, false), one + 100);
  EXPECT_LT(bytes(60, true), one + 60 * 16);
}

TEST(MainProfile, EncodesTheSameEachTime) {
  for (const Preset preset : {Preset::kFast, Preset::kMedium}) {
    MemoryFrames source = bending_tube(10, 12);
    const EncoderSettings settings = settings_with_hashes({Target::kKg, 0.3}, preset);
    EXPECT_EQ(encoded_in_order(source, settings).bytes,
              encoded_in_order(source, settings).bytes);
  }
}

// Noise needs all trajectories, which are more than the level of so small a mesh allows.
TEST(MainProfile, RaisesTheLevelForManyTrajectories) {
  constexpr std::uint32_t kVertices = 540;
  constexpr std::uint32_t kFrames = 174;
  FrameSource::Shape shape;
  shape.frame_rate = {24, 1};
  std::vector<std::vector<float>> frames(kFrames);
  std::uint32_t state = 1;
  for (auto& frame : frames) {
    for (std::uint32_t i = 0; i < 3 * kVertices; ++i) {
      state = state * 1664525 + 1013904223;
      frame.push_back(static_cast<float>(state >> 8) * 0x1p-24F);
    }
  }
  MemoryFrames source(std::move(shape), std::move(frames));
  EncoderSettings settings = settings_with_hashes({Target::kKg, 1.0});
  settings.gof_frames = EncoderSettings::kWholeSequence;
  settings.gof_kind = GofKind::kSkinned;  // clusters cost less
  const Encoded e = encoded_in_order(source, settings);
  EXPECT_GT(e.report.components, kLevels[0].max_components);
  EXPECT_EQ(e.report.header.level_idc, 2U);
  EXPECT_LE(decoded_metrics(source, e.bytes).kg_error_percent, 1.0);
}

TEST(MainProfile, AcceptsDegenerateMeshes) {
  struct Case {
    std::uint32_t num_vertices;
    std::uint32_t num_frames;
    std::vector<Triangle> triangles;
  };
  const std::vector<Case> cases{{1, 3, {}},
                                {1, 1, {{0, 0, 0}}},
                                {2, 4, {}},
                                {40, 5, {}},
                                {40, 1, {{0, 1, 2}, {2, 1, 3}}},
                                {30, 9, {{0, 1, 2}, {0, 1, 2}, {3, 3, 4}, {7, 8, 9}}}};
  for (const Case& c : cases) {
    SCOPED_TRACE(testing::Message() << c.num_vertices << " vertices, " << c.num_frames);
    FrameSource::Shape shape;
    shape.frame_rate = {24, 1};
    shape.triangles = c.triangles;
    std::vector<std::vector<float>> frames(c.num_frames);
    for (std::uint32_t f = 0; f < c.num_frames; ++f) {
      for (std::uint32_t v = 0; v < c.num_vertices; ++v) {
        for (const std::uint32_t x : {v, f * (v % 3), 0U}) {
          frames[f].push_back(static_cast<float>(x));
        }
      }
    }
    MemoryFrames source(std::move(shape), std::move(frames));
    const Encoded e = encoded_in_order(source, settings_with_hashes({Target::kMaxError, 0.01}));
    EXPECT_LE(decoded_metrics(source, e.bytes).max_error, 0.01);
  }
}

}  // namespace
}  // namespace rlpc
