// Searches for the quantiser step at which a batch of GOFs meets its target.
#pragma once

#include <cstdint>
#include <functional>

#include "encoder/codec/report.h"
#include "encoder/codec/sequence/rival.h"
#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/sequence/target/target_search.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

// Returns a search for the target of the settings, in grid steps of the header. rms_spread: RMS
// of the coordinates about the mean of their frame, over all frames of the batch, in units.
TargetSearch search_for(const EncoderSettings& settings, const SequenceHeader& header,
                        double rms_spread);

struct TargetTask {
  const EncoderSettings& settings;
  const SequenceHeader& header;
  double rms_spread = 0.0;   // RMS of coordinates about the mean of their frame, units
  double fixed_bits = 0.0;   // bits outside the GOFs that count towards a rate
  double first_step = 0.0;   // step of the first trial, grid steps; 0: chosen by the search
  bool keeps_level = false;  // reject a last resort that needs a higher level than the header
  const Rival* rival = nullptr;  // result to beat; null: none
  // Called with the number of the trial, from 1, and the fraction of it that is done.
  std::function<void(std::uint32_t trial, double done)> progress = {};
};

struct TargetResult {
  BatchTrial trial;       // the best trial
  double step = 0.0;      // its quantiser step, grid steps
  double measured = 0.0;  // its error or rate, in the unit of the target
  bool met = false;       // it does not exceed the target
  std::uint32_t trials = 0;
  bool contested = false;  // SpanBatch::is_contested()
  bool given_up = false;   // the search was not expected to beat the rival
};

// Runs the search. If it misses the target, searches again without shared rigs of earlier
// spans; then, for a rate, with the choices of the last step; then with the last resort of the
// batch. Errors: errors of the batch.
InputResult<TargetResult> reach_target(const TargetTask& task, SpanBatch& batch);

}  // namespace rlpc
