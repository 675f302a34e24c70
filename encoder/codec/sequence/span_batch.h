// Spans that share one target: all spans of a sequence, or a single one when frames arrive one
// by one.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "encoder/codec/attributes/normal_error.h"
#include "encoder/codec/metrics/metrics.h"
#include "encoder/codec/sequence/choices/gof_cuts.h"
#include "encoder/codec/sequence/choices/level_choice.h"
#include "encoder/codec/sequence/sequence_coding.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/spans/span_coder.h"

namespace rlpc {

// The result of encoding a span at one step.
struct SpanResult {
  std::vector<GofBytes> gofs;
  LevelNeeds needs;
  std::uint32_t clusters = 0;    // total of all GOFs
  std::uint32_t components = 0;  // total of all GOFs
  DecodeFrame frame;             // empty unless Options::keep_decoded
  // The new shared rig of the span; null: none, or Options::keep_decoded is not set.
  std::shared_ptr<const KeptRig> rig;
  DecodeCut cut;                     // empty for GOFs with one temporal layer
  std::vector<InterChoice> choices;  // [inter GOF]
  // Frames of the sequence that Options::kept_frames lists, ascending.
  std::vector<DecodedFrame> kept{};
};

// Adds the choices for GOFs to the counts.
void count_patterns(const std::vector<InterChoice>& choices, std::vector<PatternCount>& counts);

// All spans of a batch, encoded at one step.
struct BatchTrial {
  std::vector<SpanResult> spans;
  std::uint64_t gof_bytes = 0;
  Metrics metrics;  // all spans together
};

class SpanBatch {
 public:
  struct Options {
    std::uint32_t first_frame = 0;  // position in the stream of frame 0 of the source
    bool keep_analyses = true;      // until the next encode(); choices are always kept
    bool keep_decoded = false;      // set SpanResult::frame and rig
    std::vector<std::uint32_t> kept_frames{};  // frames for SpanResult::kept, ascending
    // The shared rig in force before the batch; null: none.
    std::shared_ptr<const KeptRig> rig = nullptr;
    bool has_followers = false;  // further batches may use the rig in force after it
    // Number of spans encoded at a time if later ones may use shared rigs of earlier ones.
    // Affects memory only.
    std::uint32_t together = 1;
    MetricsAccumulator::Keep metrics = MetricsAccumulator::kFrames;
  };

  // spans: frames of the source. Keeps references to coding and source.
  SpanBatch(const SequenceCoding& coding, FrameSource& source,
            const std::vector<FrameRange>& spans, const Options& options);

  std::uint32_t num_frames() const;
  // Encodes all GOFs from now on with the kind reserved for targets that the others miss.
  // Returns false if there is no such kind.
  bool use_last_resort();
  // Forgets the choices of earlier steps: the next one decides.
  void choose_again();
  // Calls SpanCoder::keep_num_components() for all spans.
  void keep_num_components();
  // Whether some spans use shared rigs of earlier ones.
  bool uses_earlier_rigs() const;
  // Whether any span has been encoded as several kinds of GOF, as none was clearly the best.
  bool is_contested() const;
  // Gives each span a shared rig of its own from now on. Returns false if all had one before.
  bool use_own_rigs();
  // Receives the fraction done of the analyses and the encoding that follows, from time to
  // time; called by any thread, one at a time.
  using Progress = std::function<void(double)>;
  // Analyses all GOFs if analyses are kept. Errors: errors of the source.
  std::optional<InputError> analyse(double analysis_step, const Progress& progress = {});
  // Estimates the squared error of all GOFs at a step from their last analyses; empty if any
  // GOF has no estimate.
  std::function<double(double step)> expected_error() const;
  // Encodes all spans. Steps as in SpanCoder::encode(). Errors: errors of the source.
  InputResult<BatchTrial> encode(double step, double analysis_step,
                                 const Progress& progress = {});

 private:
  // Owner of the rig whose vertices a span uses; not known before its first encoding.
  enum class Vertices : std::uint8_t { kUndecided, kOwn, kEarlier };

  struct Span {
    FrameRange range{};
    bool has_followers = false;  // later spans may use its shared rig
    SpanFrames frames;           // empty while they are not needed
    std::unique_ptr<SpanCoder> coder;
    Vertices vertices = Vertices::kOwn;
    double done = 0.0;  // fraction of its analysis and encoding
  };

  // Spans of the batch: `count` of them, from `first` on.
  struct SpanRange {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  struct MeasuredSpan {
    SpanResult coded;
    MetricsAccumulator metrics;
    double cost = 0.0;  // Lagrangian; set while Vertices are undecided
  };
  using Measured = std::vector<std::optional<MeasuredSpan>>;  // [span]
  using Rigs = std::vector<std::shared_ptr<const KeptRig>>;

  void set_done(Span& span, double done);
  std::optional<InputError> read(Span& span);
  std::optional<InputError> prepare(Span& span, double step, double analysis_step);
  InputResult<MeasuredSpan> measure(Span& span, const EncodedSpan& encoded);
  InputResult<MeasuredSpan> encode(Span& span, double step, double analysis_step);
  InputResult<std::optional<MeasuredSpan>> encode_with(const KeptRig& rig, Span& span,
                                                       double step, double max_cost);
  std::optional<InputError> decide(const std::shared_ptr<const KeptRig>& rig, Span& span,
                                   double step, std::optional<MeasuredSpan>& measured);
  bool is_better(const MeasuredSpan& with_rig, const MeasuredSpan& own) const;
  std::optional<InputError> encode_some(SpanRange spans, double step, double analysis_step,
                                        std::shared_ptr<const KeptRig>& rig,
                                        Measured& measured);

  const SequenceCoding& coding_;
  FrameSource& source_;
  std::mutex reading_;  // held while a thread reads from the source
  Options options_;
  std::vector<Span> spans_;
  std::mutex counting_;  // held while the fractions done are changed or read
  Progress progress_;
  bool is_last_resort_ = false;
};

}  // namespace rlpc
