// Connected regions of a mesh that stand for all of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/spans/frame_range.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

struct MeshSample {
  std::vector<std::uint32_t> vertices;  // ascending
  std::vector<Triangle> triangles;      // those between them, by place in `vertices`

  // Returns the positions of the sample in some frames of a span.
  SpanFrames frames_of(const SpanFrames& span, const FrameRange& some) const;
};

// fixed: Regions of fewer vertices have no inside.
inline constexpr std::uint32_t kSmallestSample = 300;

// Returns the number of vertices to sample: `limit`, but no more than half of the mesh, and no
// fewer than kSmallestSample.
inline std::uint32_t sample_size(std::uint32_t num_vertices, std::uint32_t limit) {
  return std::max(std::min(limit, num_vertices / 2), kSmallestSample);
}

// Takes regions of about equal size, each grown over edges around a vertex. The vertices are
// spread evenly over the decoded order, which follows the surface. Where a component of the
// mesh ends, a small region goes on at the nearest other one. Takes O(n log n) time.
//
//   frames     of the whole mesh; their first is read
//   triangles  of the whole mesh; none: a point cloud
//   max        maximum number of vertices, 1 or more; a mesh that is not larger is taken whole
MeshSample sample_mesh(const SpanFrames& frames, std::span<const Triangle> triangles,
                       std::uint32_t max);

}  // namespace rlpc
