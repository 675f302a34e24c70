#include "encoder/codec/sequence/rival.h"

#include <algorithm>
#include <cstddef>

#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

struct Frames {
  std::uint32_t first = 0;
  std::uint32_t end = 0;
};

// Returns the bytes that a stream spends on some frames. Bytes of a GOF, and of a shared rig,
// are divided equally among their frames.
double bytes_of(const BatchTrial& trial, const Frames& frames) {
  const auto part_of = [&](std::uint32_t first, std::uint32_t count) {
    const std::uint32_t from = std::max(first, frames.first);
    const std::uint32_t to = std::min(first + count, frames.end);
    return from < to ? static_cast<double>(to - from) / count : 0.0;
  };
  double bytes = 0.0;
  std::uint32_t first = 0;
  for (const SpanResult& span : trial.spans) {
    const std::uint32_t span_first = first;
    double rig_bytes = 0.0;
    for (const GofBytes& gof : span.gofs) {
      const auto gof_bytes = static_cast<double>(gof.size() - gof.rig.size());
      bytes += gof_bytes * part_of(first, gof.num_frames);
      rig_bytes += static_cast<double>(gof.rig.size());
      first += gof.num_frames;
    }
    bytes += rig_bytes * part_of(span_first, first - span_first);
  }
  return bytes;
}

// Returns the squared error of some frames, in the measure of the target.
double error_of(const Target& target, const Metrics& metrics, const Frames& frames) {
  double sum = 0.0;
  double largest = 0.0;
  for (std::uint32_t f = frames.first; f < frames.end; ++f) {
    sum += metrics.frames[f].squared_error;
    largest = std::max(largest, metrics.frames[f].max_error);
  }
  return target.kind == Target::kMaxError ? largest * largest : sum;
}

}  // namespace

bool Rival::is_out_of_reach(const BatchTrial& trial, std::uint32_t first, double far) const {
  // tuned (off: 0): The rate is a power of the squared error that differs from kRateOfError by
  // up to this much.
  constexpr double kUncertain = 0.3;
  constexpr double kMinError = 1e-30;  // fixed: above zero
  const auto count = static_cast<std::uint32_t>(trial.metrics.frames.size());
  const Frames frames{first, first + count};
  const double error = std::max(error_of(target_, trial.metrics, {0, count}), kMinError);
  const double other = std::max(error_of(target_, best_.metrics, frames), kMinError);
  const double apart = std::max(error / other, other / error);
  return bits_at_equal_error(bytes_of(trial, {0, count}), error / other) >
         far * det_exp2(kUncertain * det_log2(apart)) *
             bits_at_equal_error(bytes_of(best_, frames), 1.0);
}

bool Rival::has_high_rank() const {
  // fixed: Like kManyTrajectories, from which inter GOFs are tried, but lower, as not all
  // expected trajectories are coded.
  constexpr double kMany = 0.2;
  return std::any_of(best_.spans.begin(), best_.spans.end(), [&](const SpanResult& span) {
    std::uint32_t num_frames = 0;
    for (const GofBytes& gof : span.gofs) num_frames += gof.num_frames;
    const std::uint32_t max = std::min(best_.metrics.num_vertices, 3 * num_frames);
    return !span.choices.empty() || span.components >= kMany * max;
  });
}

}  // namespace rlpc
