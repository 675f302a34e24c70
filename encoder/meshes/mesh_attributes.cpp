#include "encoder/meshes/mesh_attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/codec/attributes/attribute_names.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {

namespace {

using Vec3 = std::array<float, 3>;

Vec3 unit(const std::array<double, 3>& v) {
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  if (!(length > 0.0)) return {0.0F, 0.0F, 1.0F};
  return {static_cast<float>(v[0] / length), static_cast<float>(v[1] / length),
          static_cast<float>(v[2] / length)};
}

Vec3 face_normal(std::span<const float> xyz, const Triangle& t) {
  const auto difference = [&](std::size_t to) {
    std::array<double, 3> d{};
    for (std::size_t c = 0; c < 3; ++c) {
      d[c] = double{xyz[3 * std::size_t{t[to]} + c]} - xyz[3 * std::size_t{t[0]} + c];
    }
    return d;
  };
  const auto a = difference(1);
  const auto b = difference(2);
  return unit(
      {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]});
}

// Converts from sRGB (IEC 61966-2-1).
double linear_of_srgb(double x) {
  if (x <= 0.04045) return x / 12.92;
  return det_exp2(2.4 * det_log2((x + 0.055) / 1.055));
}

SourceAttribute attribute(std::string name, std::uint32_t num_components,
                          std::vector<float> values,
                          std::vector<std::uint32_t> value_of_corner) {
  SourceAttribute set{.name = std::move(name)};
  set.domain = value_of_corner.empty() ? AttributeDomain::kVertex : AttributeDomain::kCorner;
  set.num_components = num_components;
  set.values = std::move(values);
  set.value_of_corner = std::move(value_of_corner);
  return set;
}

}  // namespace

SourceAttribute uv_attribute(std::vector<float> uv,
                             std::vector<std::uint32_t> value_of_corner) {
  const auto usual = static_cast<std::uint32_t>(uv.size() / 2);
  bool uses_usual = false;
  for (std::uint32_t& value : value_of_corner) {
    if (value != kNoValue) continue;
    value = usual;
    uses_usual = true;
  }
  if (uses_usual) uv.insert(uv.end(), {0.0F, 0.0F});
  for (std::size_t i = 1; i < uv.size(); i += 2) uv[i] = 1.0F - uv[i];
  return attribute(uv_name(0), 2, std::move(uv), std::move(value_of_corner));
}

SourceAttribute normal_attribute(std::vector<float> normals,
                                 std::vector<std::uint32_t> value_of_corner,
                                 std::span<const float> xyz,
                                 std::span<const Triangle> triangles) {
  std::vector<bool> has_length;
  for (std::size_t i = 0; i < normals.size(); i += 3) {
    has_length.push_back(normals[i] != 0.0F || normals[i + 1] != 0.0F ||
                         normals[i + 2] != 0.0F);
    const Vec3 n = unit({normals[i], normals[i + 1], normals[i + 2]});
    std::copy(n.begin(), n.end(), normals.begin() + static_cast<std::ptrdiff_t>(i));
  }
  std::uint32_t face_value = kNoValue;
  for (std::size_t c = 0; c < value_of_corner.size(); ++c) {
    if (c % 3 == 0) face_value = kNoValue;
    if (value_of_corner[c] != kNoValue && has_length[value_of_corner[c]]) continue;
    if (face_value == kNoValue) {
      face_value = static_cast<std::uint32_t>(normals.size() / 3);
      const Vec3 n = face_normal(xyz, triangles[c / 3]);
      normals.insert(normals.end(), n.begin(), n.end());
    }
    value_of_corner[c] = face_value;
  }
  SourceAttribute set =
      attribute(kNormalName, 3, std::move(normals), std::move(value_of_corner));
  set.kind = SourceAttribute::Kind::kNormals;
  return set;
}

SourceAttribute colour_attribute(std::vector<float> values, std::uint32_t num_components,
                                 bool are_bytes, std::vector<std::uint32_t> value_of_corner) {
  // The darkest colours of sRGB are 1/3295 apart, so 12 bits distinguish them.
  constexpr std::uint32_t kSteps = 4095;
  for (std::size_t i = 0; i < values.size(); ++i) {
    double value = values[i];
    if (i % num_components < 3) value = linear_of_srgb(value);
    values[i] = are_bytes ? static_cast<float>(round_to_int(value * kSteps))
                          : static_cast<float>(value);
  }
  SourceAttribute set =
      attribute(colour_name(0), num_components, std::move(values), std::move(value_of_corner));
  if (are_bytes) {
    set.kind = SourceAttribute::Kind::kIntegers;
    set.max_value = kSteps;
  }
  return set;
}

bool are_colours(std::span<const float> values) {
  return std::all_of(values.begin(), values.end(),
                     [](float x) { return x >= 0.0F && x <= 1.0F; });
}

std::optional<SourceAttribute> triangle_attribute(const std::string& name,
                                                  std::span<const std::uint32_t> numbers) {
  constexpr std::uint32_t kMax = 65535;
  const auto is_first = [&](std::uint32_t n) { return n == numbers[0]; };
  if (std::all_of(numbers.begin(), numbers.end(), is_first)) return std::nullopt;
  SourceAttribute set{.name = name};
  set.domain = AttributeDomain::kTriangle;
  set.kind = SourceAttribute::Kind::kIntegers;
  set.values.reserve(numbers.size());
  for (const std::uint32_t n : numbers) {
    set.values.push_back(static_cast<float>(std::min(n, kMax)));
  }
  return set;
}

}  // namespace rlpc
