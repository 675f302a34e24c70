// Implements encode() of encoder/rlpc_encoder.h: a whole sequence, to its target.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "encoder/math/det_math.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/check_settings.h"
#include "encoder/sequence/gof_cuts.h"
#include "encoder/sequence/grid_choice.h"
#include "encoder/sequence/level_choice.h"
#include "encoder/sequence/sequence_coding.h"
#include "encoder/sequence/stream_assembly.h"
#include "encoder/sequence/target_search.h"

namespace rlpc {
namespace {

// Searches keep the analyses of all GOFs if their frames take no more than this many bytes.
constexpr std::uint64_t kKeepBytes = std::uint64_t{1} << 30;

// One encoding of the whole sequence.
struct SequenceTrial {
  std::vector<GofBytes> gofs;
  std::uint64_t gof_bytes = 0;
  std::uint32_t clusters = 0;
  std::uint32_t components = 0;
  Metrics metrics;
  std::uint32_t level_idc = 0;
  std::optional<InputError> beyond_levels;
};

class SequenceEncoder {
 public:
  SequenceEncoder(FrameSource& source, const EncoderSettings& settings,
                  const Progress& progress)
      : source_(source), settings_(settings), progress_(progress) {}

  InputResult<EncodeReport> run(const ByteSink& sink);

 private:
  struct GofState {
    GofFrames frames;
    std::unique_ptr<GofCoder> coder;
    GofMemory memory;
  };

  // The best encoding of a search.
  struct Found {
    SequenceTrial trial;
    double step = 0.0;  // grid steps
    bool met = false;   // within the target
  };

  std::optional<InputError> prepare();
  // Replaces the header that prepare() has made.
  void use_header(const SequenceHeader& header);
  std::optional<InputError> cut_gofs(std::uint32_t longest);
  InputResult<Found> search();
  std::optional<InputError> search_on_finer_grid(Found& best);
  InputResult<SequenceTrial> encode_at(double step, double analysis_step);
  std::optional<InputError> begin(TargetSearch& search);
  TargetSearch::Expected expected() const;
  std::optional<InputError> prepare_coder(std::size_t g, double step, double analysis_step);
  std::optional<InputError> encode_gof(std::size_t g, double step, double analysis_step,
                                       SequenceTrial& trial, MetricsAccumulator& metrics);
  double measured(const SequenceTrial& trial) const;
  InputResult<EncodeReport> write(SequenceTrial trial, double step, const ByteSink& sink);

  FrameSource& source_;
  const EncoderSettings& settings_;
  const Progress& progress_;
  SequenceHeader header_;
  Extent extent_;
  std::vector<GofSpan> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;
  std::vector<GofState> gofs_;
  bool keep_coders_ = false;
  std::uint32_t trials_ = 0;
};

std::optional<InputError> SequenceEncoder::prepare() {
  header_.profile_idc = settings_.profile == Profile::kMain ? kProfileMain : kProfileBaseline;
  header_.num_vertices = source_.num_vertices();
  header_.num_triangles = static_cast<std::uint32_t>(source_.triangles().size());
  header_.num_frames = source_.num_frames();
  header_.frame_rate = source_.frame_rate();
  const auto extent = measure_extent(source_);
  if (!extent) return extent.error();
  extent_ = *extent;
  set_grid(header_, choose_grid(extent_, finest_error(settings_.target, extent_.rms_spread)));

  if (auto error = cut_gofs(longest_gof(settings_))) return error;
  std::uint32_t longest = 0;
  for (const GofSpan& span : spans_) longest = std::max(longest, span.count);
  if (auto error = choose_level(header_, longest)) return error;
  gofs_.resize(spans_.size());
  keep_coders_ = std::uint64_t{header_.num_vertices} * header_.num_frames * 24 <= kKeepBytes;
  coding_.emplace(header_, settings_, source_.triangles());
  stream_.emplace(header_, settings_, coding_->connectivity());
  return std::nullopt;
}

// By expected cost where there is time for it, and a step to expect.
std::optional<InputError> SequenceEncoder::cut_gofs(std::uint32_t longest) {
  if (header_.num_frames > kMaxFrames) {
    return InputError{"a sequence has at most " + std::to_string(kMaxFrames) +
                      " frames (specification, Annex B), not " +
                      std::to_string(header_.num_frames) + "; split it"};
  }
  if (header_.profile_idc != kProfileMain || settings_.preset == Preset::kFast) {
    spans_ = equal_gofs(header_.num_frames, longest);
    return std::nullopt;
  }
  const double step = search_for(settings_, header_, extent_.rms_spread).step();
  auto spans = cheapest_gofs(source_, longest, step * exact_exp2(header_.grid.log2_step));
  if (!spans) return spans.error();
  spans_ = std::move(*spans);
  return std::nullopt;
}

std::optional<InputError> SequenceEncoder::prepare_coder(std::size_t g, double step,
                                                         double analysis_step) {
  GofState& state = gofs_[g];
  const bool needed = !state.coder || state.coder->needs_frames(step, analysis_step);
  if (needed && state.frames.xyz.empty()) {
    auto frames = coding_->read_frames(source_, spans_[g]);
    if (!frames) return frames.error();
    state.frames = std::move(*frames);
  }
  if (!state.coder) {
    state.coder = coding_->make_coder(state.frames, spans_[g].first, state.memory);
  }
  return std::nullopt;
}

std::optional<InputError> SequenceEncoder::encode_gof(std::size_t g, double step,
                                                      double analysis_step,
                                                      SequenceTrial& trial,
                                                      MetricsAccumulator& metrics) {
  if (auto error = prepare_coder(g, step, analysis_step)) return error;
  GofState& state = gofs_[g];
  const EncodedGof encoded = state.coder->encode(step, analysis_step);
  if (!keep_coders_) state.coder.reset();
  if (!keep_coders_ || !state.coder->needs_frames(step, analysis_step)) state.frames = {};
  if (!trial.beyond_levels) {
    trial.beyond_levels = raise_level(trial.level_idc, LevelNeeds(encoded), spans_[g].count);
  }
  auto hash_unit = coding_->measure(source_, spans_[g], encoded, metrics);
  if (!hash_unit) return hash_unit.error();
  trial.gofs.push_back({spans_[g].count, write_gof_units(encoded), std::move(*hash_unit)});
  trial.gof_bytes += trial.gofs.back().size();
  trial.clusters += encoded.clusters;
  trial.components += encoded.components;
  return std::nullopt;
}

InputResult<SequenceTrial> SequenceEncoder::encode_at(double step, double analysis_step) {
  ++trials_;
  SequenceTrial trial;
  trial.level_idc = header_.level_idc;  // that the mesh needs
  MetricsAccumulator metrics(header_.num_vertices);
  for (std::size_t g = 0; g < spans_.size(); ++g) {
    if (auto error = encode_gof(g, step, analysis_step, trial, metrics)) return *error;
    if (progress_) {
      // A search converges: each trial is worth half of what is left.
      const double within = static_cast<double>(g + 1) / static_cast<double>(spans_.size());
      progress_(settings_.target.kind == Target::kNone
                    ? within
                    : 1.0 - exact_exp2(-static_cast<int>(trials_)) * (2.0 - within));
    }
  }
  trial.metrics = metrics.result();
  return trial;
}

double SequenceEncoder::measured(const SequenceTrial& trial) const {
  switch (settings_.target.kind) {
    case Target::kKg:
      return trial.metrics.kg_error_percent;
    case Target::kMaxError:
      return trial.metrics.max_error;
    case Target::kBpvf:
      return bits_per_vertex_per_frame(trial.gof_bytes + stream_->overhead_bytes(),
                                       header_.num_vertices, header_.num_frames);
    case Target::kNone:
      break;
  }
  return 0.0;
}

InputResult<EncodeReport> SequenceEncoder::write(SequenceTrial trial, double step,
                                                 const ByteSink& sink) {
  if (trial.beyond_levels) return *trial.beyond_levels;
  header_.level_idc = trial.level_idc;
  bool ok = stream_->write_lead(header_, sink);
  for (const GofBytes& gof : trial.gofs) ok = ok && stream_->write_gof(gof, sink);
  ok = ok && stream_->write_end(sink);
  if (!ok) return InputError{"the stream could not be written"};
  EncodeReport report;
  stream_->describe(header_, coding_->connectivity(), report);
  report.metrics = std::move(trial.metrics);
  report.clusters = trial.clusters;
  report.components = trial.components;
  if (settings_.baseline.qu == 0) report.step = step * exact_exp2(header_.grid.log2_step);
  report.trials = trials_;
  return report;
}

TargetSearch::Expected SequenceEncoder::expected() const {
  if (settings_.target.kind != Target::kKg || !keep_coders_) return {};
  std::vector<const GofCoder*> coders;
  for (const GofState& gof : gofs_) coders.push_back(gof.coder.get());
  const double spread = extent_.rms_spread * exact_exp2(-header_.grid.log2_step);
  return expected_kg(std::move(coders),
                     spread * spread * 3.0 * header_.num_vertices * header_.num_frames);
}

// With the step that analyses promise, where these are kept.
std::optional<InputError> SequenceEncoder::begin(TargetSearch& search) {
  if (settings_.target.kind != Target::kKg || !keep_coders_) return std::nullopt;
  for (std::size_t g = 0; g < spans_.size(); ++g) {
    if (auto error = prepare_coder(g, search.step(), search.analysis_step())) return error;
    gofs_[g].coder->analyse(search.analysis_step());
    gofs_[g].frames = {};
  }
  if (const auto by_analyses = expected()) search.begin_at(by_analyses);
  return std::nullopt;
}

InputResult<SequenceEncoder::Found> SequenceEncoder::search() {
  TargetSearch search = search_for(settings_, header_, extent_.rms_spread);
  if (auto error = begin(search)) return *error;
  Found best;
  for (bool is_first = true; !search.finished(); is_first = false) {
    auto trial = encode_at(search.step(), search.analysis_step());
    if (!trial) return trial.error();
    const bool better = search.report(measured(*trial), trial->gof_bytes, expected());
    if (better || is_first) {
      best.trial = std::move(*trial);
      best.step = search.last_step();
    }
  }
  best.met = search.met();
  return best;
}

void SequenceEncoder::use_header(const SequenceHeader& header) {
  header_ = header;
  coding_->follow_grid();
  stream_.emplace(header_, settings_, coding_->connectivity());
}

// What error a rate allows shows when it is reached: whether the grid was fine enough for it.
std::optional<InputError> SequenceEncoder::search_on_finer_grid(Found& best) {
  const double error = extent_.rms_spread * best.trial.metrics.kg_error_percent / 100.0;
  const GridChoice grid = choose_grid(extent_, error);
  if (grid.position_bits <= header_.position_bits) return std::nullopt;
  const SequenceHeader before = header_;
  SequenceHeader header = header_;
  set_grid(header, grid);
  use_header(header);
  gofs_ = std::vector<GofState>(spans_.size());
  auto finer = search();
  if (!finer) return finer.error();
  if (finer->met >= best.met &&
      finer->trial.metrics.kg_error_percent < best.trial.metrics.kg_error_percent) {
    best = std::move(*finer);
  } else {
    use_header(before);
  }
  return std::nullopt;
}

InputResult<EncodeReport> SequenceEncoder::run(const ByteSink& sink) {
  if (auto error = prepare()) return *error;
  auto best = search();
  if (!best) return best.error();
  if (settings_.target.kind == Target::kBpvf) {
    if (auto error = search_on_finer_grid(*best)) return *error;
  }
  const bool met = best->met;
  auto report = write(std::move(best->trial), best->step, sink);
  if (report) report->target_met = met;
  if (report && progress_) progress_(1.0);
  return report;
}

}  // namespace

InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress) {
  if (auto error = check_settings(settings)) return *error;
  return SequenceEncoder(source, settings, progress).run(sink);
}

}  // namespace rlpc
