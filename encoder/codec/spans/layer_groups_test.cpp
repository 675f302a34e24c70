#include "encoder/codec/spans/layer_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/testing/tube.h"

namespace rlpc {
namespace {

class LayerGroups : public testing::Test {
 protected:
  std::uint32_t vertices_before(const std::vector<std::uint32_t>& sizes,
                                std::size_t group) const {
    const std::uint32_t end =
        std::accumulate(sizes.begin(), sizes.begin() + static_cast<std::ptrdiff_t>(group), 0U);
    return static_cast<std::uint32_t>(mesh_.vertices_of_layers(0, end).size());
  }

  const std::vector<Triangle> triangles_ = tube_triangles(40, 25);
  const Topology topology_ = make_topology(40 * 25, triangles_);
  const OrderedMeshes meshes_{topology_, triangles_};
  const OrderedMesh& mesh_ = meshes_[Prediction::kLayers];
};

TEST_F(LayerGroups, AreAsManyAsAskedForButAtMostOnePerLayer) {
  ASSERT_GT(mesh_.num_layers(), 8U);
  for (std::size_t asked = 1; asked < mesh_.num_layers() + 3; ++asked) {
    const std::vector<std::uint32_t> sizes = layer_group_sizes(mesh_, asked);
    EXPECT_EQ(sizes.size(), std::min<std::size_t>(asked, mesh_.num_layers()));
    EXPECT_EQ(std::accumulate(sizes.begin(), sizes.end(), 0U), mesh_.num_layers());
    EXPECT_EQ(std::count(sizes.begin(), sizes.end(), 0U), 0);
  }
}

// Each layer has at least a sixteenth of the vertices up to its end, and here at most a third.
TEST_F(LayerGroups, GrowFromAnEighthOfTheMesh) {
  for (const std::size_t count : {2U, 3U, 4U}) {
    const std::vector<std::uint32_t> sizes = layer_group_sizes(mesh_, count);
    for (std::size_t i = 1; i < count; ++i) {
      const double left = static_cast<double>(count - i) / static_cast<double>(count - 1);
      const double wanted = mesh_.num_vertices() * std::pow(8.0, -left);
      EXPECT_NEAR(vertices_before(sizes, i) / wanted, 1.0, 0.25) << count << ' ' << i;
    }
  }
}

TEST_F(LayerGroups, EndAtTheLayersNearestToTheCuts) {
  const std::vector<std::uint32_t> cuts{60, 200, 500};
  const std::vector<std::uint32_t> sizes = layer_group_sizes(mesh_, 4, cuts);
  ASSERT_EQ(sizes.size(), 4U);
  for (std::size_t i = 0; i < cuts.size(); ++i) {
    const auto distance = [&](std::uint32_t vertices) {
      return std::abs(std::log(static_cast<double>(vertices) / cuts[i]));
    };
    for (std::uint32_t l = 1; l < mesh_.num_layers(); ++l) {
      const auto other = static_cast<std::uint32_t>(mesh_.vertices_of_layers(0, l).size());
      EXPECT_LE(distance(vertices_before(sizes, i + 1)), distance(other)) << i << ' ' << l;
    }
  }
  // Cuts at the same layer move apart.
  const std::vector<std::uint32_t> crowded{998, 999, 1000};
  EXPECT_EQ(layer_group_sizes(mesh_, 4, crowded).size(), 4U);
  EXPECT_EQ(layer_group_sizes(mesh_, 4, std::vector<std::uint32_t>{1, 2, 3}).size(), 4U);
}

}  // namespace
}  // namespace rlpc
