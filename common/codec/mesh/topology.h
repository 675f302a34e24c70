// Neighbourhoods of the decoded connectivity, for prediction (clause 8.3).
#pragma once

#include <cstdint>
#include <span>
#include <utility>

#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// List of lists in two flat arrays.
template <class T>
class ListOfLists {
 public:
  ListOfLists() = default;
  ListOfLists(Vector<std::uint32_t> first, Vector<T> items)
      : first_(std::move(first)), items_(std::move(items)) {}
  std::span<const T> operator[](std::size_t i) const {
    return std::span<const T>(items_).subspan(first_[i], first_[i + 1] - first_[i]);
  }
  std::size_t size() const { return first_.empty() ? 0 : first_.size() - 1; }

 private:
  Vector<std::uint32_t> first_;  // [size + 1]
  Vector<T> items_;
};

// Parallelogram: a + b - c predicts v; the triangles (v, a, b) and (a, b, c) share an edge.
struct Parallelogram {
  std::uint32_t a;
  std::uint32_t b;
  std::uint32_t c;
};

struct Topology {
  // 8.3.1: per vertex, its neighbours of lower index, ascending, each once.
  ListOfLists<std::uint32_t> earlier_neighbours;
  // 8.3.2: per vertex, the parallelograms whose vertices all have lower indices.
  ListOfLists<Parallelogram> parallelograms;
};

// Makes the topology. triangles: indices below num_vertices.
Topology make_topology(std::uint32_t num_vertices, std::span<const Triangle> triangles);

}  // namespace rlpc
