#include "encoder/meshes/axes_fit.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "encoder/meshes/axes.h"

namespace rlpc {

namespace {

// Rounding to the six decimals of most text formats, at sizes from 0.01.
constexpr double kRounding = 1e-4;

// Returns all axes: first those that do not mirror, beginning with axes as they are.
std::vector<Axes> make_all_axes() {
  std::vector<Axes> all;
  std::array<std::uint8_t, 3> from{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      all.push_back({from, {(signs & 1) != 0, (signs & 2) != 0, (signs & 4) != 0}});
    }
  } while (std::next_permutation(from.begin(), from.end()));
  std::stable_partition(all.begin(), all.end(), [](const Axes& a) { return !is_mirror(a); });
  return all;
}

const std::vector<Axes>& all_axes() {
  static const std::vector<Axes> kAll = make_all_axes();
  return kAll;
}

constexpr std::array<std::uint8_t, 3> kOtherUp{0, 2, 1};

using Matrix = std::array<std::array<double, 3>, 3>;

// Returns [a][b]: the sum over vertices of coordinate a in one pose times coordinate b in
// another.
Matrix products_of(std::span<const float> left, std::span<const float> right) {
  Matrix m{};
  for (std::size_t i = 0; i < left.size(); i += 3) {
    for (std::size_t a = 0; a < 3; ++a) {
      for (std::size_t b = 0; b < 3; ++b) {
        m[a][b] += static_cast<double>(left[i + a]) * static_cast<double>(right[i + b]);
      }
    }
  }
  return m;
}

double square_of(std::span<const float> pose) {
  double sum = 0.0;
  for (const float x : pose) sum += static_cast<double>(x) * static_cast<double>(x);
  return sum;
}

// Returns the positions relative to their mean.
std::vector<float> from_centre(std::span<const float> xyz) {
  std::array<double, 3> centre{};
  for (std::size_t i = 0; i < xyz.size(); ++i) centre[i % 3] += static_cast<double>(xyz[i]);
  const std::size_t num_vertices = xyz.size() / 3;
  for (double& x : centre) x /= static_cast<double>(num_vertices);
  std::vector<float> pose(xyz.size());
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    pose[i] = static_cast<float>(static_cast<double>(xyz[i]) - centre[i % 3]);
  }
  return pose;
}

// Returns the angle between poses with this product; poses without extent are at right angles
// to all.
double angle_of(double product, double left_square, double right_square) {
  const double scale = std::sqrt(left_square) * std::sqrt(right_square);
  return scale > 0.0 ? std::acos(std::clamp(product / scale, -1.0, 1.0)) : std::numbers::pi / 2;
}

}  // namespace

AxesFit::AxesFit(std::span<const float> mesh)
    : mesh_(from_centre(mesh)), mesh_square_(square_of(mesh_)) {
  assert(all_axes().size() == kNumAxes);
  nearest_.fill(std::numbers::pi);
}

void AxesFit::add_frame(std::span<const float> xyz) {
  assert(xyz.size() == mesh_.size());
  const std::vector<float> pose = from_centre(xyz);
  const double square = square_of(pose);
  const Matrix products = products_of(mesh_, pose);
  for (std::size_t k = 0; k < kNumAxes; ++k) {
    const Axes& axes = all_axes()[k];
    double product = 0.0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double term = products[a][axes.from[a]];
      product += axes.negative[a] ? -term : term;
    }
    nearest_[k] = std::min(nearest_[k], angle_of(product, mesh_square_, square));
  }
  if (first_.empty()) {
    first_ = pose;
    first_square_ = square;
  }
  const Matrix moved = products_of(first_, pose);
  const double product = moved[0][0] + moved[1][1] + moved[2][2];
  motion_ = std::max(motion_, angle_of(product, first_square_, square));
}

bool AxesFit::matches() const { return nearest_[0] <= kRounding; }

std::optional<Axes> AxesFit::axes_of_mesh() const {
  std::size_t best = 0;
  for (std::size_t k = 1; k < kNumAxes; ++k) {
    if (nearest_[k] < nearest_[best] - kRounding) best = k;
  }
  if (best == 0 || matches()) return std::nullopt;
  const double gain = nearest_[0] - nearest_[best];
  const bool is_frame = nearest_[best] <= kRounding;
  const bool is_pose = gain > motion_ && gain > nearest_[best];
  const Axes& axes = all_axes()[best];
  if (is_frame || (is_pose && axes.from == kOtherUp)) return axes;
  return std::nullopt;
}

}  // namespace rlpc
