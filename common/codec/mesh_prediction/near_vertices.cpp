#include "common/codec/mesh_prediction/near_vertices.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/codec/mesh/indices.h"
#include "common/memory/owned.h"
#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr std::size_t kTogether = 1024;  // vertices of a pass

// Round numbers of the format. The bytes of other values are measured on whole files of robot,
// knight, q-spider, cow and morph-stress at a KG error of 0.1 %, each frame predicted from the
// previous one.
//
// Number of candidates below which vertices of the base are added. Half: +1.4 % on average,
// robot +5.2 %; double: -1.1 %, robot -3.8 %, knight up to +0.9 %; four times: worse again.
constexpr std::size_t kFewCandidates = 4;
// Maximum number of vertices of the base, which bounds the time. Half: robot +0.6 %; double:
// +2.7 %; the others have smaller bases, or do not need them.
constexpr std::size_t kBaseWindow = 256;

struct NearList {
  std::array<std::uint32_t, kMaxNear> vertices{};
  std::size_t size = 0;
};

std::int64_t squared_distance(std::span<const std::int32_t> values, std::uint32_t u,
                              std::uint32_t v) {
  std::int64_t sum = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t difference =
        std::int64_t{values[3 * std::size_t{u} + c]} - values[3 * std::size_t{v} + c];
    sum += difference * difference;
  }
  return sum;
}

class NearSearch {
 public:
  NearSearch(const OrderedMesh& mesh, std::span<const std::int32_t> values)
      : mesh_(mesh), base_(mesh.vertices_of_layers(0, 1)), values_(values) {}

  NearList find(std::uint32_t v) {
    vertices_.clear();
    const auto ring = mesh_.ring(v);
    add(mesh_.outer_ring(v));
    for (const std::uint32_t r : ring) {
      add(mesh_.ring(r));
      add(mesh_.outer_ring(r));
    }
    keep_different(ring);
    if (mesh_.layer_of(v) == 0 || vertices_.size() < kFewCandidates) {
      add(base_window(v));
      keep_different(ring);
    }
    found_.clear();
    for (const std::uint32_t u : vertices_) {
      found_.emplace_back(squared_distance(values_, u, v), u);
    }
    NearList near;
    near.size = std::min(found_.size(), kMaxNear);
    std::partial_sort(found_.begin(), found_.begin() + static_cast<std::ptrdiff_t>(near.size),
                      found_.end());
    for (std::size_t i = 0; i < near.size; ++i) near.vertices[i] = found_[i].second;
    return near;
  }

 private:
  void add(std::span<const std::uint32_t> list) {
    vertices_.insert(vertices_.end(), list.begin(), list.end());
  }

  // Removes vertices of the ring, and repetitions.
  void keep_different(std::span<const std::uint32_t> ring) {
    std::erase_if(vertices_, [&](std::uint32_t u) {
      return std::find(ring.begin(), ring.end(), u) != ring.end();
    });
    sort_without_repetitions(vertices_);
  }

  // AddBaseVertices( v ): returns those before a vertex of the base, or around another vertex.
  std::span<const std::uint32_t> base_window(std::uint32_t v) const {
    const auto before = static_cast<std::size_t>(
        std::lower_bound(base_.begin(), base_.end(), v) - base_.begin());
    if (mesh_.layer_of(v) == 0) {
      const std::size_t first = before - std::min(before, kBaseWindow);
      return base_.subspan(first, before - first);
    }
    const std::size_t last = base_.size() - std::min(base_.size(), kBaseWindow);
    const std::size_t first = std::min(before - std::min(before, kBaseWindow / 2), last);
    return base_.subspan(first, std::min(kBaseWindow, base_.size() - first));
  }

  const OrderedMesh& mesh_;
  std::span<const std::uint32_t> base_;  // ascending
  std::span<const std::int32_t> values_;
  Vector<std::uint32_t> vertices_;
  Vector<std::pair<std::int64_t, std::uint32_t>> found_;  // distance, vertex
};

}  // namespace

VertexLists near_vertices(const OrderedMesh& mesh, std::span<const std::int32_t> values) {
  Vector<NearList> near(mesh.num_vertices());
  for_ranges(near.size(), kTogether, [&](std::size_t first, std::size_t end) {
    NearSearch search(mesh, values);
    for (std::size_t v = first; v < end; ++v) {
      near[v] = search.find(static_cast<std::uint32_t>(v));
    }
  });
  VertexLists lists(mesh.num_vertices());
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    lists.set(v, std::span(near[v].vertices).first(near[v].size));
  }
  return lists;
}

}  // namespace rlpc
