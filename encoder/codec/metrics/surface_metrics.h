// Perceptual distortion of a decoded animation: STED (sted.h), the edge difference in one ring
// (ring_edge_difference.h), and deviations of normals, those of vertices in vertex_normals.h.
//
// Normal angle: the angle between the original and the decoded normal of a triangle. Triangles
// without area in the original are skipped; those that lost their area count as 90 degrees.
// Means are weighted by area in the original, so that slivers barely count.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/metrics/ring_edge_difference.h"
#include "encoder/codec/metrics/sted.h"
#include "encoder/codec/metrics/vertex_normals.h"

namespace rlpc {

struct FrameSurface {
  double sted_spatial = 0;
  double sted_temporal = 0;  // for the step from the previous frame; 0 in the first frame
  double ring_spatial = 0;
  double ring_temporal = 0;      // 0 in the first and the last frame
  double mean_normal_angle = 0;  // degrees
  double max_normal_angle = 0;
  std::uint32_t max_normal_triangle = 0;
  double vertex_normals = 0;  // RMS deviation, degrees
  double normal_flicker = 0;  // RMS change of the error of vertex normals; 0 in the first frame
};

struct SurfaceMetrics {
  // Whether STED is defined: its temporal part is relative to the diagonal of the first frame,
  // which is 0 if that frame is a point. If not, sted and its temporal part are 0, also in
  // `frames`.
  bool has_sted = true;
  double sted = 0;
  double sted_spatial = 0;
  double sted_temporal = 0;
  double ring_difference = 0;  // the edge difference in one ring
  double ring_spatial = 0;
  double ring_temporal = 0;
  double mean_normal_angle = 0;  // degrees
  double max_normal_angle = 0;
  std::uint32_t max_normal_frame = 0;  // the first frame and triangle with this angle
  std::uint32_t max_normal_triangle = 0;
  double vertex_normals = 0;  // RMS deviation over vertices and frames, degrees
  double normal_flicker = 0;  // RMS change of the error from frame to frame, degrees
  std::vector<FrameSurface> frames;
};

class SurfaceAccumulator {
 public:
  SurfaceAccumulator(std::uint32_t num_vertices, std::span<const Triangle> triangles);

  // Adds the next frame; both have 3 * num_vertices finite values in the vertex order of the
  // triangles.
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Returns the metrics of all frames so far, at least one.
  SurfaceMetrics result() const;

 private:
  void add_normals(std::span<const float> original, std::span<const float> decoded,
                   FrameSurface& frame);

  std::vector<Triangle> triangles_;
  StedSpatial sted_spatial_;
  StedTemporal sted_temporal_;
  bool starts_as_point_ = false;
  RingEdgeDifference ring_;
  std::vector<FrameSurface> frames_;
  double angle_sum_ = 0;  // degrees times area
  double area_sum_ = 0;
  NormalErrors normal_errors_;
  SquaredAngles normal_deviation_;
  SquaredAngles normal_flicker_;
};

}  // namespace rlpc
