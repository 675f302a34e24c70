#include "encoder/codec/sequence/choices/lossless_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/files/float_position.h"

namespace rlpc {
namespace {

class Points final : public FrameSource {
 public:
  explicit Points(std::vector<float> xyz)
      : FrameSource({static_cast<std::uint32_t>(xyz.size() / 3), 1, {}, {}}),
        xyz_(std::move(xyz)) {}
  std::optional<InputError> read_frame(std::uint32_t, std::span<float> xyz) override {
    std::copy(xyz_.begin(), xyz_.end(), xyz.begin());
    return std::nullopt;
  }
  const std::vector<float>& xyz() const { return xyz_; }

 private:
  std::vector<float> xyz_;
};

InputResult<GridChoice> own_grid(Points& points) {
  return grid_of_source(points, *measure_extent(points));
}

// Returns the coordinate that a decoder computes from the position that the encoder rounds x
// to.
float restored(const GridChoice& choice, std::size_t c, float x) {
  const double position =
      std::floor(std::ldexp(double{x}, -choice.grid.log2_step) + 0.5) - choice.grid.origin[c];
  const double half = std::ldexp(1.0, choice.position_bits - 1);
  EXPECT_GE(position, -half);
  EXPECT_LT(position, half);
  return float_position(choice.grid, c, static_cast<std::int32_t>(position));
}

TEST(LosslessGrid, IsTheCoarsestThatHoldsAllCoordinates) {
  Points points({0.25F, -0.5F, 0.0F, 3.0F, 1.75F, -2.0F});
  const auto grid = own_grid(points);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->grid.log2_step, -2);
  EXPECT_EQ(grid->position_bits, 4);  // 3 - 1/4 is 11 steps
  EXPECT_EQ(own_grid(*std::make_unique<Points>(std::vector<float>(9, 0.0F)))->position_bits, 2);
}

TEST(LosslessGrid, RestoresEveryCoordinate) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const int log2_step = static_cast<int>(random() % 200) - 149;
    const std::uint32_t width = 1U << (1 + random() % 24);
    const auto origin = static_cast<std::int32_t>(random() % 16777216) - 8388608;
    std::vector<float> xyz(30);
    for (float& x : xyz) {
      // Numbers of steps have 24 bits at most, like floats.
      const auto steps =
          std::clamp(origin + static_cast<std::int32_t>(random() % width), -16777215, 16777215);
      x = std::ldexp(static_cast<float>(steps), log2_step);
    }
    Points points(xyz);
    const auto grid = own_grid(points);
    ASSERT_TRUE(grid);
    EXPECT_GE(grid->grid.log2_step, log2_step);
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      EXPECT_EQ(restored(*grid, i % 3, xyz[i]), xyz[i]) << i;
    }
  }
}

TEST(LosslessGrid, NamesTheCoordinateThatNeedsAFinerGrid) {
  Points wide({1.0F, 0x1p-24F, 0.0F, 0.0F, 0.0F, 1.0F});
  const auto error = own_grid(wide);
  ASSERT_FALSE(error);
  EXPECT_NE(error.error().message.find("frame 0 (from 0), vertex 0: y is 5.9604645e-08"),
            std::string::npos)
      << error.error().message;
  EXPECT_NE(error.error().message.find("'target = lossless, target_value = BITS'"),
            std::string::npos);
  Points narrow({1.0F, 0x1p-23F, 0.0F, 0.0F, 0.0F, 0.5F});
  EXPECT_EQ(own_grid(narrow)->position_bits, 24);
  // The box is small, but too far from the origin.
  Points far({0x1p27F, 1.0F, 0.0F, 0x1p27F, 0.0F, 0.0F});
  EXPECT_FALSE(own_grid(far));
}

TEST(LosslessGrid, OfBitsIsTheFinestThatFits) {
  for (unsigned seed = 1; seed <= 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    const double size = std::ldexp(1.0, static_cast<int>(random() % 120) - 60);
    const double offset = random() % 4 == 0 ? 1e4 * size : 0.0;
    std::vector<float> xyz(12);
    for (float& x : xyz) {
      const auto part = static_cast<double>(random() % 100000) / 1e5;
      x = static_cast<float>(size * (part - 0.5) + offset);
    }
    Points points(xyz);
    const Extent extent = *measure_extent(points);
    const int bits = kMinPositionBits + static_cast<int>(random() % 23);
    const GridChoice grid = grid_of_bits(extent, bits);
    EXPECT_LE(grid.position_bits, bits);
    const double step = std::ldexp(1.0, grid.grid.log2_step);
    double widest = 0.0;
    double farthest = 0.0;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      EXPECT_LE(std::abs(restored(grid, i % 3, xyz[i]) - xyz[i]),
                0.5 * step + std::abs(xyz[i]) * 0x1p-24);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      widest = std::max(widest, extent.max[c] - extent.min[c]);
      farthest = std::max(farthest, std::abs(extent.max[c]));
    }
    // Half the step would not do.
    EXPECT_TRUE(2.0 * widest / step > std::ldexp(1.0, bits) - 3.0 ||
                4.0 * farthest / step > kMaxGridOrigin);
  }
}

}  // namespace
}  // namespace rlpc
