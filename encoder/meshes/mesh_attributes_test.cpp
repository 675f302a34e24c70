#include "encoder/meshes/mesh_attributes.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

// Streams have 16 bits for them.
TEST(TriangleAttribute, NumbersHaveALimit) {
  const std::vector<std::uint32_t> numbers{0, 65535, 65536, 1 << 20};
  const auto set = triangle_attribute("material", numbers);
  ASSERT_TRUE(set);
  EXPECT_EQ(set->domain, AttributeDomain::kTriangle);
  EXPECT_EQ(set->values, (std::vector<float>{0, 65535, 65535, 65535}));
}

TEST(TriangleAttribute, IsNoneIfAllAreEqual) {
  EXPECT_FALSE(triangle_attribute("material", std::vector<std::uint32_t>{7, 7, 7}));
}

}  // namespace
}  // namespace rlpc
