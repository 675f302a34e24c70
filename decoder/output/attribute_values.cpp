#include "decoder/output/attribute_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <utility>

namespace rlpc {
namespace {

using Vector = std::array<double, 3>;

Vector difference(std::span<const float> xyz, std::uint32_t from, std::uint32_t to) {
  Vector v{};
  for (std::size_t c = 0; c < 3; ++c) {
    v[c] = double{xyz[3 * std::size_t{to} + c]} - xyz[3 * std::size_t{from} + c];
  }
  return v;
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// F.8.4: the vector of a point.
std::array<float, 3> unit_vector(std::uint32_t u, std::uint32_t v, std::uint32_t bits) {
  const double h = std::ldexp(1.0, static_cast<int>(bits) - 1) - 1.0;
  Vector n{u - h, v - h, 0.0};
  n[2] = h - std::abs(n[0]) - std::abs(n[1]);
  if (n[2] < 0.0) {
    const double fold = n[2];
    for (std::size_t c = 0; c < 2; ++c) n[c] += n[c] < 0.0 ? -fold : fold;
  }
  const double length = std::sqrt(dot(n, n));
  return {static_cast<float>(n[0] / length), static_cast<float>(n[1] / length),
          static_cast<float>(n[2] / length)};
}

float number_of(const AttributeHeader& header, std::uint32_t value, std::uint32_t c) {
  if (header.kind == ValueKind::kFloats) return std::bit_cast<float>(value);
  switch (header.scale) {
    case ValueScale::kNone:
      break;
    case ValueScale::kGrid:
      return static_cast<float>(
          std::ldexp(static_cast<double>(value) + header.origin[c], header.log2_step));
    case ValueScale::kNormalised:
      return static_cast<float>(static_cast<double>(value) /
                                static_cast<double>(header.max_value()));
  }
  return static_cast<float>(value);
}

}  // namespace

std::uint32_t number_components(const AttributeHeader& header) {
  return header.kind == ValueKind::kUnitVectors ? 3 : header.num_components;
}

std::vector<float> attribute_numbers(const AttributeSet& set) {
  std::vector<float> numbers;
  const std::uint32_t n = set.header.num_components;
  if (set.header.kind == ValueKind::kUnitVectors) {
    for (std::size_t i = 0; i < set.values.size(); i += 2) {
      const auto v = unit_vector(set.values[i], set.values[i + 1], set.header.value_bits);
      numbers.insert(numbers.end(), v.begin(), v.end());
    }
    return numbers;
  }
  numbers.reserve(set.values.size());
  for (std::size_t i = 0; i < set.values.size(); ++i) {
    numbers.push_back(number_of(set.header, set.values[i], static_cast<std::uint32_t>(i % n)));
  }
  return numbers;
}

const AttributeSet* find_set(const std::vector<AttributeSet>& sets, const char* name) {
  for (const AttributeSet& set : sets) {
    if (set.header.name == name) return &set;
  }
  return nullptr;
}

FrameNormals::FrameNormals(const AttributeSet& set, std::span<const Triangle> triangles,
                           std::uint32_t num_vertices)
    : set_(set), triangles_(triangles), count_(num_vertices) {
  if (set.value_of_corner.empty()) return;
  count_ = 0;
  for (const std::uint32_t x : set.value_of_corner) count_ = std::max(count_, x + 1);
}

// F.8.3, in floats
void FrameNormals::compute(std::span<const float> xyz, std::span<float> normals) const {
  if (set_.face_of_triangle.empty()) {
    const std::vector<float> numbers = attribute_numbers(set_);
    std::copy(numbers.begin(), numbers.end(), normals.begin());
    return;
  }
  std::vector<Vector> faces(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& v = triangles_[t];
    const Vector n = cross(difference(xyz, v[0], v[1]), difference(xyz, v[0], v[2]));
    Vector& face = faces[set_.face_of_triangle[t]];
    for (std::size_t c = 0; c < 3; ++c) face[c] += n[c];
  }
  std::vector<Vector> sums(count_);
  // Of the faces at a normal, each counts once unless angles are the weights.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> terms;  // normal, face
  const bool by_angle = set_.header.weight == SmoothingWeight::kAngle;
  if (!by_angle) terms.reserve(3 * triangles_.size());
  const auto add = [&](std::uint32_t normal, const Vector& face, double weight) {
    for (std::size_t c = 0; c < 3; ++c) sums[normal][c] += weight * face[c];
  };
  for (std::size_t c = 0; c < 3 * triangles_.size(); ++c) {
    const std::uint32_t face = set_.face_of_triangle[c / 3];
    if (!by_angle) {
      terms.emplace_back(of_corner(c), face);
      continue;
    }
    const Triangle& t = triangles_[c / 3];
    const Vector a = difference(xyz, t[c % 3], t[(c + 1) % 3]);
    const Vector b = difference(xyz, t[c % 3], t[(c + 2) % 3]);
    const Vector n = cross(a, b);
    const double length = std::sqrt(dot(faces[face], faces[face]));
    if (length > 0.0) {
      add(of_corner(c), faces[face], std::atan2(std::sqrt(dot(n, n)), dot(a, b)) / length);
    }
  }
  std::sort(terms.begin(), terms.end());
  terms.erase(std::unique(terms.begin(), terms.end()), terms.end());
  for (const auto& [normal, face] : terms) {
    const double length = set_.header.weight == SmoothingWeight::kArea
                              ? 1.0
                              : std::sqrt(dot(faces[face], faces[face]));
    if (length > 0.0) add(normal, faces[face], 1.0 / length);
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = std::sqrt(dot(sums[i], sums[i]));
    for (std::size_t c = 0; c < 3; ++c) {
      normals[3 * i + c] =
          length > 0.0 ? static_cast<float>(sums[i][c] / length) : (c == 2 ? 1.0F : 0.0F);
    }
  }
}

}  // namespace rlpc
