#include "encoder/codec/sequence/target/quality.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "encoder/codec/metrics/surface_metrics.h"

namespace rlpc {

InputResult<std::optional<Visibility>> measure_visibility(FrameSource& source,
                                                          const Metrics& metrics) {
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  if (auto error = source.read_frame(0, xyz)) return *error;
  std::vector<double> lengths;
  double sum = 0.0;
  for (const auto& [a, b] : edges_of(source.triangles())) {
    double squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const double d = static_cast<double>(xyz[3 * std::size_t{a} + c]) -
                       static_cast<double>(xyz[3 * std::size_t{b} + c]);
      squared += d * d;
    }
    lengths.push_back(std::sqrt(squared));
    sum += lengths.back();
  }
  // Collapsed edges, and triangles with them, are invisible.
  constexpr double kCollapsed = 1e-3;  // fixed: part of the mean length, far below sight
  const double shortest = kCollapsed * sum / static_cast<double>(lengths.size());
  std::erase_if(lengths, [&](double length) { return length <= shortest; });
  if (lengths.empty()) return std::optional<Visibility>();
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::nth_element(lengths.begin(), middle, lengths.end());
  return std::optional<Visibility>({*middle, 100 * metrics.rms_error / *middle});
}

}  // namespace rlpc
