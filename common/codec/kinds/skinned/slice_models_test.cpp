#include "common/codec/kinds/skinned/slice_models.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "common/testing/residual_bound.h"

namespace rlpc {
namespace {

// Random rings, not from a mesh.
struct Rings {
  explicit Rings(std::uint32_t n) : topology(make_topology(n, {})) {
    layers.layer_of_vertex.assign(n, 0);
    layers.ring = VertexLists(n);
    layers.outer_ring = VertexLists(n);
    for (std::uint32_t v = 0; v < n; ++v) layers.layer_order.push_back(v);
  }
  OrderedMesh mesh() const { return {Prediction::kLayers, topology, layers}; }

  Topology topology;
  VertexLayers layers;
};

// The contexts of 9.8.4 literally: factor by factor, with divisions.
class TextContexts {
 public:
  TextContexts(const OrderedMesh& mesh, std::size_t num_factors)
      : mesh_(mesh),
        component_mean_(num_factors, 256),
        magnitude_(num_factors, std::vector<std::int64_t>(mesh.num_vertices(), 0)) {}

  void start() {
    latest_ = 0;
    sum_ = mean_ = 256;
  }
  std::int64_t expected(std::size_t l, std::uint32_t v) const {
    const std::int64_t ring = mean_magnitude(mesh_.ring(v), l, component_mean_[l]);
    const std::int64_t outer = mean_magnitude(mesh_.outer_ring(v), l, ring);
    return (96 * component_mean_[l] + 48 * ring + 40 * outer + 72 * latest_) / 4096;
  }
  std::size_t activity() const {
    std::size_t context = 0;
    for (const std::int64_t threshold : {8, 13, 20, 32}) {
      if (16 * (sum_ + 5) >= threshold * (mean_ + 5)) ++context;
    }
    return context;
  }
  void update(std::size_t l, std::uint32_t v, std::int64_t residual) {
    const std::int64_t magnitude = residual < 0 ? -residual : residual;
    sum_ = sum_ - sum_ / 16 + std::min<std::int64_t>(magnitude, 1048576) * 256;
    mean_ = mean_ - mean_ / 16 + component_mean_[l];
    latest_ = update_mean(static_cast<std::uint32_t>(latest_),
                          static_cast<std::uint32_t>(magnitude), 2);
    component_mean_[l] = update_mean(static_cast<std::uint32_t>(component_mean_[l]),
                                     static_cast<std::uint32_t>(magnitude), 5);
    magnitude_[l][v] = std::min<std::int64_t>(magnitude, 255);
  }

 private:
  std::int64_t mean_magnitude(std::span<const std::uint32_t> ring, std::size_t l,
                              std::int64_t otherwise) const {
    if (ring.empty()) return otherwise;
    std::int64_t sum = 0;
    for (const std::uint32_t u : ring) sum += magnitude_[l][u];
    return sum * 256 / static_cast<std::int64_t>(ring.size());
  }

  const OrderedMesh& mesh_;
  std::vector<std::int64_t> component_mean_;
  std::vector<std::vector<std::int64_t>> magnitude_;
  std::int64_t latest_ = 0;
  std::int64_t sum_ = 0;
  std::int64_t mean_ = 0;
};

TEST(VertexContexts, StartAtAMagnitudeOfOne) {
  const Rings rings(2);
  const OrderedMesh mesh = rings.mesh();
  VertexContexts contexts(mesh, 1);
  contexts.start(0);
  EXPECT_EQ(contexts.expected(), (256U * (96 + 48 + 40)) >> 12);
  EXPECT_EQ(contexts.activity(), 2U);
}

TEST(VertexContexts, DistinguishBusyFromQuietVertices) {
  const Rings rings(40);
  const OrderedMesh mesh = rings.mesh();
  VertexContexts contexts(mesh, 8);
  for (std::uint32_t v = 0; v < 38; ++v) {
    contexts.start(v);
    for (int k = 0; k < 8; ++k) contexts.update(v % 2 == 0 ? 10 : -10);
  }
  contexts.start(38);
  for (int k = 0; k < 7; ++k) contexts.update(0);
  EXPECT_EQ(contexts.activity(), 0U);
  contexts.start(39);
  for (int k = 0; k < 7; ++k) contexts.update(40);
  EXPECT_EQ(contexts.activity(), 4U);
}

TEST(VertexContexts, AgreeWithTheSpecification) {
  std::mt19937 random(1);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  std::array<int, kActivityContexts> seen{};
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t n = 2 + below(60);
    Rings rings(n);
    for (std::uint32_t v = 1; v < n; ++v) {
      std::vector<std::uint32_t> ring(below(kMaxRing + 1));
      std::vector<std::uint32_t> outer(below(2) * below(kMaxOuterRing + 1));
      for (std::uint32_t& u : ring) u = below(v);
      for (std::uint32_t& u : outer) u = below(v);
      rings.layers.ring.set(v, ring);
      rings.layers.outer_ring.set(v, outer);
    }
    const OrderedMesh mesh = rings.mesh();
    const std::size_t num_factors = 1 + below(12);
    VertexContexts contexts(mesh, num_factors);
    TextContexts text(mesh, num_factors);
    const std::uint32_t bits = below(29);
    for (std::uint32_t v = 0; v < n; ++v) {
      contexts.start(v);
      text.start();
      for (std::size_t l = 0; l < num_factors; ++l) {
        ASSERT_EQ(contexts.expected(), text.expected(l, v)) << i << " " << v << " " << l;
        ASSERT_EQ(contexts.activity(), text.activity()) << i << " " << v << " " << l;
        ++seen[contexts.activity()];
        auto residual = static_cast<std::int32_t>(below(1U << bits));
        if (below(50) == 0) residual = below(2) == 0 ? kResidualBound : 255;
        if (below(2) == 0) residual = -residual;
        contexts.update(residual);
        text.update(l, v, residual);
      }
    }
  }
  for (const int count : seen) EXPECT_GT(count, 0);
}

// The largest residuals throughout: means and sums stay within their stated widths.
TEST(VertexContexts, SupportTheLargestResiduals) {
  Rings rings(30);
  for (std::uint32_t v = 7; v < 30; ++v) {
    rings.layers.ring.set(v, std::vector<std::uint32_t>{v - 1, v - 2, v - 3, v - 7});
    rings.layers.outer_ring.set(v, std::vector<std::uint32_t>{v - 4, v - 5});
  }
  const OrderedMesh mesh = rings.mesh();
  VertexContexts contexts(mesh, 300);
  TextContexts text(mesh, 300);
  for (std::uint32_t v = 0; v < 30; ++v) {
    contexts.start(v);
    text.start();
    for (std::size_t l = 0; l < 300; ++l) {
      ASSERT_EQ(contexts.expected(), text.expected(l, v)) << v << " " << l;
      ASSERT_EQ(contexts.activity(), text.activity()) << v << " " << l;
      contexts.update(v < 28 ? -kResidualBound : 0);
      text.update(l, v, v < 28 ? -kResidualBound : 0);
    }
  }
}

}  // namespace
}  // namespace rlpc
