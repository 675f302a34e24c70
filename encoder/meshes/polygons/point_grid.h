// Finds points near a triangle, in a grid of cells.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace rlpc {

using Point2 = std::array<double, 2>;

class PointGrid {
 public:
  explicit PointGrid(const std::vector<Point2>& points) : smallest_(points[0]) {
    Point2 largest = points[0];
    for (const Point2& p : points) {
      for (std::size_t c = 0; c < 2; ++c) {
        smallest_[c] = std::min(smallest_[c], p[c]);
        largest[c] = std::max(largest[c], p[c]);
      }
    }
    while (width_ * width_ < points.size()) ++width_;
    for (std::size_t c = 0; c < 2; ++c) {
      const double size = largest[c] - smallest_[c];
      cells_per_unit_[c] = size > 0.0 ? static_cast<double>(width_) / size : 0.0;
    }
    // Sort the points by counting.
    first_.assign(width_ * width_ + 1, 0);
    for (const Point2& p : points) ++first_[cell_of(p) + 1];
    for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
    std::vector<std::uint32_t> place(first_.begin(), first_.end() - 1);
    points_.resize(points.size());
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      points_[place[cell_of(points[i])]++] = i;
    }
  }

  // Whether the predicate is true for the number of a point in the cells that the box of a
  // triangle touches.
  template <class Predicate>
  bool any_near(const Point2& a, const Point2& b, const Point2& c,
                Predicate&& predicate) const {
    std::array<std::size_t, 2> low{};
    std::array<std::size_t, 2> high{};
    for (std::size_t k = 0; k < 2; ++k) {
      low[k] = cell_along(k, std::min({a[k], b[k], c[k]}), -kMargin);
      high[k] = cell_along(k, std::max({a[k], b[k], c[k]}), kMargin);
    }
    for (std::size_t y = low[1]; y <= high[1]; ++y) {
      const std::size_t row = y * width_;
      for (std::uint32_t i = first_[row + low[0]]; i < first_[row + high[0] + 1]; ++i) {
        if (predicate(points_[i])) return true;
      }
    }
    return false;
  }

 private:
  // Margin in cells: rounding may put points on an edge of a triangle outside its box.
  static constexpr double kMargin = 0x1p-20;

  std::size_t cell_along(std::size_t axis, double x, double more = 0.0) const {
    const double cell = std::floor((x - smallest_[axis]) * cells_per_unit_[axis] + more);
    return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(width_ - 1)));
  }
  std::size_t cell_of(const Point2& p) const {
    return cell_along(1, p[1]) * width_ + cell_along(0, p[0]);
  }

  Point2 smallest_;
  std::size_t width_ = 1;  // cells along each axis
  Point2 cells_per_unit_{};
  std::vector<std::uint32_t> first_;   // [cell]: first of its points; then their total
  std::vector<std::uint32_t> points_;  // sorted by cell
};

}  // namespace rlpc
