#include "decoder/output/gltf/skin_joints.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rlpc {
namespace {

std::vector<std::uint32_t> keys_of_line(const std::vector<double>& values, double tolerance) {
  return needed_keys(static_cast<std::uint32_t>(values.size()),
                     [&](std::uint32_t a, std::uint32_t b) {
                       for (std::uint32_t f = a + 1; f < b; ++f) {
                         const double t = static_cast<double>(f - a) / (b - a);
                         const double x = values[a] + t * (values[b] - values[a]);
                         if (std::abs(x - values[f]) > tolerance) return false;
                       }
                       return true;
                     });
}

TEST(NeededKeys, AreTheCornersOfALine) {
  EXPECT_EQ(keys_of_line({1}, 0), (std::vector<std::uint32_t>{0}));
  EXPECT_EQ(keys_of_line({1, 2}, 0), (std::vector<std::uint32_t>{0, 1}));
  EXPECT_EQ(keys_of_line({0, 1, 2, 3, 2, 1, 0}, 1e-9), (std::vector<std::uint32_t>{0, 3, 6}));
  EXPECT_EQ(keys_of_line({0, 1, 2.4, 3}, 0.5), (std::vector<std::uint32_t>{0, 3}));
  EXPECT_EQ(keys_of_line({0, 1, 2.4, 3}, 0.1), (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

}  // namespace
}  // namespace rlpc
