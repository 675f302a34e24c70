#include "encoder/codec/partition/partition.h"

#include <algorithm>
#include <cassert>

#include "encoder/codec/partition/kway.h"
#include "encoder/codec/partition/lloyd.h"
#include "encoder/codec/partition/mesh_graph.h"
#include "encoder/codec/partition/motion.h"
#include "encoder/codec/partition/point_tree.h"
#include "encoder/codec/partition/spectral.h"

namespace rlpc {
namespace {

std::vector<Point3> first_frame(const SpanFrames& frames) {
  std::vector<Point3> points;
  points.reserve(frames.num_vertices);
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    const double* const p = frames.at(0, v);
    points.push_back({p[0], p[1], p[2]});
  }
  return points;
}

}  // namespace

Partition partition_vertices(PartitionMethod method, const SpanFrames& frames,
                             std::span<const Triangle> triangles, std::uint32_t count) {
  assert(method != PartitionMethod::kSeeds && count > 0 && count <= kMaxParts);
  const std::uint32_t max = std::min(count, frames.num_vertices);
  const std::vector<Point3> points = first_frame(frames);
  Partition partition;
  if (method == PartitionMethod::kLloyd) {
    partition = lloyd_partition(points, max);
  } else {
    const Graph graph = make_mesh_graph(points, triangles);
    if (method == PartitionMethod::kKway) partition = kway_partition(graph, max);
    if (method == PartitionMethod::kSpectral) {
      partition = spectral_partition(graph, points, triangles, max);
    }
    if (method == PartitionMethod::kMotion) {
      partition = frames.num_frames > 1 ? motion_partition(frames, graph, max)
                                        : lloyd_partition(points, max);  // nothing moves
    }
  }
  number_parts(partition);
  return partition;
}

void number_parts(Partition& partition) {
  std::vector<std::uint16_t> number(kMaxParts, kMaxParts);
  std::uint16_t next = 0;
  for (std::uint16_t& part : partition) {
    if (number[part] == kMaxParts) number[part] = next++;
    part = number[part];
  }
}

}  // namespace rlpc
