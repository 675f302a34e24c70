#include "encoder/codec/kinds/skinned/quantise/spatial_left.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "encoder/codec/spans/sample_size.h"

namespace rlpc {
namespace {

void add_differences(const OrderedMesh& mesh, const ComponentsByRow& pc, std::uint32_t v,
                     std::span<float> difference, std::span<float> sum) {
  const std::size_t width = difference.size();
  const float* factors_v = pc.spatial.data() + v * width;
  std::copy(factors_v, factors_v + width, difference.begin());
  const std::span<const std::uint32_t> ring = mesh.ring(v);
  const float count = static_cast<float>(ring.size());
  for (const std::uint32_t u : ring) {
    const float* factors_u = pc.spatial.data() + u * width;
    for (std::size_t l = 0; l < width; ++l) difference[l] -= factors_u[l] / count;
  }
  for (std::size_t l = 0; l < width; ++l) sum[l] += difference[l] * difference[l];
}

}  // namespace

// Returns squared differences between a vertex and the mean of the vertices that predict it,
// averaged over the vertex and its ring, since contexts of residuals depend on residuals
// nearby.
std::vector<float> find_spatial_left(const OrderedMesh& mesh, const ComponentsByRow& pc) {
  const std::size_t width = pc.temporal.size();
  const std::uint32_t n = mesh.num_vertices();
  const std::uint32_t places = std::min(n, kProbeVertices);
  std::vector<float> left(places * width, float{});
  std::vector<float> difference(width);
  for (std::uint32_t i = 0; i < places; ++i) {
    const auto v = static_cast<std::uint32_t>(std::uint64_t{i} * n / places);
    const std::span<float> mean = std::span(left).subspan(i * width, width);
    const std::span<const std::uint32_t> ring = mesh.ring(v);
    add_differences(mesh, pc, v, difference, mean);
    for (const std::uint32_t u : ring) add_differences(mesh, pc, u, difference, mean);
    for (float& x : mean) x /= static_cast<float>(ring.size() + 1);
  }
  return left;
}

}  // namespace rlpc
