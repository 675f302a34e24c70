#include "common/codec/mesh/vertex_layers.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cstdlib>
#include <functional>
#include <optional>
#include <utility>

#include "common/codec/mesh/triangulations.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;
constexpr std::uint32_t kMaxFan = 6;  // triangles around a removable vertex
// Maximum number of triangles around a vertex for most purposes: two vertices with more get no
// new edge (8.9.5), and such a vertex adds nothing to outer_ring (8.9.6). Only the base walks
// along their triangles.
constexpr std::uint32_t kMaxValence = 12;
constexpr std::int32_t kGoodValence = 6;

bool are_different(const Triangle& t) { return t[0] != t[1] && t[1] != t[2] && t[2] != t[0]; }

// 8.9.2 Rest of the mesh: its triangles. The corners at a vertex form a linked list, so that
// removing a triangle takes constant time; corner k of triangle i is 3 * i + k. Each corner
// holds the vertices of the other two corners, so that a walk around a vertex reads nothing
// else.
class Rest {
 public:
  Rest(std::uint32_t num_vertices, std::span<const Triangle> triangles)
      : first_(num_vertices, kNone), valence_(num_vertices, 0) {
    corners_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
      if (!are_different(t)) continue;
      corners_.resize(corners_.size() + 3);
      add(static_cast<std::uint32_t>(corners_.size() / 3 - 1), t);
    }
  }

  std::uint32_t valence(std::uint32_t v) const { return valence_[v]; }
  // Iterate over the corners at a vertex; kNone: end.
  std::uint32_t first(std::uint32_t v) const { return first_[v]; }
  std::uint32_t next(std::uint32_t corner) const { return corners_[corner].next; }
  // Returns the other two vertices of a triangle, in its orientation.
  const std::array<std::uint32_t, 2>& others(std::uint32_t corner) const {
    return corners_[corner].others;
  }

  // Adds triangle i, which was removed before or is new.
  void add(std::uint32_t i, const Triangle& t) {
    link(3 * i, t[0], {t[1], t[2]});
    link(3 * i + 1, t[1], {t[2], t[0]});
    link(3 * i + 2, t[2], {t[0], t[1]});
  }
  void take(std::uint32_t i) {
    for (std::uint32_t k = 0; k < 3; ++k) unlink(3 * i + k);
  }

 private:
  struct Corner {
    std::uint32_t vertex = 0;
    std::uint32_t next = kNone;
    std::uint32_t previous = kNone;
    std::array<std::uint32_t, 2> others{};
  };

  void link(std::uint32_t corner, std::uint32_t v, const std::array<std::uint32_t, 2>& others) {
    corners_[corner] = {v, first_[v], kNone, others};
    if (first_[v] != kNone) corners_[first_[v]].previous = corner;
    first_[v] = corner;
    ++valence_[v];
  }
  void unlink(std::uint32_t corner) {
    const Corner& c = corners_[corner];
    (c.previous == kNone ? first_[c.vertex] : corners_[c.previous].next) = c.next;
    if (c.next != kNone) corners_[c.next].previous = c.previous;
    --valence_[c.vertex];
  }

  Vector<Corner> corners_;
  Vector<std::uint32_t> first_;    // [num_vertices]
  Vector<std::uint32_t> valence_;  // [num_vertices]
};

// All triangles of the rest of the mesh over time, and the passes that added and removed them,
// from 1 on. Until layers have been counted, max_layers of a LayeredTriangle is the pass that
// added it, and min_layers the pass that removed it, or 0.
class History {
 public:
  History(std::span<const Triangle> triangles, LayeredTriangles& all) : all_(all) {
    all_.clear();
    all_.reserve(3 * triangles.size());
    for (const Triangle& t : triangles) {
      if (are_different(t)) all_.push_back({t, 0, 0});
    }
    latest_.resize(all_.size());
    for (std::uint32_t i = 0; i < latest_.size(); ++i) latest_[i] = i;
  }

  // i: index of the triangle in Rest.
  void add(std::uint32_t i, const Triangle& t, std::uint8_t pass) {
    latest_[i] = static_cast<std::uint32_t>(all_.size());
    all_.push_back({t, 0, pass});
  }
  void take(std::uint32_t i, std::uint8_t pass) { all_[latest_[i]].min_layers = pass; }

  // Converts passes to layers: after p passes, num_layers - p layers are left.
  void count_layers(std::uint32_t num_layers) {
    for (LayeredTriangle& t : all_) {
      const std::uint32_t above = t.min_layers == 0 ? 0 : num_layers - t.min_layers;
      t.min_layers = static_cast<std::uint8_t>(above + 1);
      t.max_layers = static_cast<std::uint8_t>(num_layers - t.max_layers);
    }
  }

 private:
  LayeredTriangles& all_;
  Vector<std::uint32_t> latest_;  // [index in Rest] index in all_
};

// 8.9.3 Ring of a vertex
struct Ring {
  std::array<std::uint32_t, kMaxRing> vertices{};
  std::size_t size = 0;
  bool closed = false;

  void append(std::uint32_t v) { vertices[size++] = v; }
  std::span<const std::uint32_t> span() const { return std::span(vertices).first(size); }
};

// Surroundings of a ring: edges that a triangulation must not have (8.9.5), and vertices for
// outer_ring (8.9.6).
struct Surroundings {
  EdgeSet barred = 0;
  std::size_t num_vertices = 0;
  std::array<std::uint32_t, std::size_t{2} * kMaxValence * kMaxRing + 1> vertices{};
};

// Builds the layers pass by pass.
class LayerMaker {
 public:
  LayerMaker(std::uint32_t num_vertices, std::span<const Triangle> triangles,
             LayeredTriangles* all)
      : rest_(num_vertices, triangles), locked_in_pass_(num_vertices), place_(num_vertices) {
    if (all != nullptr) history_.emplace(triangles, *all);
    layers_.layer_of_vertex.resize(num_vertices);
    layers_.ring = VertexLists(num_vertices);
    layers_.outer_ring = VertexLists(num_vertices);
  }

  VertexLayers make();

 private:
  void remove_layer(Vector<std::uint32_t>& rest);
  std::optional<Ring> find_ring(std::uint32_t v);
  const Triangulation* choose_triangulation(const Ring& ring, EdgeSet barred) const;
  void look_around(std::uint32_t v, const Ring& ring);
  bool remove_vertex(std::uint32_t v);
  // Not inlined, as that would slow down remove_vertex() where nothing is noted.
  [[gnu::noinline]] void note_removal(std::span<const std::uint32_t> taken, const Ring& ring,
                                      const Triangulation& triangulation);
  void set_outer_rings(std::span<const std::uint32_t> removed);
  void order_layers(const Vector<std::uint32_t>& base);
  void set_base_rings(const Vector<std::uint32_t>& base);

  Rest rest_;
  std::optional<History> history_;
  VertexLayers layers_;
  std::uint8_t num_passes_ = 0;
  Vector<std::uint8_t> locked_in_pass_;  // [num_vertices]
  Vector<std::uint32_t> removed_;        // in order of removal
  Vector<std::size_t> removed_before_;   // [pass - 1], vertices removed before that pass
  // Vertices removed in this pass, in order, for outer_ring.
  Vector<std::uint32_t> around_;
  Vector<std::uint32_t> around_end_;
  // [num_vertices]: 0, except within a function that sets it: place in a fan or
  // a ring plus 1
  Vector<std::uint8_t> place_;
  Surroundings surroundings_;  // surroundings of the current vertex
};

// 8.9.3 Ring of a vertex: FindRing( v ); none if the triangles around v are not a fan, in which
// each vertex around v starts at most one triangle and ends at most one
std::optional<Ring> LayerMaker::find_ring(std::uint32_t v) {
  assert(rest_.valence(v) > 0 && rest_.valence(v) <= kMaxFan);
  std::array<std::uint32_t, kMaxFan> starts{};
  std::array<std::uint32_t, kMaxFan> ends{};
  std::size_t size = 0;
  for (std::uint32_t c = rest_.first(v); c != kNone; c = rest_.next(c)) {
    starts[size] = rest_.others(c)[0];
    ends[size] = rest_.others(c)[1];
    ++size;
  }
  bool is_fan = true;
  for (std::size_t i = 0; i < size; ++i) {
    is_fan = is_fan && place_[starts[i]] == 0;
    place_[starts[i]] = static_cast<std::uint8_t>(i + 1);
  }
  // [place] 1 + the triangle that starts at the vertex, and the set of all triangles that do.
  std::array<std::uint8_t, kMaxFan> follower{};
  unsigned followers = 0;
  for (std::size_t i = 0; i < size; ++i) {
    follower[i] = place_[ends[i]];
    const unsigned bit = (1U << follower[i]) >> 1U;
    is_fan = is_fan && (followers & bit) == 0;
    followers |= bit;
  }
  for (std::size_t i = 0; i < size; ++i) place_[starts[i]] = 0;
  const unsigned leaders = ((1U << size) - 1U) & ~followers;
  if (!is_fan || (leaders & (leaders - 1U)) != 0 || (leaders == 0 && size < 3)) {
    return std::nullopt;
  }
  const std::size_t first =
      leaders != 0
          ? static_cast<std::size_t>(std::countr_zero(leaders))
          : static_cast<std::size_t>(std::min_element(starts.begin(), starts.begin() + size) -
                                     starts.begin());
  Ring ring;
  ring.closed = leaders == 0;
  std::size_t last = first;
  ring.append(starts[first]);
  while (ring.size < size && follower[last] != 0 && follower[last] != first + 1) {
    last = follower[last] - 1U;
    ring.append(starts[last]);
  }
  if (ring.size < size) return std::nullopt;
  if (!ring.closed) ring.append(ends[last]);
  return ring;
}

// Returns [i][place + 1], the edge between two places in a ring; none from a place to itself,
// or without a place.
constexpr std::array<std::array<EdgeSet, kMaxRing + 2>, kMaxRing> edges_to_places() {
  std::array<std::array<EdgeSet, kMaxRing + 2>, kMaxRing> edges{};
  for (std::size_t i = 0; i < kMaxRing; ++i) {
    for (std::size_t j = 0; j < kMaxRing; ++j) {
      if (i != j) edges[i][j + 1] = edge(i, j);
    }
  }
  return edges;
}

// 8.9.5 Choice of a triangulation: finds the forbidden edges, between vertices that are not
// neighbours in the ring but share a triangle of the rest, or that both have many triangles.
// Also 8.9.6 Removal of a vertex: VerticesAroundRing( v, ring ), here in any order.
void LayerMaker::look_around(std::uint32_t v, const Ring& ring) {
  static constexpr auto kEdgesToPlaces = edges_to_places();
  EdgeSet sides = ring.closed ? edge(0, ring.size - 1) : 0;
  for (std::size_t i = 0; i + 1 < ring.size; ++i) sides |= edge(i, i + 1);
  constexpr std::uint8_t kNoPlace = kMaxRing + 1;  // visited, but not in the ring
  place_[v] = kNoPlace;
  for (std::size_t i = 0; i < ring.size; ++i) {
    place_[ring.vertices[i]] = static_cast<std::uint8_t>(i + 1);
  }
  EdgeSet found = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < ring.size; ++i) {
    const std::uint32_t a = ring.vertices[i];
    if (rest_.valence(a) > kMaxValence) {
      for (std::size_t j = 0; j < i; ++j) {
        if (rest_.valence(ring.vertices[j]) > kMaxValence) found |= edge(i, j);
      }
      continue;
    }
    for (std::uint32_t c = rest_.first(a); c != kNone; c = rest_.next(c)) {
      for (const std::uint32_t u : rest_.others(c)) {
        const std::uint8_t place = place_[u];
        found |= kEdgesToPlaces[i][place];
        // Branch-free, because about half of the vertices are new.
        surroundings_.vertices[count] = u;
        if (place == 0) ++count;
        place_[u] = place == 0 ? kNoPlace : place;
      }
    }
  }
  place_[v] = 0;
  for (const std::uint32_t u : ring.span()) place_[u] = 0;
  for (std::size_t i = 0; i < count; ++i) place_[surroundings_.vertices[i]] = 0;
  surroundings_.barred = found & ~sides;
  surroundings_.num_vertices = count;
}

// 8.9.5 Choice of a triangulation: nullptr if none is allowed.
const Triangulation* LayerMaker::choose_triangulation(const Ring& ring, EdgeSet barred) const {
  constexpr std::int32_t kForbidden = 1 << 28;
  const std::int32_t fewest = ring.closed ? 3 : 1;
  std::array<std::array<std::int32_t, kMaxRing>, kMaxRing> costs{};  // [place][new triangles]
  for (std::size_t i = 0; i < ring.size; ++i) {
    const bool at_end = !ring.closed && (i == 0 || i + 1 == ring.size);
    auto valence =
        static_cast<std::int32_t>(rest_.valence(ring.vertices[i])) - (at_end ? 1 : 2);
    for (std::int32_t& cost : costs[i]) {
      cost = valence < fewest ? kForbidden : std::abs(valence - kGoodValence);
      ++valence;
    }
  }
  const Triangulation* best = nullptr;
  std::int32_t min = kForbidden;
  const TriangulationList& all = triangulations()[ring.size];
  for (std::size_t t = 0; t < all.size; ++t) {
    const Triangulation& triangulation = all.items[t];
    if ((triangulation.edges & barred) != 0) continue;
    std::int32_t cost = 0;
    for (std::size_t i = 0; i < ring.size; ++i) cost += costs[i][triangulation.corners[i]];
    if (cost >= min) continue;
    best = &triangulation;
    min = cost;
  }
  return best;
}

// 8.9.6 Removal of a vertex: false if it must stay.
bool LayerMaker::remove_vertex(std::uint32_t v) {
  const std::optional<Ring> ring = find_ring(v);
  if (!ring) return false;
  look_around(v, *ring);
  const Triangulation* const chosen = choose_triangulation(*ring, surroundings_.barred);
  if (chosen == nullptr) return false;
  layers_.ring.set(v, ring->span());
  const auto around = surroundings_.vertices.begin();
  around_.insert(around_.end(), around,
                 around + static_cast<std::ptrdiff_t>(surroundings_.num_vertices));
  around_end_.push_back(static_cast<std::uint32_t>(around_.size()));
  std::array<std::uint32_t, kMaxFan> taken{};
  std::size_t num_taken = 0;
  while (rest_.first(v) != kNone) {
    taken[num_taken] = rest_.first(v) / 3;
    rest_.take(taken[num_taken++]);
  }
  assert(chosen->num_triangles < num_taken);
  for (std::size_t t = 0; t < chosen->num_triangles; ++t) {
    const auto& [i, k, j] = chosen->triangles[t];
    rest_.add(taken[t], {ring->vertices[i], ring->vertices[k], ring->vertices[j]});
  }
  if (history_) note_removal(std::span(taken).first(num_taken), *ring, *chosen);
  layers_.layer_of_vertex[v] = num_passes_;
  for (const std::uint32_t u : ring->span()) locked_in_pass_[u] = num_passes_;
  return true;
}

// Notes a removal. taken: triangles that remove_vertex() has removed, whose indices the new
// triangles have.
void LayerMaker::note_removal(std::span<const std::uint32_t> taken, const Ring& ring,
                              const Triangulation& triangulation) {
  for (const std::uint32_t i : taken) history_->take(i, num_passes_);
  for (std::size_t t = 0; t < triangulation.num_triangles; ++t) {
    const auto& [i, k, j] = triangulation.triangles[t];
    history_->add(taken[t], {ring.vertices[i], ring.vertices[k], ring.vertices[j]},
                  num_passes_);
  }
}

// 8.9.1 General: RemoveLayer( rest ), one pass; vertices that stay remain in `rest`.
void LayerMaker::remove_layer(Vector<std::uint32_t>& rest) {
  const std::size_t before = removed_.size();
  around_.clear();
  around_end_.clear();
  for (std::uint32_t valence = 1; valence <= kMaxFan; ++valence) {
    for (const std::uint32_t v : rest) {
      if (rest_.valence(v) != valence || locked_in_pass_[v] == num_passes_) continue;
      if (remove_vertex(v)) removed_.push_back(v);
    }
  }
  std::erase_if(rest,
                [this](std::uint32_t v) { return layers_.layer_of_vertex[v] == num_passes_; });
  set_outer_rings(std::span(removed_).subspan(before));
}

// 8.9.6 Removal of a vertex: LowerLayersOnly( v, list ), after the pass
void LayerMaker::set_outer_rings(std::span<const std::uint32_t> removed) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < removed.size(); ++i) {
    const auto list = std::span(around_).subspan(begin, around_end_[i] - begin);
    const auto end = std::remove_if(list.begin(), list.end(), [this](std::uint32_t u) {
      return layers_.layer_of_vertex[u] != 0;
    });
    std::sort(list.begin(), end);
    const auto count =
        std::min<std::size_t>(static_cast<std::size_t>(end - list.begin()), kMaxOuterRing);
    layers_.outer_ring.set(removed[i], list.first(count));
    begin = around_end_[i];
  }
}

// 8.9.1 General: each pass but the last removes a sixteenth, and three vertices stay.
constexpr std::uint32_t max_layers(std::uint32_t num_vertices) {
  std::uint32_t layers = 1;
  for (; num_vertices > 3; num_vertices -= (num_vertices + 15) / 16) ++layers;
  return layers;
}
static_assert(max_layers(1U << 23) == kMaxLayers);

// 8.9.7 Order of the layers, and base; until here, layer_of_vertex is the pass.
void LayerMaker::order_layers(const Vector<std::uint32_t>& base) {
  layers_.num_layers = num_passes_ + 1U;
  assert(layers_.num_layers <= kMaxLayers);  // so that a pass fits into 8 bits
  for (const std::uint32_t v : removed_) {
    layers_.layer_of_vertex[v] =
        static_cast<std::uint8_t>(layers_.num_layers - layers_.layer_of_vertex[v]);
  }
  layers_.layer_order = base;
  layers_.layer_order.reserve(base.size() + removed_.size());
  std::size_t end = removed_.size();
  for (std::size_t pass = num_passes_; pass > 0; --pass) {
    const std::size_t begin = removed_before_[pass - 1];
    const auto layer = std::span(removed_).subspan(begin, end - begin);
    std::sort(layer.begin(), layer.end());
    layers_.layer_order.insert(layers_.layer_order.end(), layer.begin(), layer.end());
    end = begin;
  }
}

// 8.9.7 Order of the layers, and base: BaseRing( v )
void LayerMaker::set_base_rings(const Vector<std::uint32_t>& base) {
  for (std::size_t i = 0; i < base.size(); ++i) {
    const std::uint32_t v = base[i];
    std::array<std::uint32_t, kMaxRing + 1> highest{};  // descending
    std::size_t size = 0;
    for (std::uint32_t c = rest_.first(v); c != kNone; c = rest_.next(c)) {
      for (const std::uint32_t u : rest_.others(c)) {
        const auto end = highest.begin() + size;
        if (u > v || std::find(highest.begin(), end, u) != end) continue;
        highest[size] = u;
        std::rotate(std::upper_bound(highest.begin(), end, u, std::greater<>()), end, end + 1);
        size = std::min(size + 1, kMaxRing);
      }
    }
    if (size == 0 && i > 0) highest[size++] = base[i - 1];
    std::reverse(highest.begin(), highest.begin() + size);
    layers_.ring.set(v, std::span(highest).first(size));
  }
}

// 8.9.1 General: MakeLayers( )
VertexLayers LayerMaker::make() {
  Vector<std::uint32_t> rest(layers_.ring.size());
  for (std::uint32_t v = 0; v < rest.size(); ++v) rest[v] = v;
  for (bool go_on = !rest.empty(); go_on;) {
    const std::size_t visited = rest.size();
    removed_before_.push_back(removed_.size());
    ++num_passes_;
    remove_layer(rest);
    const std::size_t removed = visited - rest.size();
    if (removed == 0) --num_passes_;
    go_on = 16 * removed >= visited;
  }
  order_layers(rest);
  set_base_rings(rest);
  if (history_) history_->count_layers(layers_.num_layers);
  return std::move(layers_);
}

}  // namespace

void VertexLists::set(std::uint32_t v, std::span<const std::uint32_t> items) {
  assert(items.size() <= 255 && size_[v] == 0);
  first_[v] = static_cast<std::uint32_t>(items_.size());
  size_[v] = static_cast<std::uint8_t>(items.size());
  items_.insert(items_.end(), items.begin(), items.end());
}

VertexLayers make_layers(std::uint32_t num_vertices, std::span<const Triangle> triangles,
                         LayeredTriangles* all) {
  return LayerMaker(num_vertices, triangles, all).make();
}

}  // namespace rlpc
