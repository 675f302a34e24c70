#include "encoder/codec/metrics/metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace rlpc {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class T>
double squared_distance(std::span<const double> a, std::span<const T> b, std::size_t vertex) {
  double sum = 0;
  for (std::size_t i = 3 * vertex; i < 3 * vertex + 3; ++i) {
    const double d = a[i] - static_cast<double>(b[i]);
    sum += d * d;
  }
  return sum;
}

// Sets the mean vertex, and the sum of squared distances from it. Coordinates are taken
// relative to the first vertex, so that the sum is exactly 0 if all vertices coincide.
void measure_spread(std::span<const double> xyz, FrameMetrics& frame) {
  const std::size_t count = xyz.size() / 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double first = xyz[axis];
    double sum = 0;
    for (std::size_t v = 0; v < count; ++v) sum += xyz[3 * v + axis] - first;
    const double mean = sum / static_cast<double>(count);
    frame.mean[axis] = first + mean;
    for (std::size_t v = 0; v < count; ++v) {
      const double d = xyz[3 * v + axis] - first - mean;
      frame.spread += d * d;
    }
  }
}

// Returns 100 * part / whole; 0 / 0 is 0.
double percent(double part, double whole) {
  if (whole > 0) return 100 * part / whole;
  return part > 0 ? kInfinity : 0;
}

double diagonal_psnr(double diagonal, double rms_error) {
  return rms_error > 0 ? 20 * std::log10(diagonal / rms_error) : kInfinity;
}

}  // namespace

MetricsAccumulator::MetricsAccumulator(std::uint32_t num_vertices, Keep keep)
    : num_vertices_(num_vertices), keep_(keep) {
  assert(num_vertices > 0);
}

void MetricsAccumulator::add_frame(std::span<const float> original,
                                   std::span<const float> decoded) {
  const std::vector<double> exact(original.begin(), original.end());
  add_frame(std::span<const double>(exact), decoded);
}

void MetricsAccumulator::add_frame(std::span<const double> original,
                                   std::span<const float> decoded,
                                   const SquaredAngles& normals) {
  assert(original.size() == 3 * std::size_t{num_vertices_} &&
         decoded.size() == original.size());
  FrameMetrics frame;
  double max_squared = 0;
  for (std::uint32_t v = 0; v < num_vertices_; ++v) {
    const double squared = squared_distance(original, decoded, v);
    frame.squared_error += squared;
    if (squared > max_squared) {
      max_squared = squared;
      frame.max_error_vertex = v;
    }
  }
  measure_spread(original, frame);
  frame.rms_error = std::sqrt(frame.squared_error / num_vertices_);
  frame.max_error = std::sqrt(max_squared);
  frame.normals = normals;
  for (std::size_t i = 0; i < original.size(); ++i) {
    const bool first = num_frames_ == 0 && i < 3;
    box_min_[i % 3] = first ? original[i] : std::min(box_min_[i % 3], original[i]);
    box_max_[i % 3] = first ? original[i] : std::max(box_max_[i % 3], original[i]);
  }
  add_motion(original, frame);
  add_to_totals(frame);
  if (keep_ == kFrames) frames_.push_back(frame);
}

void MetricsAccumulator::add_to_totals(const FrameMetrics& frame) {
  squared_error_ += frame.squared_error;
  spread_ += frame.spread;
  normals_ += frame.normals;
  if (num_frames_ == 0) first_mean_ = frame.mean;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double moved = frame.mean[axis] - first_mean_[axis];
    mean_sum_[axis] += moved;
    squared_mean_sum_ += moved * moved;
  }
  if (frame.max_error > totals_.max_error) {
    totals_.max_error = frame.max_error;
    totals_.max_error_frame = num_frames_;
    totals_.max_error_vertex = frame.max_error_vertex;
  }
  if (frame.squared_error > 0) {
    log_sum_ += std::log10(mean_squared(frame));
    ++num_inexact_;
  }
  ++num_frames_;
}

// Returns the PMSE of a frame for R = 1.
double MetricsAccumulator::mean_squared(const FrameMetrics& frame) const {
  const double vertices = frame.moved_vertices > 0 ? frame.moved_vertices : num_vertices_;
  return frame.squared_error / (3 * vertices);
}

void MetricsAccumulator::add_motion(std::span<const double> original, FrameMetrics& frame) {
  frame.moved_vertices = 0;
  const bool is_first = previous_.empty();
  for (std::uint32_t v = 0; !is_first && v < num_vertices_; ++v) {
    const double squared = squared_distance<double>(original, previous_, v);
    max_squared_displacement_ = std::max(max_squared_displacement_, squared);
    if (squared > 0) ++frame.moved_vertices;
  }
  if (is_first) frame.moved_vertices = num_vertices_;
  previous_.assign(original.begin(), original.end());
}

void MetricsAccumulator::append(const MetricsAccumulator& next) {
  assert(next.num_frames_ > 0 && next.frames_.size() == next.num_frames_);
  const bool is_first = num_frames_ == 0;
  for (std::size_t c = 0; c < 3; ++c) {
    box_min_[c] = is_first ? next.box_min_[c] : std::min(box_min_[c], next.box_min_[c]);
    box_max_[c] = is_first ? next.box_max_[c] : std::max(box_max_[c], next.box_max_[c]);
  }
  max_squared_displacement_ =
      std::max(max_squared_displacement_, next.max_squared_displacement_);
  for (const FrameMetrics& frame : next.frames_) {
    add_to_totals(frame);
    if (keep_ == kFrames) frames_.push_back(frame);
  }
  previous_ = next.previous_;
}

// Returns the sum of squared distances from the mean of all frames: the distances from the mean
// of each frame, and those of the means. Exactly the former if the means coincide.
double MetricsAccumulator::sequence_spread() const {
  double between = squared_mean_sum_;
  for (const double sum : mean_sum_) between -= sum * sum / num_frames_;
  return spread_ + std::max(between, 0.0) * num_vertices_;
}

Metrics MetricsAccumulator::result() const {
  assert(num_frames_ > 0);
  Metrics m = totals_;
  m.num_vertices = num_vertices_;
  m.frames = frames_;
  double squared_diagonal = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double side = box_max_[axis] - box_min_[axis];
    squared_diagonal += side * side;
  }
  m.diagonal = std::sqrt(squared_diagonal);
  const double count = static_cast<double>(num_frames_) * num_vertices_;
  const double sequence = sequence_spread();
  m.kg_error_percent = percent(std::sqrt(squared_error_), std::sqrt(spread_));
  m.kg_sequence_error_percent = percent(std::sqrt(squared_error_), std::sqrt(sequence));
  m.rms_error = std::sqrt(squared_error_ / count);
  m.rms_spread = std::sqrt(spread_ / count);
  m.rms_sequence_spread = std::sqrt(sequence / count);
  m.rms_error_percent = percent(m.rms_error, m.diagonal);
  m.max_error_percent = percent(m.max_error, m.diagonal);
  if (normals_.weight > 0.0) m.vertex_normals = normals_.rms();
  m.max_displacement = std::sqrt(max_squared_displacement_);
  finish_psnr(m);
  return m;
}

void MetricsAccumulator::finish_psnr(Metrics& metrics) const {
  const double peak =
      metrics.max_displacement > 0 ? metrics.max_displacement : metrics.diagonal;
  for (FrameMetrics& frame : metrics.frames) {
    frame.diagonal_psnr_db = diagonal_psnr(metrics.diagonal, frame.rms_error);
    // If the peak is 0, the quotient is infinite, and PSNR minus infinity.
    frame.ramanathan_psnr_db = frame.squared_error > 0
                                   ? -10 * std::log10(mean_squared(frame) / (peak * peak))
                                   : kInfinity;
  }
  metrics.diagonal_psnr_db = diagonal_psnr(metrics.diagonal, metrics.rms_error);
  metrics.ramanathan_psnr_db =
      num_inexact_ > 0 ? 20 * std::log10(peak) - 10 * log_sum_ / num_inexact_ : kInfinity;
}

double bits_per_vertex_per_frame(std::uint64_t file_bytes, std::uint64_t num_vertices,
                                 std::uint64_t num_frames) {
  assert(num_vertices > 0 && num_frames > 0);
  return 8 * static_cast<double>(file_bytes) /
         (static_cast<double>(num_vertices) * static_cast<double>(num_frames));
}

}  // namespace rlpc
