// Distortion of a decoded animation against the original, vertex by vertex.
//
// Results are reproducible: sums run in index order, per frame and then over the frames, and
// only PSNR uses a library function other than a square root.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "encoder/codec/metrics/vertex_normals.h"

namespace rlpc {

struct FrameMetrics {
  double squared_error = 0;  // sum over vertices of the squared distance from the original
  double spread = 0;         // sum over vertices of the squared distance from their mean
  std::array<double, 3> mean = {};  // vertex of the original
  double rms_error = 0;             // units
  double max_error = 0;             // units
  SquaredAngles normals;            // deviation of vertex normals; empty: not measured
  std::uint32_t max_error_vertex = 0;
  // Vertices of the original that moved since the previous frame; in frame 0: all.
  std::uint32_t moved_vertices = 0;
  // PSNRs are infinite if the frame is exact.
  double diagonal_psnr_db = 0;    // see Metrics
  double ramanathan_psnr_db = 0;  // see MetricsAccumulator
};

struct Metrics {
  std::uint32_t num_vertices = 0;
  // 100 * ||A - A'||_F / ||A - E(A)||_F, E(A) the mean vertex of each frame. If all vertices of
  // every frame coincide: 0 if there is no error, otherwise infinite.
  double kg_error_percent = 0;
  // The same with E(A) the mean of all vertices of all frames. Published KG errors of the
  // sequences cow and chicken have this norm.
  double kg_sequence_error_percent = 0;
  // RMS distance of the original's vertices from the mean of their frame, and from that of all
  // frames, units. Both KG errors are rms_error relative to these.
  double rms_spread = 0;
  double rms_sequence_spread = 0;
  double rms_error = 0;               // RMS distance over vertices and frames, units
  double rms_error_percent = 0;       // per cent of the diagonal; infinite if only that is 0
  double max_error = 0;               // units
  double max_error_percent = 0;       // per cent of the diagonal; infinite if only that is 0
  std::uint32_t max_error_frame = 0;  // the first frame and vertex with this error
  std::uint32_t max_error_vertex = 0;
  double diagonal = 0;  // the original's bounding box over all frames, units
  // RMS deviation of vertex normals in the frames where it was measured, degrees; none:
  // nowhere.
  std::optional<double> vertex_normals;
  double max_displacement = 0;  // largest in the original between adjacent frames, units
  // 20 log10(diagonal / rms_error): the peak is the diagonal. Infinite without an error.
  double diagonal_psnr_db = 0;
  double ramanathan_psnr_db = 0;     // mean over all inexact frames; infinite if there are none
  std::vector<FrameMetrics> frames;  // empty with kTotals
};

// Ramanathan's PSNR is that of Ramanathan, Kassim and Tan 2008, section 3.2: -10 log10 PMSE
// with
//   PMSE = 1/Nn * sum over vertices of 1/3 * sum over axes of (difference / R)^2,
// Nn the number of vertices that moved since the previous frame, R the largest displacement of
// a vertex between adjacent frames of the whole animation. Cases that the paper leaves
// undefined: in the first frame, and if no vertex moved, Nn is the number of vertices; if
// nothing moves in the whole animation, R is the diagonal of the bounding box.
class MetricsAccumulator {
 public:
  // kTotals keeps no metrics of single frames, so that memory does not grow with their number.
  enum Keep : std::uint8_t { kFrames, kTotals };
  explicit MetricsAccumulator(std::uint32_t num_vertices,  // at least 1
                              Keep keep = kFrames);

  // Sets the original of the frame before the first one, which is not counted.
  void follow(std::span<const double> original) {
    previous_.assign(original.begin(), original.end());
  }
  std::span<const double> last_original() const { return previous_; }
  // Adds the next frame; both have 3 * num_vertices finite values in the same vertex order. The
  // original may be finer than floats. normals: the deviation of its vertex normals, if it was
  // measured.
  void add_frame(std::span<const double> original, std::span<const float> decoded,
                 const SquaredAngles& normals = {});
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Adds the frames of `next`, at least one, which has kFrames and follows the last frame here.
  // The result is bit-exactly that of adding them here.
  void append(const MetricsAccumulator& next);

  // Returns the metrics of all frames so far, at least one.
  Metrics result() const;

 private:
  void add_motion(std::span<const double> original, FrameMetrics& frame);
  void add_to_totals(const FrameMetrics& frame);
  double mean_squared(const FrameMetrics& frame) const;
  double sequence_spread() const;
  void finish_psnr(Metrics& metrics) const;

  std::uint32_t num_vertices_;
  Keep keep_;
  std::vector<FrameMetrics> frames_;
  std::uint32_t num_frames_ = 0;
  Metrics totals_;  // only the maximum errors so far
  double squared_error_ = 0;
  double spread_ = 0;
  SquaredAngles normals_;
  std::array<double, 3> first_mean_ = {};
  std::array<double, 3> mean_sum_ = {};  // sum of the means of frames, relative to the first
  double squared_mean_sum_ = 0;
  double log_sum_ = 0;  // sum of log10(mean_squared()) over inexact frames
  std::uint32_t num_inexact_ = 0;
  std::vector<double> previous_;
  double max_squared_displacement_ = 0;
  double box_min_[3] = {};
  double box_max_[3] = {};
};

// Returns bits per vertex per frame, from the size of a file.
double bits_per_vertex_per_frame(std::uint64_t file_bytes, std::uint64_t num_vertices,
                                 std::uint64_t num_frames);

}  // namespace rlpc
