#include "encoder/meshes/gltf/tangents.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <optional>
#include <unordered_map>
#include <vector>

#include "encoder/meshes/gltf/document/affine.h"

namespace rlpc {
namespace {

GltfVec3 vector_at(std::span<const float> values, std::size_t i) {
  return {values[i], values[i + 1], values[i + 2]};
}

GltfVec3 minus(const GltfVec3& a, const GltfVec3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double dot(const GltfVec3& a, const GltfVec3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

GltfVec3 cross(const GltfVec3& a, const GltfVec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Returns the direction of v at a right angle to a unit normal, of length 1; zero if there is
// none.
GltfVec3 along_surface(GltfVec3 v, const GltfVec3& normal) {
  const double off = dot(v, normal);
  for (std::size_t c = 0; c < 3; ++c) v[c] -= off * normal[c];
  const double length = std::sqrt(dot(v, v));
  for (double& x : v) x = length > 0.0 ? x / length : 0.0;
  return v;
}

// Directions in a triangle along the first and the second texture coordinate.
struct FaceTangent {
  GltfVec3 along{};
  GltfVec3 across{};
};

// Corners with the same position, normal, coordinates and handedness share a tangent. In glTF,
// the second coordinate points down: if it is to the left of the first, the tangent has w = -1.
struct Key {
  std::array<float, 8> values{};
  bool is_left = false;
  bool operator==(const Key&) const = default;
};

struct KeyHash {
  std::size_t operator()(const Key& key) const {
    std::uint64_t hash = key.is_left ? 1 : 0;
    for (const float x : key.values) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9E3779B97F4A7C15;
      hash ^= hash >> 29;
    }
    return static_cast<std::size_t>(hash);
  }
};

class TangentComparison {
 public:
  explicit TangentComparison(const TangentSource& source) : source_(source) {}

  TangentCount compare() {
    for (std::size_t t = 0; t < source_.triangles.size(); ++t) {
      for_corners(t, [&](std::uint32_t, const Key& key, const GltfVec3& along, double angle) {
        GltfVec3& sum = sums_[key];
        for (std::size_t c = 0; c < 3; ++c) sum[c] += angle * along[c];
      });
    }
    TangentCount count;
    for (std::size_t t = 0; t < source_.triangles.size(); ++t) {
      for_corners(t, [&](std::uint32_t v, const Key& key, const GltfVec3&, double) {
        add(v, key, sums_[key], count);
      });
    }
    return count;
  }

 private:
  std::optional<FaceTangent> tangent_of(const Triangle& t) const {
    const GltfVec3 p = vector_at(source_.positions, 3 * std::size_t{t[0]});
    const GltfVec3 a = minus(vector_at(source_.positions, 3 * std::size_t{t[1]}), p);
    const GltfVec3 b = minus(vector_at(source_.positions, 3 * std::size_t{t[2]}), p);
    const auto uv = [&](std::size_t k, std::size_t c) {
      return double{source_.uv[2 * std::size_t{t[k]} + c]} -
             source_.uv[2 * std::size_t{t[0]} + c];
    };
    const double area = uv(1, 0) * uv(2, 1) - uv(2, 0) * uv(1, 1);
    if (!(std::abs(area) > 1e-20)) return std::nullopt;
    FaceTangent tangent;
    for (std::size_t c = 0; c < 3; ++c) {
      tangent.along[c] = (a[c] * uv(2, 1) - b[c] * uv(1, 1)) / area;
      tangent.across[c] = (b[c] * uv(1, 0) - a[c] * uv(2, 0)) / area;
    }
    return tangent;
  }

  template <class Function>
  void for_corners(std::size_t triangle, const Function& function) const {
    const Triangle& t = source_.triangles[triangle];
    const auto tangent = tangent_of(t);
    if (!tangent) return;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t v = t[k];
      const GltfVec3 p = vector_at(source_.positions, 3 * std::size_t{v});
      const GltfVec3 n = vector_at(source_.normals, 3 * std::size_t{v});
      const GltfVec3 along = along_surface(tangent->along, n);
      if (dot(along, along) == 0.0) continue;
      const GltfVec3 a = along_surface(
          minus(vector_at(source_.positions, 3 * std::size_t{t[(k + 1) % 3]}), p), n);
      const GltfVec3 b = along_surface(
          minus(vector_at(source_.positions, 3 * std::size_t{t[(k + 2) % 3]}), p), n);
      const GltfVec3 c = cross(a, b);
      Key key;
      for (std::size_t i = 0; i < 3; ++i) {
        key.values[i] = source_.positions[3 * std::size_t{v} + i];
        key.values[3 + i] = source_.normals[3 * std::size_t{v} + i];
      }
      for (std::size_t i = 0; i < 2; ++i)
        key.values[6 + i] = source_.uv[2 * std::size_t{v} + i];
      key.is_left = dot(cross(n, tangent->along), tangent->across) > 0.0;
      function(v, key, along, std::atan2(std::sqrt(dot(c, c)), dot(a, b)));
    }
  }

  void add(std::uint32_t v, const Key& key, const GltfVec3& sum, TangentCount& count) const {
    const GltfVec3 n = vector_at(source_.normals, 3 * std::size_t{v});
    const GltfVec3 wanted = along_surface(sum, n);
    const GltfVec3 given = along_surface(vector_at(source_.tangents, 4 * std::size_t{v}), n);
    if (dot(wanted, wanted) == 0.0 || dot(given, given) == 0.0) return;
    ++count.corners;
    constexpr double kDegrees = 57.29577951308232;
    const GltfVec3 c = cross(wanted, given);
    const double angle = kDegrees * std::atan2(std::sqrt(dot(c, c)), dot(wanted, given));
    const bool is_left = source_.tangents[4 * std::size_t{v} + 3] < 0.0F;
    const bool is_inverted = is_left != key.is_left || angle > 90.0;
    if (is_inverted || angle > kTangentsApart) ++count.apart;
    if (is_inverted) ++count.inverted;
  }

  const TangentSource& source_;
  std::unordered_map<Key, GltfVec3, KeyHash> sums_;
};

std::string percent(std::uint64_t part, std::uint64_t all) {
  const std::uint64_t rounded = (100 * part + all / 2) / all;
  return part > 0 && rounded == 0 ? "less than 1 %" : std::to_string(rounded) + " %";
}

}  // namespace

void TangentCount::add(const TangentCount& other) {
  corners += other.corners;
  apart += other.apart;
  inverted += other.inverted;
}

TangentCount compare_tangents(const TangentSource& source) {
  return TangentComparison(source).compare();
}

std::string tangent_note(const TangentCount& count) {
  if (count.apart == 0) return "";
  std::string note =
      "the tangents that are dropped differ from those of the texture coordinates "
      "by more than " +
      std::to_string(kTangentsApart) + " degrees at " + percent(count.apart, count.corners) +
      " of the corners with normal maps or anisotropy, where relief or shine will look "
      "different";
  if (count.inverted > 0) {
    note += "; at " + percent(count.inverted, count.corners) +
            " they point the other way: dents become bumps";
  }
  return note + ". Bake normal maps for MikkTSpace, or flip them there";
}

}  // namespace rlpc
