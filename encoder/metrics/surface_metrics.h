// Distortion of a decoded animation as eyes see it: how edges change beside each other and over
// time (STED), and how far triangles turn.
//
// STED, spatio-temporal edge difference, after L. Vasa and V. Skala, "A Perception Correlated
// Comparison Method for Dynamic Meshes", IEEE TVCG 17(2), 2011. For an edge of length l in the
// original and l' in the decoded mesh, ed = |l - l'| / l. Of several edges, with weights l,
//   dev = sqrt(sum of l (ed - mean)^2 / sum of l),    mean = sum of l ed / sum of l
// so that edges which all change by the same share, as by moving, turning or scaling, add
// nothing. Spatial part: the mean of dev over vertices and frames, of the edges that meet in
// the vertex. Temporal part: likewise, of the two virtual edges from a vertex to itself in the
// frame before and in the one behind, over all frames but the first and the last. Such an edge
// has length sqrt(distance^2 + (dt d)^2), d the diagonal of the original's first frame.
//   STED = sqrt(spatial^2 + (c temporal)^2)
// Neighbourhoods are of one step, dt = 0.01 and c = 1; figures that were found with other
// parameters cannot be compared. An edge of length 0 has no weight.
//
// Normal angle: between the normals of a triangle in both. A triangle without area in the
// original is left out; one that lost its area counts 90 degrees. Means are by area in the
// original, so that what is too thin to be seen does not count much.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"

namespace rlpc {

struct FrameSurface {
  double sted_spatial = 0;
  double sted_temporal = 0;      // 0 in the first and the last frame
  double mean_normal_angle = 0;  // degrees
  double max_normal_angle = 0;
  std::uint32_t max_normal_triangle = 0;
};

struct SurfaceMetrics {
  double sted = 0;
  double sted_spatial = 0;
  double sted_temporal = 0;
  double mean_normal_angle = 0;  // degrees
  double max_normal_angle = 0;
  std::uint32_t max_normal_frame = 0;  // the first frame and triangle that reach it
  std::uint32_t max_normal_triangle = 0;
  std::vector<FrameSurface> frames;
};

// Time and memory per frame are linear in the size of the mesh; three frames are kept.
class SurfaceAccumulator {
 public:
  static constexpr double kDt = 0.01;
  static constexpr double kTemporalWeight = 1.0;

  SurfaceAccumulator(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  // Both 3 * num_vertices finite values in the vertex order of the triangles; frames in order.
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Of the frames so far, at least one.
  SurfaceMetrics result() const;

 private:
  struct Pair {
    double original = 0;
    double decoded = 0;
    double difference() const;  // ed
  };

  double spatial_part(std::span<const float> original, std::span<const float> decoded);
  // Of the frame before, now that the edges on both sides of it are known.
  double temporal_part(std::span<const float> original, std::span<const float> decoded);
  void add_normals(std::span<const float> original, std::span<const float> decoded,
                   FrameSurface& frame);

  std::uint32_t num_vertices_;
  std::vector<Triangle> triangles_;
  std::vector<std::array<std::uint32_t, 2>> edges_;  // each once
  std::vector<FrameSurface> frames_;
  double angle_sum_ = 0;  // degrees times area
  double area_sum_ = 0;
  double frame_distance_ = 0;  // dt d
  std::vector<float> previous_original_;
  std::vector<float> previous_decoded_;
  std::vector<Pair> temporal_edges_;  // [num_vertices] into the previous frame
  std::vector<Pair> lengths_;         // [num_edges], kept to spare allocation
  std::vector<double> weight_;        // [num_vertices], likewise
  std::vector<double> mean_;
  std::vector<double> variance_;
};

// Edges of triangles, each once, the lower vertex first, in order. Corners that coincide make
// none.
std::vector<std::array<std::uint32_t, 2>> edges_of(std::span<const Triangle> triangles);

}  // namespace rlpc
