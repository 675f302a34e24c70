#include "encoder/meshes/weld.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

using Frames = std::vector<std::vector<float>>;

class FramesInMemory : public FrameSource {
 public:
  FramesInMemory(Frames frames, std::vector<Triangle> triangles)
      : FrameSource({static_cast<std::uint32_t>(frames[0].size() / 3),
                     static_cast<std::uint32_t>(frames.size()),
                     {24, 1},
                     std::move(triangles),
                     {"a note"}}),
        frames_(std::move(frames)) {}
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    if (frames_[frame].empty()) return InputError{"frame " + std::to_string(frame)};
    std::copy(frames_[frame].begin(), frames_[frame].end(), xyz.begin());
    return std::nullopt;
  }

 private:
  Frames frames_;
};

// Returns vertices on the x axis.
std::vector<float> on_axis(const std::vector<float>& x) {
  std::vector<float> xyz;
  for (const float value : x) xyz.insert(xyz.end(), {value, 0, 0});
  return xyz;
}

std::unique_ptr<FrameSource> welded(const Frames& x, const std::vector<Triangle>& triangles) {
  Frames frames;
  for (const auto& frame : x) frames.push_back(on_axis(frame));
  auto result = weld(std::make_unique<FramesInMemory>(frames, triangles));
  EXPECT_TRUE(result) << result.error().message;
  return result ? std::move(*result) : nullptr;
}

std::vector<float> x_of(FrameSource& source, std::uint32_t frame) {
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  EXPECT_FALSE(source.read_frame(frame, xyz));
  std::vector<float> x;
  for (std::size_t i = 0; i < xyz.size(); i += 3) x.push_back(xyz[i]);
  return x;
}

TEST(Weld, MergesOnlyVerticesThatCoincideInEveryFrame) {
  const Frames frames{{1, 1, 2, 1, 2, 1}, {1, 1, 2, 3, 2, 3}, {1, 1, 2, 4, 5, 4}};
  const auto source = welded(frames, {{0, 2, 3}, {1, 4, 5}});
  EXPECT_EQ(source->num_vertices(), 4U);
  EXPECT_EQ(source->num_frames(), 3U);
  EXPECT_EQ(source->frame_rate(), (FrameRate{24, 1}));
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}}));
  EXPECT_EQ(x_of(*source, 0), (std::vector<float>{1, 2, 1, 2}));
  EXPECT_EQ(x_of(*source, 2), (std::vector<float>{1, 2, 4, 5}));
  EXPECT_EQ(source->notes(), (std::vector<std::string>{
                                 "a note",
                                 "merged 2 duplicate vertices (4 left); 'weld = false' keeps "
                                 "them apart"}));
}

TEST(Weld, ReportsTheDegenerateTrianglesItDrops) {
  const auto source = welded({{0, 0, 1, 2}}, {{0, 1, 2}, {1, 2, 3}, {2, 3, 2}, {0, 2, 3}});
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{0, 1, 2}, {0, 1, 2}}));
  EXPECT_EQ(source->notes().back(), "dropped 2 degenerate triangles");
  EXPECT_EQ(welded({{0, 0, 1}}, {{0, 1, 2}})->notes().back(), "dropped 1 degenerate triangle");
}

TEST(Weld, KeepsTheValuesOfTheTrianglesThatAreLeft) {
  FrameSource::Shape shape;
  shape.triangles = {{0, 1, 2}, {1, 1, 2}, {3, 1, 3}, {3, 2, 1}};
  shape.attributes.rest_of_corner = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11};
  shape.attributes.sets.push_back(
      {.name = "uv0",
       .domain = AttributeDomain::kCorner,
       .num_components = 2,
       .value_of_corner = {10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21}});
  shape.attributes.sets.push_back({.name = "two numbers",
                                   .domain = AttributeDomain::kTriangle,
                                   .num_components = 2,
                                   .values = {1, 2, 3, 4, 5, 6, 7, 8}});
  drop_degenerate(shape);
  using Indices = std::vector<std::uint32_t>;
  EXPECT_EQ(shape.triangles, (std::vector<Triangle>{{0, 1, 2}, {3, 2, 1}}));
  EXPECT_EQ(shape.attributes.rest_of_corner, (Indices{0, 1, 2, 9, 10, 11}));
  EXPECT_EQ(shape.attributes.sets[0].value_of_corner, (Indices{10, 11, 12, 19, 20, 21}));
  EXPECT_EQ(shape.attributes.sets[1].values, (std::vector<float>{1, 2, 7, 8}));
}

TEST(Weld, KeepsDistinctVertices) {
  const auto source = welded({{1, 2, 3}}, {{2, 1, 0}});
  EXPECT_EQ(x_of(*source, 0), (std::vector<float>{1, 2, 3}));
  EXPECT_EQ(source->triangles(), (std::vector<Triangle>{{2, 1, 0}}));
  EXPECT_EQ(source->notes(), (std::vector<std::string>{"a note"}));
}

TEST(Weld, TreatsBothZerosAsEqual) {
  const auto source = welded({{1, 0.0F, -0.0F, -0.0F, 0.0F}}, {});
  EXPECT_EQ(source->num_vertices(), 2U);
}

TEST(Weld, PassesErrorsOn) {
  const auto result =
      weld(std::make_unique<FramesInMemory>(Frames{on_axis({1}), {}}, std::vector<Triangle>{}));
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().message, "frame 1");
}

TEST(Weld, AgreesWithComparingAllPairs) {
  constexpr unsigned kSeed = 1;
  SCOPED_TRACE(kSeed);
  std::mt19937 random(kSeed);
  for (int round = 0; round < 50; ++round) {
    Frames frames(4, std::vector<float>(60));
    for (auto& frame : frames) {
      for (float& x : frame) x = static_cast<float>(random() % 3);
    }
    std::vector<std::size_t> kept;
    for (std::size_t v = 0; v < 60; ++v) {
      bool is_new = true;
      for (const std::size_t other : kept) {
        bool same = true;
        for (const auto& frame : frames) same = same && frame[v] == frame[other];
        is_new = is_new && !same;
      }
      if (is_new) kept.push_back(v);
    }
    const auto source = welded(frames, {});
    ASSERT_EQ(source->num_vertices(), kept.size());
    for (std::uint32_t f = 0; f < 4; ++f) {
      const std::vector<float> x = x_of(*source, f);
      for (std::size_t i = 0; i < kept.size(); ++i) ASSERT_EQ(x[i], frames[f][kept[i]]);
    }
  }
}

}  // namespace
}  // namespace rlpc
