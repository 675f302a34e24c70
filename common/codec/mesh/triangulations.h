// 8.9.4 Triangulations of a polygon: the ring of a vertex that is removed from a mesh.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/codec/mesh/vertex_layers.h"

namespace rlpc {

// Set of edges between positions in a ring.
using EdgeSet = std::uint64_t;

constexpr EdgeSet edge(std::size_t i, std::size_t j) {
  return EdgeSet{1} << (kMaxRing * std::min(i, j) + std::max(i, j));
}

struct Triangulation {
  std::size_t num_triangles = 0;
  std::array<std::array<std::uint8_t, 3>, kMaxRing - 2> triangles{};  // positions in the ring
  std::array<std::uint8_t, kMaxRing> corners{};  // number of triangles at a position
  EdgeSet edges = 0;

  constexpr void add(std::size_t i, std::size_t k, std::size_t j) {
    triangles[num_triangles++] = {static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(k),
                                  static_cast<std::uint8_t>(j)};
    for (const std::size_t place : {i, k, j}) ++corners[place];
    edges |= edge(i, k) | edge(k, j) | edge(i, j);
  }
  constexpr void add_shifted(const Triangulation& other, std::size_t shift) {
    for (std::size_t t = 0; t < other.num_triangles; ++t) {
      const auto& [i, k, j] = other.triangles[t];
      add(i + shift, k + shift, j + shift);
    }
  }
};

struct TriangulationList {
  std::size_t size = 0;
  std::array<Triangulation, 42> items{};
};

// 8.9.4 Triangulations of a polygon: returns [n], the triangulations of polygons with n
// corners.
constexpr std::array<TriangulationList, kMaxRing + 1> triangulate_all() {
  std::array<TriangulationList, kMaxRing + 1> all{};
  all[2].size = 1;
  for (std::size_t n = 3; n <= kMaxRing; ++n) {
    for (std::size_t k = 1; k + 1 < n; ++k) {
      const TriangulationList& lefts = all[k + 1];
      const TriangulationList& rights = all[n - k];
      for (std::size_t left = 0; left < lefts.size; ++left) {
        for (std::size_t right = 0; right < rights.size; ++right) {
          Triangulation& both = all[n].items[all[n].size++];
          both = lefts.items[left];
          both.add_shifted(rights.items[right], k);
          both.add(0, k, n - 1);
        }
      }
    }
  }
  return all;
}
static_assert(triangulate_all()[6].size == 14 && triangulate_all()[7].size == 42);

// Returns the triangulations, made when they are first needed: a constant takes 13 kB.
inline const std::array<TriangulationList, kMaxRing + 1>& triangulations() {
  static const std::array<TriangulationList, kMaxRing + 1> kAll = triangulate_all();
  return kAll;
}

}  // namespace rlpc
