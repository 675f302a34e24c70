// Affine maps of space, in double precision.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <vector>

namespace rlpc {

using GltfVec3 = std::array<double, 3>;
using GltfQuaternion = std::array<double, 4>;  // x, y, z, w as in glTF

// Three rows of four: row[i] . (x, y, z, 1) is coordinate i of the image.
struct Affine {
  std::array<std::array<double, 4>, 3> row{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};

  GltfVec3 operator()(const GltfVec3& p) const {
    GltfVec3 image{};
    for (std::size_t i = 0; i < 3; ++i) {
      image[i] = row[i][0] * p[0] + row[i][1] * p[1] + row[i][2] * p[2] + row[i][3];
    }
    return image;
  }
};

// Returns the composition, which applies b, then a.
inline Affine operator*(const Affine& a, const Affine& b) {
  Affine product;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      double sum = j == 3 ? a.row[i][3] : 0.0;
      for (std::size_t k = 0; k < 3; ++k) sum += a.row[i][k] * b.row[k][j];
      product.row[i][j] = sum;
    }
  }
  return product;
}

// Returns a map that scales, then rotates (unit quaternion), then translates.
inline Affine affine_of(const GltfVec3& translation, const GltfQuaternion& q,
                        const GltfVec3& scale) {
  const auto [x, y, z, w] = q;
  const std::array<GltfVec3, 3> turn{
      {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
       {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
       {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) map.row[i][j] = turn[i][j] * scale[j];
    map.row[i][3] = translation[i];
  }
  return map;
}

// Returns the map of a column-major 4 x 4 matrix, whose last row is taken as 0, 0, 0, 1.
inline Affine affine_of_columns(const std::vector<double>& columns) {
  assert(columns.size() == 16);
  Affine map;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) map.row[i][j] = columns[4 * j + i];
  }
  return map;
}

// Returns the determinant of the linear part; negative if the map mirrors.
inline double determinant(const Affine& map) {
  const auto& [a, b, c] = map.row;
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

}  // namespace rlpc
