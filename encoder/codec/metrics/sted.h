// STED, spatio-temporal edge difference: L. Vasa and V. Skala, "A Perception Correlated
// Comparison Method for Dynamic Meshes", IEEE TVCG 17(2), 2011, with the definitions and
// constants of the program that its authors published.
//
// Spatial part. For an edge of length l in the original and l' in the decoded mesh,
//   ed = (l - l') / l, 0 if l = 0
// and for the edges that meet in a vertex or in one of its neighbours, each taken once,
//   dev = sqrt(sum of l (ed - mean)^2 / sum of l),    mean = sum of l ed / sum of l
// which is 0 if all of them change by the same ratio, as under rigid motion or scaling. The
// part is the mean of dev over vertices and frames; a vertex without edges counts as 0.
//
// Temporal part. With positions divided by the bounding box diagonal of the first original
// frame, each step of a vertex from one frame to the next has
//   s = sqrt(|step|^2 + dt^2)
// and s' in the decoded mesh. The part is the mean over vertices and steps f of |s - s'|
// divided by the mean of s over the steps f - 5 ... f + 4 of that vertex, or those of them that
// exist. If the diagonal is 0, positions are not divided.
//
//   STED = sqrt(spatial^2 + (c temporal)^2),    dt = 0.0003, c = 0.00009144
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Returns the edges of triangles without duplicates, in ascending order, the lower vertex
// first. Equal corners of a triangle make no edge.
std::vector<std::array<std::uint32_t, 2>> edges_of(std::span<const Triangle> triangles);

// The spatial part, frame by frame. A frame takes time linear in the number of vertices and
// edges, and one look at each cycle of three edges: no more than edges^1.5, whatever the
// valences. Memory is linear.
class StedSpatial {
 public:
  StedSpatial(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  // Returns the part of one frame; both have 3 * num_vertices finite values.
  double add_frame(std::span<const float> original, std::span<const float> decoded);

 private:
  // Sums of l, l d and l d^2 over edges, d being ed less its mean in the frame.
  using Sums = std::array<double, 3>;
  struct Arc {
    std::uint32_t to = 0;
    std::uint32_t edge = 0;
  };

  void list_arcs();
  void measure_edges(std::span<const float> original, std::span<const float> decoded);
  void subtract_opposite_edges();

  std::uint32_t num_vertices_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  // [first_arc_[v], first_arc_[v + 1]): arcs from v to neighbours of greater valence, or equal
  // valence and greater index, by index. Every cycle of three edges starts in one vertex.
  std::vector<std::size_t> first_arc_;
  std::vector<Arc> arcs_;
  std::vector<Sums> edge_sums_;      // [edge]
  std::vector<Sums> own_sums_;       // [vertex]: over edges that meet there
  std::vector<Sums> two_ring_sums_;  // [vertex]: also over edges that meet in its neighbours
};

// The temporal part. Keeps the steps of one window: memory is linear in the vertices.
class StedTemporal {
 public:
  static constexpr double kDt = 0.0003;
  static constexpr std::size_t kStepsBefore = 5;
  static constexpr std::size_t kStepsAfter = 4;

  explicit StedTemporal(std::uint32_t num_vertices) : num_vertices_(num_vertices) {}

  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Returns the part of each step so far; windows of the last steps contain only known steps.
  std::vector<double> steps() const;

 private:
  double part_of(std::size_t step) const;

  std::uint32_t num_vertices_;
  double scale_ = 1;
  std::vector<float> previous_original_;
  std::vector<float> previous_decoded_;
  std::size_t num_steps_ = 0;
  std::deque<std::vector<double>> lengths_;      // s of the last steps, the latest at the end
  std::deque<std::vector<double>> differences_;  // |s - s'| of steps without a whole window
  std::vector<double> parts_;                    // parts of steps with a whole window
};

constexpr double kStedTemporalWeight = 9.144e-5;  // c

}  // namespace rlpc
