#include "encoder/codec/sequence/choices/grid_choice.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/files/float_position.h"

namespace rlpc {
namespace {

class Frames final : public FrameSource {
 public:
  explicit Frames(std::vector<std::vector<float>> frames)
      : FrameSource(shape_of(frames)), frames_(std::move(frames)) {}
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    if (frames_[frame].empty()) return InputError{"frame 1 is lost"};
    std::copy(frames_[frame].begin(), frames_[frame].end(), xyz.begin());
    return std::nullopt;
  }
  std::string file_of(std::uint32_t frame) const override {
    return "f" + std::to_string(frame) + ".obj";
  }

 private:
  static Shape shape_of(const std::vector<std::vector<float>>& frames) {
    Shape shape;
    shape.num_vertices = static_cast<std::uint32_t>(frames[0].size() / 3);
    shape.num_frames = static_cast<std::uint32_t>(frames.size());
    return shape;
  }
  std::vector<std::vector<float>> frames_;
};

Extent box(double min, double max) { return {{min, min, min}, {max, max, max}, 0.0}; }

// Checks that every point of the box has a grid position of position_bits within half a step
// (plus float rounding), and that all elements of the grid are legal.
void expect_covered(const Extent& extent, const GridChoice& choice) {
  EXPECT_GE(choice.grid.log2_step, kMinGridLog2Step);
  EXPECT_LE(choice.grid.log2_step, kMaxGridLog2Step);
  EXPECT_GE(choice.position_bits, kMinPositionBits);
  EXPECT_LE(choice.position_bits, kMaxPositionBits);
  const double step = std::ldexp(1.0, choice.grid.log2_step);
  const double half = std::ldexp(1.0, choice.position_bits - 1);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_LE(std::abs(choice.grid.origin[c]), kMaxGridOrigin);
    for (const double x : {extent.min[c], extent.max[c]}) {
      const double position = std::round(x / step) - choice.grid.origin[c];
      ASSERT_GE(position, -half) << x;
      ASSERT_LE(position, half - 1) << x;
      const float value = float_position(choice.grid, c, static_cast<std::int32_t>(position));
      EXPECT_LE(std::abs(value - x), 0.5 * step + std::abs(x) * 0x1p-24) << x;
    }
  }
}

TEST(ChooseGrid, CoversTheBox) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const auto next = [&] { return static_cast<double>(random() % 2000001) / 1e6 - 1.0; };
    const double size = std::ldexp(1.0, static_cast<int>(random() % 230) - 130);
    Extent extent;
    for (std::size_t c = 0; c < 3; ++c) {
      const double a = next() * size;
      const double b = random() % 8 == 0 ? a : next() * size;
      extent.min[c] = static_cast<float>(std::min(a, b));
      extent.max[c] = static_cast<float>(std::max(a, b));
    }
    for (const double finest : {0.0, 1e-9, 1e-4, 0.1, 10.0}) {
      expect_covered(extent, choose_grid(extent, finest * size));
    }
  }
}

TEST(ChooseGrid, HasAMarginAroundBoxesOfAPowerOfTwo) {
  for (int n = -100; n <= 99; ++n) {
    const double size = std::ldexp(1.0, n);
    for (const Extent& extent : {box(-size, size), box(0.0, size), box(-size, 3.0 * size)}) {
      const GridChoice choice = choose_grid(extent, 0.0);
      expect_covered(extent, choice);
      const double half = std::ldexp(1.0, choice.position_bits - 1 + choice.grid.log2_step);
      EXPECT_GE(half, 1.01 * 0.5 * (extent.max[0] - extent.min[0]));
    }
  }
}

TEST(ChooseGrid, IsAsFineAsTheErrorRequires) {
  const Extent extent = box(-3.0, 5.0);
  for (const double finest : {0.1, 1e-3, 5e-5}) {
    const GridChoice choice = choose_grid(extent, finest);
    EXPECT_LE(std::ldexp(1.0, choice.grid.log2_step), finest / 16);
  }
  EXPECT_EQ(choose_grid(extent, 0.0).position_bits, 20);
  EXPECT_EQ(choose_grid(extent, 1.0).position_bits, 20);
  EXPECT_GT(choose_grid(extent, 1e-4).position_bits, 20);
  EXPECT_EQ(choose_grid(extent, 1e-12).position_bits, kMaxPositionBits);  // the finest possible
}

TEST(ChooseGrid, AcceptsAnyError) {
  for (const double size : {1e-44, 1.0, 1e30}) {
    for (const double finest :
         {std::numeric_limits<double>::min(), 1e300, std::numeric_limits<double>::infinity()}) {
      expect_covered(box(-size, size), choose_grid(box(-size, size), finest));
    }
  }
}

TEST(ChooseGrid, UsesAtLeastHalfOfItsPositions) {
  double size = 1e-20;
  for (int i = 0; i < 70; ++i, size *= 3.7) {
    const GridChoice choice = choose_grid(box(-size, size), 0.0);
    const double positions = 2.0 * size / std::ldexp(1.0, choice.grid.log2_step);
    EXPECT_GE(positions, std::ldexp(0.49, choice.position_bits));
  }
}

TEST(ChooseGrid, AcceptsVerticesThatAreAllEqual) {
  for (const double x : {0.0, 1.0, -12345.678, 1e30, 1e-30, -1e-44}) {
    const auto value = static_cast<double>(static_cast<float>(x));
    const Extent extent = box(value, value);
    expect_covered(extent, choose_grid(extent, 0.0));
  }
}

TEST(ChooseGrid, AcceptsHugeAndTinyCoordinates) {
  for (const double size : {1e30, 1.2676e30, 1e-30, 1e-38, 1.4e-45}) {
    for (const Extent& extent : {box(-size, size), box(0.0, size), box(0.99 * size, size)}) {
      expect_covered(extent, choose_grid(extent, 0.0));
      expect_covered(extent, choose_grid(extent, size * 1e-6));
    }
  }
}

TEST(ChooseGrid, FarFromTheOriginIsLimitedByTheOriginNotTheBox) {
  const Extent extent = box(1e6, 1e6 + 1.0);
  const GridChoice choice = choose_grid(extent, 0.0);
  expect_covered(extent, choice);
  // The origin has 26 bits: 1e6 / 2^26 is 0.0149, so the step is 1/64.
  EXPECT_EQ(choice.grid.log2_step, -6);
  // Floats there are 1/16 apart, so distinct vertices stay distinct.
  EXPECT_LT(std::ldexp(1.0, choice.grid.log2_step), 0x1p-4);
}

TEST(MeasureExtent, IsTheBoxOverAllFramesAndTheSpreadAboutTheirMeans) {
  Frames frames({{0, 0, 0, 2, 4, 0}, {10, 1, -7, 14, 1, -7}});
  const auto extent = measure_extent(frames);
  ASSERT_TRUE(extent);
  EXPECT_EQ(extent->min, (std::array<double, 3>{0, 0, -7}));
  EXPECT_EQ(extent->max, (std::array<double, 3>{14, 4, 0}));
  // Squared deviations: 2 * 1 + 2 * 4 in the first frame, 2 * 4 in the second; 12 values.
  EXPECT_DOUBLE_EQ(extent->rms_spread, std::sqrt(18.0 / 12.0));
}

TEST(MeasureExtent, RefusesCoordinatesBeyondTwoToThe100AndNamesFileAndFrame) {
  const float largest = 0x1p100F;
  Frames fits({{0, 0, 0}, {largest, -largest, 0}});
  EXPECT_TRUE(measure_extent(fits));
  for (const float x : {std::nextafter(largest, 2 * largest), -2 * largest, 3e38F}) {
    Frames frames({{0, 0, 0}, {1, 2, 3}, {0, x, 0}});
    const auto extent = measure_extent(frames);
    ASSERT_FALSE(extent);
    EXPECT_TRUE(extent.error().message.starts_with(
        "f2.obj: frame 2 (from 0) has coordinates beyond 2^100"))
        << extent.error().message;
  }
}

TEST(MeasureExtent, PassesOnTheErrorOfTheSource) {
  Frames frames({{0, 0, 0}, {}});
  const auto extent = measure_extent(frames);
  ASSERT_FALSE(extent);
  EXPECT_EQ(extent.error().message, "frame 1 is lost");
}

}  // namespace
}  // namespace rlpc
