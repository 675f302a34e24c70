// Distortion of a decoded animation against the original, vertex by vertex.
//
// A pure function of the values fed to it: sums run in index order, per frame and then over the
// frames, and only PSNR uses a library function other than a square root. Whoever feeds the
// same frames gets the same digits.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rlpc {

struct FrameMetrics {
  double squared_error = 0;  // sum over vertices of the squared distance
  double spread = 0;         // of the original about its mean, likewise
  double rms_error = 0;      // units
  double max_error = 0;      // units
  std::uint32_t max_error_vertex = 0;
  std::uint32_t moved_vertices = 0;  // since the frame before, in the original; frame 0: all
  double psnr_db = 0;                // infinite if the frame is exact
};

struct Metrics {
  std::uint32_t num_vertices = 0;
  // 100 * ||A - A'||_F / ||A - E(A)||_F, E(A) the mean vertex of each frame. Infinite if the
  // vertices of every frame coincide but the decoded ones differ from them; 0 if they do not.
  double kg_error_percent = 0;
  double rms_error = 0;          // root of the mean squared distance over vertices and frames
  double rms_error_percent = 0;  // of the diagonal; infinite if that is 0 and the error is not
  double max_error = 0;
  double max_error_percent = 0;
  std::uint32_t max_error_frame = 0;  // the first frame and vertex that reach it
  std::uint32_t max_error_vertex = 0;
  double diagonal = 0;               // of the original's bounding box over all frames
  double max_displacement = 0;       // of a vertex of the original from one frame to the next
  double mean_psnr_db = 0;           // over the frames that are not exact; infinite if all are
  std::vector<FrameMetrics> frames;  // empty if they were not to be kept
};

// PSNR is that of Ramanathan, Kassim and Tan 2008, section 3.2: -10 log10 PMSE with
//   PMSE = 1/Nn * sum over vertices of 1/3 * sum over axes of (difference / R)^2,
// Nn the number of vertices that moved since the frame before, R the largest displacement of a
// vertex from one frame to the next in the whole animation. Where the paper leaves it
// undefined: if no vertex moved, and in the first frame, Nn is the number of vertices; if
// nothing moves in the whole animation, R is the diagonal of the bounding box.
class MetricsAccumulator {
 public:
  // kTotals keeps nothing of each frame, so that memory does not grow with them.
  enum Keep : std::uint8_t { kFrames, kTotals };
  explicit MetricsAccumulator(std::uint32_t num_vertices,  // at least 1
                              Keep keep = kFrames);

  // Both 3 * num_vertices finite values in the same vertex order; frames in order.
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Of the frames so far, at least one.
  Metrics result() const;

 private:
  void add_motion(std::span<const float> original, FrameMetrics& frame);
  void add_to_totals(const FrameMetrics& frame);
  double mean_squared(const FrameMetrics& frame) const;
  void finish_psnr(Metrics& metrics) const;

  std::uint32_t num_vertices_;
  Keep keep_;
  std::vector<FrameMetrics> frames_;
  std::uint32_t num_frames_ = 0;
  Metrics totals_;  // largest errors, so far
  double squared_error_ = 0;
  double spread_ = 0;
  double log_sum_ = 0;  // of log10 of mean_squared, over frames that are not exact
  std::uint32_t num_inexact_ = 0;
  std::vector<float> previous_;
  double max_squared_displacement_ = 0;
  float box_min_[3] = {};
  float box_max_[3] = {};
};

// Bits per vertex per frame of a file, everything in it counted.
double bits_per_vertex_per_frame(std::uint64_t file_bytes, std::uint64_t num_vertices,
                                 std::uint64_t num_frames);

}  // namespace rlpc
