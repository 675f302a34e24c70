#include "encoder/codec/spans/layer_groups.h"

#include <algorithm>
#include <cmath>

#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

// Share of the vertices that the first group has.
// fixed: Without the others, a stream is about an eighth; less would hardly be worth a cut.
constexpr double kShareOfBase = 1.0 / 8.0;

std::vector<double> equal_factors(double num_vertices, std::size_t num_groups) {
  std::vector<double> wanted;
  for (std::size_t i = 0; i + 1 < num_groups; ++i) {
    const double left = static_cast<double>(num_groups - 1 - i);
    const double octaves = det_log2(kShareOfBase) * left / static_cast<double>(num_groups - 1);
    wanted.push_back(num_vertices * det_exp2(octaves));
  }
  return wanted;
}

}  // namespace

std::vector<std::uint32_t> layer_group_sizes(const OrderedMesh& mesh, std::size_t num_groups,
                                             std::span<const std::uint32_t> cuts) {
  const std::uint32_t num_layers = mesh.num_layers();
  std::vector<double> wanted(cuts.begin(), cuts.end());
  num_groups = std::min<std::size_t>(cuts.empty() ? num_groups : cuts.size() + 1, num_layers);
  if (cuts.empty()) wanted = equal_factors(mesh.num_vertices(), num_groups);
  std::vector<std::uint32_t> sizes(num_groups);
  std::uint32_t end = num_layers;
  // Each group leaves a layer to each of those before it.
  for (std::size_t i = num_groups; i-- > 0;) {
    std::uint32_t first = end;
    double lowest_distance = HUGE_VAL;
    for (auto l = static_cast<std::uint32_t>(i); i > 0 && l < end; ++l) {
      const auto below = static_cast<double>(mesh.vertices_of_layers(0, l).size());
      const double distance = std::abs(det_log2(below / wanted[i - 1]));
      if (distance >= lowest_distance) continue;
      lowest_distance = distance;
      first = l;
    }
    if (i == 0) first = 0;
    sizes[i] = end - first;
    end = first;
  }
  return sizes;
}

}  // namespace rlpc
