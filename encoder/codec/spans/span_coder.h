// The interface that encodes a span of frames at varying quantiser steps, for all kinds of GOF.
// A span is one GOF, or in the High profile, several that can share a shared rig.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/frame_order.h"
#include "common/codec/syntax/stream_format.h"

namespace rlpc {

// Writes the positions [num_vertices][3] of frame f of a span exactly as a decoder outputs
// them. Several threads may call it at once.
using DecodeFrame = std::function<void(std::uint32_t f, std::span<std::int32_t> positions)>;
// Makes the function that decodes a span with only its first temporal layers, at least 1.
using DecodeCut = std::function<DecodeFrame(int layers)>;

// tuned (off: 1): An analysis made for one step is used for all steps within this factor. A
// narrower range means more analyses, and more jumps of the error.
inline constexpr double kAnalysisServes = 1.44;

// tuned (off: 1): The principal components of a draft serve other drafts for all steps within
// this factor.
inline constexpr double kDraftServes = 3.0;

// Whether two steps are within a factor of each other.
constexpr bool is_within(double factor, double a, double b) {
  return a < factor * b && b < factor * a;
}

// The rig_idx of all shared rigs: each replaces the one before.
inline constexpr std::uint32_t kRigIdx = 0;  // fixed: any value would do

// A shared rig as it was coded, with everything that later spans need to use it.
struct KeptRig;

// Choices for an inter GOF.
struct InterChoice {
  FramePattern pattern;
  std::uint32_t num_patches = 0;
  double step_scale = 1.0;  // factor of the steps, so that all choices have about one error

  bool operator==(const InterChoice&) const = default;
};

struct SpanCost {
  double bits = 0.0;
  double squared_error = 0.0;  // squared grid steps, of all values
};

// One encoding of a span.
struct EncodedSpan {
  struct Unit {
    UnitType type;
    std::vector<std::uint8_t> payload;
    std::uint32_t temporal_layer_idx = 0;  // set in slice and frame units
  };
  // In the order of the stream: a shared rig and its slices, if the GOFs use one; then each
  // GOF unit, with its slices.
  std::vector<Unit> units;
  DecodeFrame frame;
  DecodeCut cut;  // empty: only one temporal layer
  // The shared rig among the units, if later spans may use it; otherwise null.
  std::shared_ptr<const KeptRig> rig;
  // Squared error of all frames, in squared grid steps; none: not known.
  std::optional<double> squared_error;
  std::vector<InterChoice> choices;   // [inter GOF]
  std::uint64_t num_factors = 0;      // largest NumFactors (of the specification) of a GOF
  std::uint64_t adaptive_values = 0;  // adaptive factors times vertices
  std::uint32_t clusters = 0;         // clusters of all GOFs, or bones
  std::uint32_t max_clusters = 0;     // largest number in a GOF
  std::uint32_t components = 0;       // components of all clusters, or trajectories
  std::uint32_t max_components = 0;   // components of the largest cluster, or trajectories
};

// Encodes one span, repeatedly. Choices made for it last as long as the coder. The analysis of
// the last step is large; it can be released, and is recomputed when needed.
class SpanCoder {
 public:
  // Receives the fraction done, 0 to 1, of choices and first encoding; called by any thread.
  using Progress = std::function<void(double)>;

  virtual ~SpanCoder() = default;
  // Sets a progress function for long work, before the first call of another member.
  virtual void set_progress(const Progress& /*progress*/) {}
  // Runs the analysis that encode() starts with, if expected_error() depends on it.
  virtual void analyse(double /*analysis_step*/) {}
  // Estimates the squared error of encode(step) from the last analysis. The ratio of actual to
  // estimated error is almost independent of the step. None: no estimate is available.
  virtual std::optional<double> expected_error(double /*step*/) const { return std::nullopt; }
  // Whether encode() would read the frames; if not, the caller may have freed them.
  virtual bool needs_frames(double step, double analysis_step) const = 0;
  // Encodes the span. step: quantiser step, in grid steps. analysis_step: the nearby step to
  // analyse for; an analysis is reused as long as analysis_step stays the same.
  virtual EncodedSpan encode(double step, double analysis_step) = 0;
  virtual void release_analysis() = 0;
  // Codes as many components from now on as in the last encoding: the error then follows the
  // step without jumps.
  virtual void keep_num_components() {}
  // Returns a step at which encode() can be expected to err about as much as another encoding
  // of the span, and `step` where that is not known; none if it can be expected to cost clearly
  // more there.
  virtual std::optional<double> step_in_reach(double step, const SpanCost& /*rival*/) {
    return step;
  }
  // Whether several kinds of GOF have been encoded, as none was clearly the best.
  virtual bool is_contested() const { return false; }
};

}  // namespace rlpc
