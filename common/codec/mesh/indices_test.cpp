#include "common/codec/mesh/indices.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

TEST(Indices, AreSortedWithoutRepetitions) {
  std::vector<std::uint32_t> indices{5, 3, 5, 9, 0, 3};
  sort_without_repetitions(indices);
  EXPECT_EQ(indices, (std::vector<std::uint32_t>{0, 3, 5, 9}));
  indices.clear();
  sort_without_repetitions(indices);
  EXPECT_TRUE(indices.empty());
}

}  // namespace
}  // namespace rlpc
