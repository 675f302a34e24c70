#include "encoder/codec/rest/counterpart_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/mesh/topology.h"

namespace rlpc {
namespace {

// A smooth sheet, whose squares all have nearly the same shape.
struct Sheet {
  static constexpr std::uint32_t kSide = 40;  // vertices
  static constexpr std::uint32_t kRestStep = 24;
  static constexpr int kBits = 20;  // position_bits

  std::vector<Triangle> triangles;
  std::vector<std::int32_t> wanted;

  Sheet() {
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const double height = 200.0 * std::sin(0.05 * x) * std::sin(0.04 * y);
        wanted.insert(wanted.end(),
                      {static_cast<std::int32_t>(1000 * x), static_cast<std::int32_t>(1000 * y),
                       static_cast<std::int32_t>(height)});
        if (x + 1 == kSide || y + 1 == kSide) continue;
        const std::uint32_t v = y * kSide + x;
        triangles.push_back({v, v + 1, v + kSide + 1});
        triangles.push_back({v, v + kSide + 1, v + kSide});
      }
    }
  }
};

// Returns the number of vertices of a sheet that find a counterpart.
std::uint32_t num_found(const Sheet& sheet, bool used) {
  const Topology topology = make_topology(Sheet::kSide * Sheet::kSide, sheet.triangles);
  const OrderedMeshes meshes(topology, sheet.triangles);
  const RestOrder& order = meshes[Prediction::kLayers].rest_order();
  CounterpartSearch search(order, sheet.wanted, Sheet::kRestStep, Sheet::kBits);
  Counterparts counterparts(order);
  std::uint32_t found = 0;
  for (const std::uint32_t v : order.order()) {
    counterparts.start(v);
    if (search.find(v, counterparts)) ++found;
    counterparts.finish(false);
    search.add(v, used);
  }
  return found;
}

// Without a bound, 97 % of the vertices find candidates, hundreds each, and follow them.
TEST(CounterpartSearch, RestsAfterLongSearches) {
  const std::uint32_t found = num_found(Sheet(), true);
  EXPECT_GT(found, 0U);
  EXPECT_LT(found, Sheet::kSide * Sheet::kSide / 2);
}

TEST(CounterpartSearch, RestsLongerWhereFewAreUsed) {
  const Sheet sheet;
  const std::uint32_t found = num_found(sheet, false);
  EXPECT_GT(found, 0U);
  EXPECT_LT(found, 0.8 * num_found(sheet, true));
}

}  // namespace
}  // namespace rlpc
