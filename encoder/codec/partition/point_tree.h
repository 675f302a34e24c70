// Finds nearest points of a set with a k-d tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace rlpc {

using Point3 = std::array<double, 3>;

inline double squared_distance(const Point3& a, const Point3& b) {
  double sum = 0.0;
  for (std::size_t c = 0; c < 3; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sum;
}

class PointTree {
 public:
  explicit PointTree(std::vector<Point3> points);

  // Returns up to `count` points nearest to point `of`, without itself, nearest first. Which of
  // several equally distant ones are found is not specified.
  std::vector<std::uint32_t> nearest(std::uint32_t of, std::size_t count) const;

 private:
  struct Query {
    std::uint32_t of;
    std::size_t count;
    std::vector<std::pair<double, std::uint32_t>> found;  // ascending
  };

  bool is_before(std::uint32_t a, std::uint32_t b, std::size_t axis) const {
    const double x = points_[a][axis];
    const double y = points_[b][axis];
    return x != y ? x < y : a < b;
  }
  void build(std::size_t begin, std::size_t end);
  void visit(std::size_t begin, std::size_t end, Query& query) const;

  std::vector<Point3> points_;
  std::vector<std::uint32_t> order_;  // the root of a range is in its middle
  std::vector<std::uint8_t> axis_;    // at the root of a range: the axis that divides it
};

}  // namespace rlpc
