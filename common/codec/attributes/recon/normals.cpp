#include "common/codec/attributes/recon/normals.h"

#include <algorithm>
#include <numeric>

#include "common/codec/mesh/indices.h"
#include "common/memory/owned.h"

namespace rlpc {

// F.8.1 MakeFaces( )
Faces::Faces(const CornerGeometry& geometry, Diagonals diagonals,
             std::span<const std::uint32_t> edge_mates, const Vector<bool>& seams,
             const Vector<bool>& flags, bool with_normals) {
  const auto num_triangles = static_cast<std::uint32_t>(edge_mates.size() / 3);
  face_of_.resize(num_triangles);
  std::iota(face_of_.begin(), face_of_.end(), 0U);
  if (with_normals) {
    normals_.resize(num_triangles);
    for (std::uint32_t t = 0; t < num_triangles; ++t) normals_[t] = geometry.triangle_normal(t);
  }
  if (diagonals == Diagonals::kNone) return;
  Vector<std::uint8_t> size(num_triangles, 1);
  for (std::uint32_t c = 0; c < edge_mates.size(); ++c) {
    const std::uint32_t mate = edge_mates[c];
    if (mate == kNoCorner || mate > c || (!seams.empty() && seams[c])) continue;
    const bool likely = diagonals == Diagonals::kLikely && geometry.is_likely_diagonal(c, mate);
    if (flags[c] == likely) continue;
    const std::uint32_t f = root(c / 3);
    const std::uint32_t g = root(mate / 3);
    if (f == g || std::uint32_t{size[f]} + size[g] > kMaxFaceTriangles) continue;
    const auto [low, high] = std::minmax(f, g);
    size[low] = static_cast<std::uint8_t>(size[low] + size[high]);
    face_of_[high] = low;
  }
  for (std::uint32_t t = 0; t < num_triangles; ++t) {
    face_of_[t] = root(t);
    if (!with_normals || face_of_[t] == t) continue;
    for (std::size_t k = 0; k < 3; ++k) normals_[face_of_[t]][k] += normals_[t][k];
  }
}

OctahedronPoint octahedral_of(const Vec3l& normal, std::uint32_t value_bits) {
  const std::int64_t h = (std::int64_t{1} << (value_bits - 1)) - 1;
  const auto absolute = [](std::int64_t x) { return x < 0 ? -x : x; };
  const Vec3l unit = normalize3(normal);
  const std::int64_t length = absolute(unit[0]) + absolute(unit[1]) + absolute(unit[2]);
  if (length == 0) return {h, h};
  std::int64_t u = div_round(unit[0] * h, length);
  std::int64_t v = div_round(unit[1] * h, length);
  if (unit[2] < 0) {
    const std::int64_t x = h - absolute(v);
    const std::int64_t y = h - absolute(u);
    u = u < 0 ? -x : x;
    v = v < 0 ? -y : y;
  }
  return {u + h, v + h};
}

// F.8.3 SectorNormal( )
Vec3l sector_normal(const CornerGeometry& geometry, const FaceView& faces,
                    SmoothingWeight weight, std::span<const std::uint32_t> corners) {
  constexpr int kUnitShift = 15;  // from 30 fractional bits
  int area_shift = 0;
  if (weight == SmoothingWeight::kArea) {
    std::int64_t largest = 1;
    for (const std::uint32_t c : corners) {
      for (const std::int64_t x : faces.normal_at(c)) {
        largest = std::max(largest, x < 0 ? -x : x);
      }
    }
    area_shift = std::max(floor_log2(static_cast<std::uint64_t>(largest)) - 28, 0);
  }
  Vec3l sum{};
  const auto add = [&sum](const Vec3l& normal, std::int64_t factor, int shift) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += factor * round2(normal[k], shift);
  };
  if (weight == SmoothingWeight::kAngle) {
    for (const std::uint32_t c : corners) {
      add(normalize3(faces.normal_at(c)), geometry.angle_at(c), kUnitShift);
    }
    return sum;
  }
  Vector<std::uint32_t> once;
  once.reserve(corners.size());
  for (const std::uint32_t c : corners) once.push_back(faces.face_of[c / 3]);
  sort_without_repetitions(once);
  for (const std::uint32_t f : once) {
    if (weight == SmoothingWeight::kArea) {
      add(faces.normals[f], 1, area_shift);
    } else {
      add(normalize3(faces.normals[f]), 1, kUnitShift);
    }
  }
  return sum;
}

}  // namespace rlpc
