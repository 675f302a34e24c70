// The search for the step at which a batch of GOFs meets its target.
#pragma once

#include <cstdint>
#include <functional>

#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/gof_batch.h"
#include "encoder/sequence/target_search.h"

namespace rlpc {

// rms_spread: of a coordinate about the mean of its frame, units, over the frames that the
// target is for.
TargetSearch search_for(const EncoderSettings& settings, const SequenceHeader& header,
                        double rms_spread);

struct TargetTask {
  const EncoderSettings& settings;
  const SequenceHeader& header;
  double rms_spread = 0.0;   // of a coordinate about the mean of its frame, units
  double fixed_bits = 0.0;   // that count towards a rate beside the GOFs
  double first_step = 0.0;   // to begin with, grid steps; 0: unknown
  bool keeps_level = false;  // that of the header: a last resort must not need a higher one
  // Called with the trial, from 1, and the fraction of it that is done.
  std::function<void(std::uint32_t trial, double done)> progress = {};
};

struct TargetResult {
  BatchTrial trial;       // the best
  double step = 0.0;      // that it was made with, grid steps
  double measured = 0.0;  // the error or rate that is searched for
  bool met = false;       // the target
  std::uint32_t trials = 0;
};

// Where the target is out of reach of the kinds of GOF that are compared, the last resort of
// the batch is searched too. Error: that of the batch.
InputResult<TargetResult> reach_target(const TargetTask& task, GofBatch& batch);

}  // namespace rlpc
