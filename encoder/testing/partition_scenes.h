// Meshes for tests of partitions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/partition/partition.h"
#include "encoder/codec/partition/point_tree.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

struct PartitionScene {
  std::vector<Point3> points;
  std::vector<Triangle> triangles;

  std::uint32_t num_vertices() const { return static_cast<std::uint32_t>(points.size()); }

  // Returns frames in which vertex v is at place(f, v).
  template <typename Place>
  SpanFrames frames(std::uint32_t num_frames, const Place& place) const {
    SpanFrames frames{num_vertices(), num_frames, {}};
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      for (std::uint32_t v = 0; v < num_vertices(); ++v) {
        const Point3 p = place(f, v);
        frames.xyz.insert(frames.xyz.end(), p.begin(), p.end());
      }
    }
    return frames;
  }
  SpanFrames still() const {
    return frames(1, [&](std::uint32_t /*f*/, std::uint32_t v) { return points[v]; });
  }

  // Adds columns x rows points in the plane z = 0, 10 apart, and the triangles between them.
  void add_grid(std::uint32_t columns, std::uint32_t rows, const Point3& corner = {}) {
    const std::uint32_t first = num_vertices();
    for (std::uint32_t y = 0; y < rows; ++y) {
      for (std::uint32_t x = 0; x < columns; ++x) {
        points.push_back({corner[0] + 10.0 * x, corner[1] + 10.0 * y, corner[2]});
        if (x == 0 || y == 0) continue;
        const std::uint32_t v = first + y * columns + x;
        triangles.push_back({v - columns - 1, v - columns, v});
        triangles.push_back({v - columns - 1, v, v - 1});
      }
    }
  }
};

inline std::vector<std::uint32_t> part_sizes(const Partition& partition) {
  std::vector<std::uint32_t> sizes;
  for (const std::uint16_t part : partition) {
    if (part >= sizes.size()) sizes.resize(part + std::size_t{1});
    ++sizes[part];
  }
  return sizes;
}

// Returns the parts of some vertices.
inline std::set<std::uint16_t> parts_of(std::span<const std::uint16_t> partition) {
  return {partition.begin(), partition.end()};
}

}  // namespace rlpc
