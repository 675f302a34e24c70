// Edge difference in one ring: a variant of STED (sted.h) with unsigned differences, the
// smallest neighbourhoods, and a temporal part that counts. Up to version 1.1.6, rlpccmp called
// it STED. Its values are not those of published STED.
//
// For an edge of length l in the original and l' in the decoded mesh, ed = |l - l'| / l. For a
// set of edges, with weights l,
//   dev = sqrt(sum of l (ed - mean)^2 / sum of l),    mean = sum of l ed / sum of l
// so dev is 0 if all edges change by the same ratio. The spatial part is the mean over vertices
// and frames of dev of the edges that meet in the vertex. The temporal part is the mean over
// vertices and all frames but the first and the last of dev of two virtual edges, from a vertex
// to itself in the previous and in the next frame. Such an edge has length
// sqrt(distance^2 + (dt d)^2), d the bounding box diagonal of the first original frame. The
// whole is sqrt(spatial^2 + temporal^2). An edge of length 0 has weight 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Both parts, frame by frame. Time and memory per frame are linear in the size of the mesh;
// three frames are kept.
class RingEdgeDifference {
 public:
  static constexpr double kDt = 0.01;

  RingEdgeDifference(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  struct Parts {
    double spatial = 0;
    double previous_temporal = 0;  // the previous frame's: both its virtual edges are now known
  };
  Parts add_frame(std::span<const float> original, std::span<const float> decoded);

 private:
  struct Pair {
    double original = 0;
    double decoded = 0;
    double difference() const;  // ed
  };

  double spatial_part(std::span<const float> original, std::span<const float> decoded);
  double temporal_part(std::span<const float> original, std::span<const float> decoded);

  std::uint32_t num_vertices_;
  std::vector<std::array<std::uint32_t, 2>> edges_;  // no duplicates
  double frame_distance_ = 0;                        // dt d
  std::vector<float> previous_original_;
  std::vector<float> previous_decoded_;
  std::vector<Pair> temporal_edges_;  // [num_vertices], to the previous frame
  // Work space of spatial_part().
  std::vector<Pair> lengths_;   // [num_edges]
  std::vector<double> weight_;  // [num_vertices], here and below
  std::vector<double> mean_;
  std::vector<double> variance_;
};

}  // namespace rlpc
