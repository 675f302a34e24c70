#include "encoder/codec/partition/mesh_sample.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "encoder/codec/partition/mesh_graph.h"

namespace rlpc {
namespace {

// fixed: Parts of a body move differently, and the border of a region has fewer neighbours.
constexpr std::uint32_t kRegions = 3;

// Marks at most `max` vertices around the first, over edges. Where the component ends, goes on
// at the nearest one, unless half of them are marked: components had better be whole.
void grow(const Graph& graph, std::uint32_t first, std::size_t max,
          std::vector<std::uint8_t>& is_in) {
  std::vector<std::uint32_t> near;    // marked
  std::vector<std::uint32_t> linked;  // of other components
  const auto mark = [&](std::uint32_t v) {
    if (is_in[v] || near.size() == max) return;
    is_in[v] = 1;
    near.push_back(v);
  };
  mark(first);
  std::size_t next_near = 0;
  for (std::size_t next_linked = 0; near.size() < max;) {
    if (next_near < near.size()) {
      const std::uint32_t v = near[next_near++];
      for (std::uint32_t i = graph.first[v]; i < graph.first[v + 1]; ++i) {
        const std::uint32_t u = graph.neighbour[i];
        if (graph.edge_weight[i] < kMeshEdge) {
          linked.push_back(u);
        } else {
          mark(u);
        }
      }
    } else if (next_linked < linked.size() && near.size() < max / 2) {
      mark(linked[next_linked++]);
    } else {
      break;
    }
  }
}

// Marks at most `max` vertices, in kRegions of about equal size.
std::vector<std::uint8_t> mark_regions(const Graph& graph, std::uint32_t max) {
  const std::uint32_t num_vertices = graph.num_vertices();
  std::vector<std::uint8_t> is_in(num_vertices, 0);
  if (max == num_vertices) return std::vector<std::uint8_t>(num_vertices, 1);
  for (std::uint32_t region = 0; region < kRegions; ++region) {
    const std::uint32_t part = max * (region + 1) / kRegions - max * region / kRegions;
    auto start = static_cast<std::uint32_t>((2 * std::uint64_t{region} + 1) * num_vertices /
                                            (2 * std::uint64_t{kRegions}));
    while (part > 0 && is_in[start]) start = (start + 1) % num_vertices;
    grow(graph, start, part, is_in);
  }
  return is_in;
}

}  // namespace

MeshSample sample_mesh(const SpanFrames& frames, std::span<const Triangle> triangles,
                       std::uint32_t max) {
  std::vector<Point3> points(frames.num_vertices);
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    std::copy_n(frames.at(0, v), 3, points[v].begin());
  }
  const std::vector<std::uint8_t> is_in =
      mark_regions(make_mesh_graph(points, triangles), std::min(max, frames.num_vertices));
  MeshSample sample;
  std::vector<std::uint32_t> place(frames.num_vertices, 0);
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    if (!is_in[v]) continue;
    place[v] = static_cast<std::uint32_t>(sample.vertices.size());
    sample.vertices.push_back(v);
  }
  for (const Triangle& t : triangles) {
    if (!is_in[t[0]] || !is_in[t[1]] || !is_in[t[2]]) continue;
    sample.triangles.push_back({place[t[0]], place[t[1]], place[t[2]]});
  }
  return sample;
}

SpanFrames MeshSample::frames_of(const SpanFrames& span, const FrameRange& some) const {
  SpanFrames part{static_cast<std::uint32_t>(vertices.size()),
                  some.count,
                  {},
                  span.first_frame + some.first,
                  1};
  part.xyz.reserve(std::size_t{3} * part.num_vertices * part.num_frames);
  for (std::uint32_t f = some.first; f < some.first + some.count; ++f) {
    for (const std::uint32_t v : vertices) {
      const double* const xyz = span.at(f, v);
      part.xyz.insert(part.xyz.end(), xyz, xyz + 3);
    }
  }
  return part;
}

}  // namespace rlpc
