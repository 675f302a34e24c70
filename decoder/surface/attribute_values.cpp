#include "decoder/surface/attribute_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/codec/attributes/recon/normals.h"
#include "common/codec/attributes/sectors.h"
#include "common/surface/local_turn.h"

namespace rlpc {
namespace {

using Vec3 = std::array<double, 3>;

template <class Coordinate>
Vec3 difference(std::span<const Coordinate> xyz, std::uint32_t from, std::uint32_t to) {
  Vec3 v{};
  for (std::size_t c = 0; c < 3; ++c) {
    v[c] = static_cast<double>(xyz[3 * std::size_t{to} + c]) -
           static_cast<double>(xyz[3 * std::size_t{from} + c]);
  }
  return v;
}

Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Normalises a vector. Returns false if it is zero.
bool make_unit(Vec3& v) {
  const double length = std::sqrt(dot(v, v));
  if (!(length > 0.0)) return false;
  for (double& x : v) x /= length;
  return true;
}

// F.8.4: returns the vector of a point.
std::array<float, 3> unit_vector(std::uint32_t u, std::uint32_t v, std::uint32_t bits) {
  const double h = std::ldexp(1.0, static_cast<int>(bits) - 1) - 1.0;
  Vec3 n{u - h, v - h, 0.0};
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
  if (header.kind == ValueKind::kFloats) {
    float number = 0;
    std::memcpy(&number, &value, sizeof number);  // std::bit_cast, which Emscripten lacks
    return number;
  }
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

Vector<float> attribute_numbers(const AttributeSet& set) {
  Vector<float> numbers;
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

const AttributeSet* find_set(const Vector<AttributeSet>& sets, const char* name) {
  for (const AttributeSet& set : sets) {
    if (set.header.name == name) return &set;
  }
  return nullptr;
}

Vec3 unit_normal(const double* sum) {
  // Scaled by its size first: squares of very small numbers underflow.
  const double size = std::max({std::abs(sum[0]), std::abs(sum[1]), std::abs(sum[2])});
  if (!(size > 0.0)) return {0.0, 0.0, 1.0};
  Vec3 n{sum[0] / size, sum[1] / size, sum[2] / size};
  make_unit(n);
  return n;
}

FrameNormals::FrameNormals(const AttributeSet& set, std::span<const Triangle> triangles,
                           std::uint32_t num_vertices)
    : set_(set), triangles_(triangles), count_(num_vertices) {
  if (!set.value_of_corner.empty()) {
    count_ = 0;
    for (const std::uint32_t x : set.value_of_corner) count_ = std::max(count_, x + 1);
  }
  sums_.resize(3 * std::size_t{count_});
  if (set.face_of_triangle.empty()) {
    const Vector<float> numbers = attribute_numbers(set);
    std::copy(numbers.begin(), numbers.end(), sums_.begin());
    return;
  }
  if (!set.first_positions.empty()) {
    keep_first();
    find_followers();
    find_turning_vertices();
    if (std::find(follows_.begin(), follows_.end(), 1) == follows_.end()) return;
  }
  faces_.resize(triangles.size());
  find_terms();
}

void FrameNormals::find_terms() {
  if (set_.header.weight == SmoothingWeight::kAngle) {
    for (std::uint32_t c = 0; c < 3 * triangles_.size(); ++c) {
      if (follows(normal_of_corner(c))) angles_.push_back(c);
    }
    return;
  }
  terms_.reserve(3 * triangles_.size());
  for (std::size_t c = 0; c < 3 * triangles_.size(); ++c) {
    const std::uint32_t normal = normal_of_corner(c);
    if (follows(normal)) terms_.push_back({normal, set_.face_of_triangle[c / 3]});
  }
  std::sort(terms_.begin(), terms_.end());
  terms_.erase(std::unique(terms_.begin(), terms_.end()), terms_.end());
}

// F.8.3, in floats
template <class Coordinate>
void FrameNormals::add_up(std::span<const Coordinate> xyz) {
  std::fill(faces_.begin(), faces_.end(), Vec3{});
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    if (!has_wanted_.empty() && has_wanted_[t] == 0) continue;
    const Triangle& v = triangles_[t];
    const Vec3 n = cross(difference(xyz, v[0], v[1]), difference(xyz, v[0], v[2]));
    Vec3& face = faces_[set_.face_of_triangle[t]];
    for (std::size_t c = 0; c < 3; ++c) face[c] += n[c];
  }
  std::fill(sums_.begin(), sums_.end(), 0.0);
  const auto add = [&](std::uint32_t normal, const Vec3& face, double weight) {
    for (std::size_t c = 0; c < 3; ++c) sums_[3 * std::size_t{normal} + c] += weight * face[c];
  };
  for (const auto& [normal, f] : terms_) {
    const double length = set_.header.weight == SmoothingWeight::kArea
                              ? 1.0
                              : std::sqrt(dot(faces_[f], faces_[f]));
    if (length > 0.0) add(normal, faces_[f], 1.0 / length);
  }
  for (const std::uint32_t c : angles_) {
    const Vec3& face = faces_[set_.face_of_triangle[c / 3]];
    const Triangle& t = triangles_[c / 3];
    const Vec3 a = difference(xyz, t[c % 3], t[(c + 1) % 3]);
    const Vec3 b = difference(xyz, t[c % 3], t[(c + 2) % 3]);
    const Vec3 n = cross(a, b);
    const double length = std::sqrt(dot(face, face));
    if (length > 0.0) {
      add(normal_of_corner(c), face, std::atan2(std::sqrt(dot(n, n)), dot(a, b)) / length);
    }
  }
}

void FrameNormals::keep_first() {
  first_ = attribute_numbers(set_);
  std::copy(first_.begin(), first_.end(), sums_.begin());
  const auto num_vertices = static_cast<std::uint32_t>(set_.first_positions.size() / 3);
  corners_ = sectors_of_vertices(num_vertices, triangles_).corners;
}

// Finds the unit vectors that follow the surface (F.8.5): those that F.8.3 computes from the
// first frame, and those around which that has no surface.
void FrameNormals::find_followers() {
  const std::span<const std::int32_t> first = set_.first_positions;
  const CornerGeometry geometry(triangles_, first);
  Vector<Vec3l> face_normals(triangles_.size());
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Vec3l n = geometry.triangle_normal(t);
    for (std::size_t k = 0; k < 3; ++k) face_normals[set_.face_of_triangle[t]][k] += n[k];
  }
  const FaceView faces{set_.face_of_triangle, face_normals};
  const ListOfLists<std::uint32_t> sectors =
      set_.value_of_corner.empty() ? corners_
                                   : corners_of_sectors(count_, set_.value_of_corner);
  follows_.assign(count_, 0);
  for (std::uint32_t x = 0; x < count_; ++x) {
    if (sectors[x].empty()) continue;
    const OctahedronPoint point = octahedral_of(
        sector_normal(geometry, faces, set_.header.weight, sectors[x]), set_.header.value_bits);
    const std::size_t i = 2 * std::size_t{x};
    const bool is_predicted = point[0] == set_.values[i] && point[1] == set_.values[i + 1];
    follows_[x] = is_predicted ? 1 : 0;
  }
  for (std::size_t v = 0; v < corners_.size(); ++v) {
    LocalTurn none;
    add_surroundings(triangles_, corners_[v], first, first, none);
    if (none.find()) continue;
    for (const std::uint32_t c : corners_[v]) follows_[normal_of_corner(c)] = 1;
  }
}

void FrameNormals::find_turning_vertices() {
  turning_vertices_.clear();
  for (std::uint32_t v = 0; v < corners_.size(); ++v) {
    const std::span<const std::uint32_t> corners = corners_[v];
    const bool turns = std::any_of(corners.begin(), corners.end(), [&](std::uint32_t c) {
      return !follows(normal_of_corner(c)) && is_wanted(normal_of_corner(c));
    });
    if (turns) turning_vertices_.push_back(v);
  }
}

void FrameNormals::restrict_to(Vector<std::uint8_t> wanted) {
  wanted_ = std::move(wanted);
  find_turning_vertices();
  if (faces_.empty()) return;
  terms_.erase(std::remove_if(terms_.begin(), terms_.end(),
                              [&](const auto& term) { return !is_wanted(term[0]); }),
               terms_.end());
  angles_.erase(
      std::remove_if(angles_.begin(), angles_.end(),
                     [&](std::uint32_t c) { return !is_wanted(normal_of_corner(c)); }),
      angles_.end());
  Vector<std::uint8_t> is_face(faces_.size());
  for (std::size_t c = 0; c < 3 * triangles_.size(); ++c) {
    const bool is_used = follows(normal_of_corner(c)) && is_wanted(normal_of_corner(c));
    if (is_used) is_face[set_.face_of_triangle[c / 3]] = 1;
  }
  has_wanted_.resize(triangles_.size());
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    has_wanted_[t] = is_face[set_.face_of_triangle[t]];
  }
}

template <class Coordinate>
void FrameNormals::turn_first(std::span<const Coordinate> xyz) {
  const std::span<const std::int32_t> first = set_.first_positions;
  const auto is_turned = [&](std::uint32_t c) { return !follows(normal_of_corner(c)); };
  for (const std::uint32_t v : turning_vertices_) {
    const std::span<const std::uint32_t> corners = corners_[v];
    LocalTurn turn;
    add_surroundings(triangles_, corners, first, xyz, turn);
    turn.find();
    for (const std::uint32_t c : corners) {
      if (!is_turned(c)) continue;
      const std::size_t i = 3 * std::size_t{normal_of_corner(c)};
      const Vec3 normal = turn.turned({first_[i], first_[i + 1], first_[i + 2]});
      std::copy(normal.begin(), normal.end(), &sums_[i]);
    }
  }
}

template <class Coordinate>
void FrameNormals::find_sums(std::span<const Coordinate> xyz) {
  if (!faces_.empty()) add_up(xyz);
  if (!first_.empty()) turn_first(xyz);
}

std::span<const double> FrameNormals::sums(std::span<const float> xyz) {
  find_sums(xyz);
  return sums_;
}

std::span<const double> FrameNormals::sums(std::span<const std::int32_t> positions) {
  find_sums(positions);
  return sums_;
}

void FrameNormals::compute(std::span<const float> xyz, std::span<float> normals) {
  sums(xyz);
  for (std::size_t i = 0; i < sums_.size(); i += 3) {
    if (!is_wanted(static_cast<std::uint32_t>(i / 3))) continue;
    const Vec3 n = unit_normal(&sums_[i]);
    for (std::size_t c = 0; c < 3; ++c) normals[i + c] = static_cast<float>(n[c]);
  }
}

}  // namespace rlpc
