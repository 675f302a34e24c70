#include "encoder/meshes/polygons/polygon.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "encoder/meshes/polygons/point_grid.h"

namespace rlpc {

namespace {

using Vec3 = std::array<double, 3>;

Vec3 minus(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
Vec3 scaled(const Vec3& a, double factor) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}

// Returns twice the area of a triangle, negative if it turns clockwise.
double turn(const Point2& a, const Point2& b, const Point2& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

// The polygon in the plane of its mean normal, counter-clockwise.
struct FlatPolygon {
  std::vector<Point2> corners;
  double twice_area = 0.0;
  double near_zero = 0.0;  // twice the area of triangles that are only a line
};

// Projects a polygon; none: it has no area.
std::optional<FlatPolygon> flatten(std::span<const Vec3> corners) {
  Vec3 normal{};
  double largest = 0.0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Vec3 a = minus(corners[i], corners[0]);
    for (const double x : a) largest = std::max(largest, std::abs(x));
    if (i + 1 == corners.size()) break;
    const Vec3 n = cross(a, minus(corners[i + 1], corners[0]));
    for (std::size_t c = 0; c < 3; ++c) normal[c] += n[c];
  }
  FlatPolygon flat;
  flat.twice_area = std::sqrt(dot(normal, normal));
  flat.near_zero = 0x1p-46 * largest * largest;
  if (!(flat.twice_area > flat.near_zero)) return std::nullopt;
  normal = scaled(normal, 1.0 / flat.twice_area);
  const auto is_less = [](double a, double b) { return std::abs(a) < std::abs(b); };
  const auto axis = std::min_element(normal.begin(), normal.end(), is_less) - normal.begin();
  Vec3 other{};
  other[static_cast<std::size_t>(axis)] = 1.0;
  Vec3 u = cross(other, normal);
  u = scaled(u, 1.0 / std::sqrt(dot(u, u)));
  const Vec3 v = cross(normal, u);
  for (const Vec3& corner : corners) {
    const Vec3 p = minus(corner, corners[0]);
    flat.corners.push_back({dot(u, p), dot(v, p)});
  }
  return flat;
}

// Returns twice the area of triangles that are turned over.
double folded_area(const FlatPolygon& flat, std::span<const PolygonTriangle> triangles) {
  double area = 0.0;
  for (const PolygonTriangle& t : triangles) {
    area -= std::min(0.0, turn(flat.corners[t[0]], flat.corners[t[1]], flat.corners[t[2]]));
  }
  return area;
}

std::vector<PolygonTriangle> fan_of(std::size_t num_corners) {
  std::vector<PolygonTriangle> fan;
  for (std::uint32_t i = 1; i + 1 < num_corners; ++i) fan.push_back({0, i, i + 1});
  return fan;
}

// Cuts off corners, one after the other, whose triangles lie inside the rest of the polygon.
class EarClipper {
 public:
  explicit EarClipper(const FlatPolygon& flat)
      : corners_(flat.corners), near_zero_(flat.near_zero), grid_(flat.corners) {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    for (std::uint32_t i = 0; i < n; ++i) {
      previous_.push_back(i == 0 ? n - 1 : i - 1);
      next_.push_back(i + 1 == n ? 0 : i + 1);
    }
    is_left_.assign(n, true);
    constexpr std::uint64_t kComparisons = std::uint64_t{1} << 26;  // fixed: time
    max_comparisons_ = std::max(kComparisons, 64 * std::uint64_t{n});
  }

  // Whether clip() ran out of comparisons.
  bool gave_up() const { return comparisons_ > max_comparisons_; }

  std::vector<PolygonTriangle> clip() {
    const auto n = static_cast<std::uint32_t>(corners_.size());
    std::vector<std::uint32_t> untested;
    for (std::uint32_t i = n; i > 0; --i) untested.push_back(i - 1);
    std::uint32_t place = 0;
    while (triangles_.size() + 3 < n && comparisons_ <= max_comparisons_) {
      std::optional<std::uint32_t> ear;
      if (!untested.empty()) {
        const std::uint32_t candidate = untested.back();
        untested.pop_back();
        if (!is_left_[candidate] || !is_ear(candidate, false)) continue;
        ear = candidate;
      } else {
        ear = find_ear(place);
        if (!ear) break;
      }
      place = next_[*ear];
      // Continuing after the next corner makes fewer thin triangles.
      untested.push_back(previous_[*ear]);
      untested.push_back(place);
      cut(*ear);
    }
    finish(place);
    return std::move(triangles_);
  }

 private:
  double turn_of(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return turn(corners_[a], corners_[b], corners_[c]);
  }
  bool is_left_turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return turn_of(a, b, c) > near_zero_;
  }
  bool is_right_turn(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return turn_of(a, b, c) < -near_zero_;
  }
  bool is_convex(std::uint32_t b) const { return is_left_turn(previous_[b], b, next_[b]); }
  bool coincide(std::uint32_t a, std::uint32_t b) const { return corners_[a] == corners_[b]; }

  void cut(std::uint32_t b) {
    triangles_.push_back({previous_[b], b, next_[b]});
    next_[previous_[b]] = next_[b];
    previous_[next_[b]] = previous_[b];
    is_left_[b] = false;
  }

  // Whether the triangle at b may be cut off. touching: also if another corner lies on the new
  // edge, and if the triangle is only a line to b and back.
  bool is_ear(std::uint32_t b, bool touching) {
    const std::uint32_t a = previous_[b];
    const std::uint32_t c = next_[b];
    if (!is_convex(b)) return touching && is_spike(a, b, c);
    if (is_convex(a) && is_right_turn(previous_[a], a, c)) return false;
    if (is_convex(c) && is_right_turn(c, next_[c], a)) return false;
    return !grid_.any_near(corners_[a], corners_[b], corners_[c], [&](std::uint32_t p) {
      ++comparisons_;
      if (p == a || p == b || p == c || !is_left_[p] || is_convex(p)) return false;
      return is_in_the_way(p, {a, b, c}, touching);
    });
  }

  // Whether the way there and back is the same.
  bool is_spike(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    if (is_right_turn(a, b, c)) return false;
    double along = 0.0;
    for (std::size_t k = 0; k < 2; ++k) {
      along += (corners_[a][k] - corners_[b][k]) * (corners_[c][k] - corners_[b][k]);
    }
    return along >= 0.0;
  }

  // Whether a corner that is not convex forbids a triangle.
  bool is_in_the_way(std::uint32_t p, const PolygonTriangle& t, bool touching) const {
    std::array<bool, 3> is_on_edge{};  // t[k] to t[k + 1]
    for (std::size_t k = 0; k < 3; ++k) {
      const double side = turn_of(t[k], t[(k + 1) % 3], p);
      if (side < -near_zero_) return false;
      is_on_edge[k] = side <= near_zero_;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (!coincide(p, t[k])) continue;
      const bool is_at_end = k != 1;
      return enters(p, t, k, (k + 2) % 3) ||
             (is_at_end && !touching && has_edge_to(p, t[2 - k]));
    }
    if (is_on_edge[0]) return enters(p, t, 0, 0);
    if (is_on_edge[1]) return enters(p, t, 1, 1);
    return !is_on_edge[2] || !touching || enters(p, t, 2, 2);
  }

  // Whether an edge at p leads to the inner side of both edges of a triangle.
  bool enters(std::uint32_t p, const PolygonTriangle& t, std::size_t edge,
              std::size_t other_edge) const {
    const auto is_inside = [&](std::uint32_t q) {
      return is_left_turn(t[edge], t[(edge + 1) % 3], q) &&
             is_left_turn(t[other_edge], t[(other_edge + 1) % 3], q);
    };
    return is_inside(previous_[p]) || is_inside(next_[p]);
  }

  bool has_edge_to(std::uint32_t p, std::uint32_t end) const {
    return coincide(previous_[p], end) || coincide(next_[p], end);
  }

  // Returns the first corner that may be cut off from `place` on, perhaps touching.
  std::optional<std::uint32_t> find_ear(std::uint32_t place) {
    std::uint32_t b = place;
    do {
      if (comparisons_ > max_comparisons_) return std::nullopt;
      if (is_ear(b, true)) return b;
      b = next_[b];
    } while (b != place);
    return std::nullopt;
  }

  // Cuts the rest, which crosses itself: convex corners first.
  void finish(std::uint32_t place) {
    std::size_t rejected = 0;
    while (triangles_.size() + 2 < corners_.size()) {
      const std::uint32_t next = next_[place];
      if (is_convex(place) || rejected > 4 * corners_.size()) {
        cut(place);
      } else {
        ++rejected;
      }
      place = next;
    }
  }

  const std::vector<Point2>& corners_;
  double near_zero_;
  PointGrid grid_;
  std::vector<std::uint32_t> previous_;
  std::vector<std::uint32_t> next_;
  std::vector<bool> is_left_;
  std::vector<PolygonTriangle> triangles_;
  std::uint64_t comparisons_ = 0;  // comparisons of points with triangles
  std::uint64_t max_comparisons_ = 0;
};

}  // namespace

std::vector<PolygonTriangle> split_polygon(std::span<const std::array<double, 3>> corners,
                                           bool* gave_up) {
  if (corners.size() < 4) return {};
  const auto flat = flatten(corners);
  if (!flat) return {};
  constexpr double kRounding = 0x1p-24;
  const double folded_by_fan = folded_area(*flat, fan_of(corners.size()));
  if (folded_by_fan <= kRounding * flat->twice_area) return {};
  EarClipper clipper(*flat);
  auto triangles = clipper.clip();
  const double folded = folded_area(*flat, triangles);
  if (gave_up != nullptr && clipper.gave_up() && folded > kRounding * flat->twice_area) {
    *gave_up = true;
  }
  if (folded < folded_by_fan) return triangles;
  return {};
}

}  // namespace rlpc
