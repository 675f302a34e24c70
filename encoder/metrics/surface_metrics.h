// Perceptual distortion of a decoded animation: spatio-temporal edge difference (STED) and
// normal deviation.
//
// STED, spatio-temporal edge difference, after L. Vasa and V. Skala, "A Perception Correlated
// Comparison Method for Dynamic Meshes", IEEE TVCG 17(2), 2011. For an edge of length l in the
// original and l' in the decoded mesh, ed = |l - l'| / l. For a set of edges, with weights l,
//   dev = sqrt(sum of l (ed - mean)^2 / sum of l),    mean = sum of l ed / sum of l
// so dev is 0 if all edges change by the same ratio, as under rigid motion or scaling. The
// spatial part is the mean over vertices and frames of dev of the edges that meet in the
// vertex. The temporal part is the mean over vertices and all frames but the first and the last
// of dev of two virtual edges, from a vertex to itself in the previous and in the next frame.
// Such an edge has length sqrt(distance^2 + (dt d)^2), d the bounding box diagonal of the first
// original frame.
//   STED = sqrt(spatial^2 + (c temporal)^2)
// Neighbourhoods are 1-rings, dt = 0.01 and c = 1; results with other parameters are not
// comparable. An edge of length 0 has weight 0.
//
// Normal angle: the angle between the original and the decoded normal of a triangle. Triangles
// without area in the original are skipped; those that lost their area count as 90 degrees.
// Means are weighted by area in the original, so that slivers hardly count.
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
  std::uint32_t max_normal_frame = 0;  // the first frame and triangle with this angle
  std::uint32_t max_normal_triangle = 0;
  std::vector<FrameSurface> frames;
};

// The parts of STED, frame by frame. Time and memory per frame are linear in the size of the
// mesh; three frames are kept.
class StedAccumulator {
 public:
  static constexpr double kDt = 0.01;
  static constexpr double kTemporalWeight = 1.0;

  StedAccumulator(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  struct Parts {
    double spatial = 0;
    double previous_temporal =
        0;  // of the previous frame, whose two virtual edges are now known
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
  std::vector<std::array<std::uint32_t, 2>> edges_;  // without duplicates
  double frame_distance_ = 0;                        // dt d
  std::vector<float> previous_original_;
  std::vector<float> previous_decoded_;
  std::vector<Pair> temporal_edges_;  // [num_vertices], to the previous frame
  // Work space of spatial_part():
  std::vector<Pair> lengths_;   // [num_edges]
  std::vector<double> weight_;  // [num_vertices], here and below
  std::vector<double> mean_;
  std::vector<double> variance_;
};

class SurfaceAccumulator {
 public:
  SurfaceAccumulator(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  // Adds the next frame; both have 3 * num_vertices finite values in the vertex order of the
  // triangles.
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // The metrics of all frames so far, at least one.
  SurfaceMetrics result() const;

 private:
  void add_normals(std::span<const float> original, std::span<const float> decoded,
                   FrameSurface& frame);

  std::vector<Triangle> triangles_;
  StedAccumulator sted_;
  std::vector<FrameSurface> frames_;
  double angle_sum_ = 0;  // degrees times area
  double area_sum_ = 0;
};

// The edges of triangles without duplicates, in ascending order, the lower vertex first. Equal
// corners of a triangle give no edge.
std::vector<std::array<std::uint32_t, 2>> edges_of(std::span<const Triangle> triangles);

}  // namespace rlpc
