#include "encoder/codec/write/half_edges.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace rlpc {
namespace {

struct EdgeEntry {
  std::uint32_t far_end;  // the larger of the two vertex indices
  std::uint32_t half_edge;
};

std::uint32_t corner_vertex(std::span<const Triangle> triangles, std::uint32_t c) {
  return triangles[c / 3][c % 3];
}

// Glues the half-edges of one edge in ascending order of their numbers.
void glue_edge(std::span<const Triangle> triangles, std::span<const EdgeEntry> edge,
               std::vector<std::uint32_t>& opposite) {
  const auto runs_up = [&](const EdgeEntry& e) {
    return corner_vertex(triangles, e.half_edge) < e.far_end;
  };
  std::size_t up = 0;
  std::size_t down = 0;
  for (;;) {
    while (up < edge.size() && !runs_up(edge[up])) ++up;
    while (down < edge.size() && runs_up(edge[down])) ++down;
    if (up == edge.size() || down == edge.size()) return;
    opposite[edge[up].half_edge] = edge[down].half_edge;
    opposite[edge[down].half_edge] = edge[up].half_edge;
    ++up;
    ++down;
  }
}

// Sorts edges by their smaller vertex index (counting sort), then the few edges of each vertex
// by the larger.
void glue_all(std::uint32_t num_vertices, std::span<const Triangle> triangles,
              std::vector<std::uint32_t>& opposite) {
  const auto num_corners = static_cast<std::uint32_t>(3 * triangles.size());
  std::vector<std::uint32_t> first(std::size_t{num_vertices} + 1);
  const auto near_end = [&](std::uint32_t h) {
    return std::min(corner_vertex(triangles, h), corner_vertex(triangles, next_corner(h)));
  };
  for (std::uint32_t h = 0; h < num_corners; ++h) ++first[near_end(h)];
  std::uint32_t sum = 0;
  for (std::uint32_t& f : first) sum += std::exchange(f, sum);
  std::vector<EdgeEntry> entries(num_corners);
  for (std::uint32_t h = 0; h < num_corners; ++h) {
    const std::uint32_t far_end =
        std::max(corner_vertex(triangles, h), corner_vertex(triangles, next_corner(h)));
    entries[first[near_end(h)]++] = {far_end, h};
  }
  // first[v] is now the end of the entries of v.
  std::size_t begin = 0;
  for (std::uint32_t v = 0; v < num_vertices; ++v) {
    const std::span<EdgeEntry> vertex_entries(entries.data() + begin, first[v] - begin);
    begin = first[v];
    std::sort(vertex_entries.begin(), vertex_entries.end(),
              [](const EdgeEntry& a, const EdgeEntry& b) {
                return a.far_end != b.far_end ? a.far_end < b.far_end
                                              : a.half_edge < b.half_edge;
              });
    for (std::size_t i = 0; i < vertex_entries.size();) {
      std::size_t end = i + 1;
      while (end < vertex_entries.size() &&
             vertex_entries[end].far_end == vertex_entries[i].far_end)
        ++end;
      glue_edge(triangles, vertex_entries.subspan(i, end - i), opposite);
      i = end;
    }
  }
}

}  // namespace

HalfEdges build_half_edges(std::uint32_t num_vertices, std::span<const Triangle> triangles) {
  assert(triangles.size() < HalfEdges::kNone / 3);
  const auto num_corners = static_cast<std::uint32_t>(3 * triangles.size());
  HalfEdges mesh;
  mesh.opposite.assign(num_corners, HalfEdges::kNone);
  glue_all(num_vertices, triangles, mesh.opposite);

  mesh.instance.assign(num_corners, HalfEdges::kNone);
  for (std::uint32_t c = 0; c < num_corners; ++c) {
    if (mesh.instance[c] != HalfEdges::kNone) continue;
    const std::uint32_t id = mesh.num_instances++;
    std::uint32_t h = c;
    do {
      mesh.instance[h] = id;
      h = turn_left(mesh, h);
    } while (h != HalfEdges::kNone && h != c);
    if (h == c) continue;
    for (h = turn_right(mesh, c); h != HalfEdges::kNone; h = turn_right(mesh, h)) {
      mesh.instance[h] = id;
    }
  }
  return mesh;
}

}  // namespace rlpc
