// GOFs that meet one target together: all of a sequence, or one of frames that arrive one by
// one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "encoder/gof/gof_coder.h"
#include "encoder/metrics/metrics.h"
#include "encoder/sequence/gof_cuts.h"
#include "encoder/sequence/level_choice.h"
#include "encoder/sequence/sequence_coding.h"
#include "encoder/sequence/stream_assembly.h"

namespace rlpc {

// A GOF as it was coded at some step.
struct CodedGof {
  GofBytes bytes;
  LevelNeeds needs;
  std::uint32_t clusters = 0;
  std::uint32_t components = 0;
  DecodeFrame frame;  // empty unless it was to be kept
};

struct BatchTrial {
  std::vector<CodedGof> gofs;
  std::uint64_t gof_bytes = 0;
  Metrics metrics;  // of all GOFs together
};

class GofBatch {
 public:
  struct Options {
    std::uint32_t first_frame = 0;  // of the source, in the stream
    bool keep_analyses = true;      // from one step to the next; else only what is chosen
    bool keep_decoded = false;      // CodedGof::frame
    MetricsAccumulator::Keep metrics = MetricsAccumulator::kFrames;
  };

  // spans: of the source. coding and source are kept by reference.
  GofBatch(const SequenceCoding& coding, FrameSource& source, const std::vector<GofSpan>& spans,
           const Options& options);

  std::uint32_t num_frames() const;
  // From now on, encodes all GOFs by the kind that is left when others fail a target. False:
  // there is none.
  bool use_last_resort();
  // Analyses all GOFs, if analyses are kept. Error: that of the source.
  std::optional<InputError> analyse(double analysis_step);
  // Squared error of all GOFs at a step, by their last analyses; empty where one tells nothing.
  std::function<double(double step)> expected_error() const;
  // Called after each GOF with the fraction done.
  using Progress = std::function<void(double)>;
  // Error: that of the source.
  InputResult<BatchTrial> encode(double step, double analysis_step, const Progress& progress);

 private:
  struct Gof {
    GofSpan span{};
    GofFrames frames;  // while they are needed
    std::unique_ptr<GofCoder> coder;
  };

  std::optional<InputError> prepare(Gof& gof, double step, double analysis_step);
  InputResult<CodedGof> encode(Gof& gof, double step, double analysis_step,
                               MetricsAccumulator& metrics);

  const SequenceCoding& coding_;
  FrameSource& source_;
  Options options_;
  std::vector<Gof> gofs_;
  bool is_last_resort_ = false;
};

}  // namespace rlpc
