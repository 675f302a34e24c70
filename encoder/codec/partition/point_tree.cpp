#include "encoder/codec/partition/point_tree.h"

#include <algorithm>
#include <numeric>

namespace rlpc {

PointTree::PointTree(std::vector<Point3> points)
    : points_(std::move(points)), order_(points_.size()), axis_(points_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  build(0, order_.size());
}

// Divides ranges down to single points, so that the order depends on the points alone and not
// on the library's nth_element.
void PointTree::build(std::size_t begin, std::size_t end) {
  if (begin == end) return;
  Point3 low = points_[order_[begin]];
  Point3 high = low;
  for (std::size_t i = begin; i < end; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], points_[order_[i]][c]);
      high[c] = std::max(high[c], points_[order_[i]][c]);
    }
  }
  std::size_t axis = 0;
  for (std::size_t c = 1; c < 3; ++c) {
    if (high[c] - low[c] > high[axis] - low[axis]) axis = c;
  }
  const std::size_t middle = begin + (end - begin) / 2;
  const auto at = [&](std::size_t i) {
    return order_.begin() + static_cast<std::ptrdiff_t>(i);
  };
  std::nth_element(at(begin), at(middle), at(end),
                   [&](std::uint32_t a, std::uint32_t b) { return is_before(a, b, axis); });
  axis_[middle] = static_cast<std::uint8_t>(axis);
  build(begin, middle);
  build(middle + 1, end);
}

void PointTree::visit(std::size_t begin, std::size_t end, Query& query) const {
  if (begin == end) return;
  const std::size_t middle = begin + (end - begin) / 2;
  const std::uint32_t root = order_[middle];
  const std::size_t axis = axis_[middle];
  const Point3& of = points_[query.of];
  auto& found = query.found;
  if (root != query.of) {
    const double distance = squared_distance(points_[root], of);
    if (found.size() < query.count || distance < found.back().first) {
      if (found.size() == query.count) found.pop_back();
      const std::pair<double, std::uint32_t> entry{distance, root};
      found.insert(std::upper_bound(found.begin(), found.end(), entry), entry);
    }
  }
  const bool is_first = is_before(query.of, root, axis);
  const auto half = [&](bool first) {
    first ? visit(begin, middle, query) : visit(middle + 1, end, query);
  };
  half(is_first);
  const double across = of[axis] - points_[root][axis];
  // Points as distant as the last found are not looked for: there may be any number of them.
  if (found.size() < query.count || across * across < found.back().first) half(!is_first);
}

std::vector<std::uint32_t> PointTree::nearest(std::uint32_t of, std::size_t count) const {
  std::vector<std::uint32_t> points;
  if (count == 0) return points;
  Query query{of, count, {}};
  visit(0, order_.size(), query);
  for (const auto& [distance, point] : query.found) points.push_back(point);
  return points;
}

}  // namespace rlpc
