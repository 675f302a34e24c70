// Implements encode() of encoder/rlpc_encoder.h: encodes a whole sequence to its target.
#include <algorithm>
#include <iterator>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "common/verify/stream_buffer.h"
#include "encoder/math/det_math.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/sequence/attribute_stage.h"
#include "encoder/sequence/check_settings.h"
#include "encoder/sequence/choices/gof_cuts.h"
#include "encoder/sequence/choices/grid_choice.h"
#include "encoder/sequence/choices/level_choice.h"
#include "encoder/sequence/choices/lossless_grid.h"
#include "encoder/sequence/gof_batch.h"
#include "encoder/sequence/sequence_coding.h"
#include "encoder/sequence/stream_assembly.h"
#include "encoder/sequence/stream_verifier.h"
#include "encoder/sequence/target_loop.h"

namespace rlpc {
namespace {

// Analyses of all GOFs are kept in memory if the frames, as doubles, take at most this many
// bytes.
constexpr std::uint64_t kKeepBytes = std::uint64_t{1} << 30;  // fixed: memory

bool keeps_analyses(const SequenceHeader& header) {
  return std::uint64_t{header.num_vertices} * 3 * sizeof(double) * header.num_frames <=
         kKeepBytes;
}

// Spans that are encoded at the same time: one for each thread, but no more positions than
// this, as each is held with what it is made into. Threads also share a single span.
constexpr std::uint64_t kPositionsTogether = std::uint64_t{1} << 25;  // fixed: memory

std::uint32_t spans_together(const SequenceHeader& header, std::uint32_t longest,
                             std::uint32_t num_threads) {
  const std::uint64_t most =
      kPositionsTogether / (std::uint64_t{header.num_vertices} * longest);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(most, 1, num_threads));
}

// The decoded frames that attributes refer to.
std::vector<DecodedFrame> kept_frames(const BatchTrial& trial) {
  std::vector<DecodedFrame> frames;
  for (const CodedGof& span : trial.gofs) {
    frames.insert(frames.end(), span.kept.begin(), span.kept.end());
  }
  return frames;
}

class SequenceEncoder {
 public:
  SequenceEncoder(FrameSource& source, const EncoderSettings& settings,
                  const Progress& progress)
      : source_(source), settings_(settings), progress_(progress) {}

  // Searches for the target; write() then writes what was found.
  InputResult<TargetResult> find();
  InputResult<EncodeReport> write(TargetResult best, const ByteSink& sink);

 private:
  std::optional<InputError> prepare();
  std::optional<InputError> allot_memory(const SequenceHeader& header);
  InputResult<GridChoice> first_grid() const;
  void use_grid(const GridChoice& grid);
  std::optional<InputError> cut_gofs(const SequenceHeader& header);
  InputResult<TargetResult> search();
  std::optional<InputError> search_on_finer_grid(TargetResult& best);
  double fixed_bits() const;
  std::uint64_t total_bytes(const TargetResult& result);
  std::optional<InputError> keep_to_rate(TargetResult& best);
  std::optional<InputError> verify(const std::shared_ptr<StreamBuffer>& stream,
                                   std::uint64_t end_of_first_gof, EncodeReport& report);
  void show_progress(std::uint32_t trial, double done) const;
  std::optional<InputError> measure_cuts(const BatchTrial& trial, EncodeReport& report);

  FrameSource& source_;
  const EncoderSettings& settings_;
  const Progress& progress_;
  bool keeps_analyses_ = true;
  std::uint32_t num_threads_ = 1;
  std::optional<ThreadPool> threads_;  // used in find() and write()
  Extent extent_;
  std::vector<GofSpan> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;
  std::optional<AttributeStage> attributes_;
  std::uint32_t trials_ = 0;    // trials of all searches so far
  double reserved_bits_ = 0.0;  // that earlier searches for a rate did not know of
};

std::optional<InputError> SequenceEncoder::prepare() {
  SequenceHeader header;
  header.profile_idc = static_cast<std::uint32_t>(settings_.profile);
  header.num_vertices = source_.num_vertices();
  header.num_triangles = static_cast<std::uint32_t>(source_.triangles().size());
  header.num_frames = source_.num_frames();
  header.frame_rate = source_.frame_rate();
  if (auto error = allot_memory(header)) return error;
  threads_.emplace(num_threads_);
  const ThreadPool::Use use(*threads_);
  const auto extent = measure_extent(source_);
  if (!extent) return extent.error();
  extent_ = *extent;
  const auto grid = first_grid();
  if (!grid) return grid.error();
  set_grid(header, *grid);
  if (auto error = cut_gofs(header)) return error;
  if (auto error = choose_level(header, longest_gof_of(spans_))) return error;
  coding_.emplace(header, settings_, source_.triangles());
  stream_.emplace(header, settings_, coding_->connectivity());
  attributes_.emplace(source_.attributes(), source_.triangles(), settings_,
                      coding_->connectivity(), header.num_frames > 1);
  if (attributes_->has_sets()) {
    // Their size is part of the rate; it hardly depends on the error of the first frame.
    if (settings_.target.kind == Target::kBpvf) {
      auto frames = coding_->nearest_frames(source_, attributes_->frames());
      if (!frames) return frames.error();
      attributes_->encode(*frames, *stream_);
    }
  }
  return std::nullopt;
}

InputResult<GridChoice> SequenceEncoder::first_grid() const {
  const Target& target = settings_.target;
  if (target.kind != Target::kLossless) {
    return choose_grid(extent_, finest_error(target, extent_.rms_spread));
  }
  if (target.value == 0.0) return grid_of_source(source_, extent_);
  return grid_of_bits(extent_, static_cast<int>(target.value));
}

// Analyses are kept if there is memory for them.
std::optional<InputError> SequenceEncoder::allot_memory(const SequenceHeader& header) {
  const std::uint32_t largest = std::min(longest_span(settings_, header), header.num_frames);
  const auto threads = [&](bool keeps) {
    return check_memory(settings_, header, largest, keeps ? header.num_frames : 0,
                        source_.memory_bytes());
  };
  // What the cuts are measured from is smaller than an analysis.
  const bool keeps_cuts = settings_.temporal_layers() > 1;
  keeps_analyses_ = keeps_analyses(header);
  auto found = threads(keeps_analyses_ || keeps_cuts);
  if (!found && keeps_analyses_ && !keeps_cuts) {
    keeps_analyses_ = false;
    found = threads(false);
  }
  if (!found) return found.error();
  num_threads_ = *found;
  return std::nullopt;
}

// Divides the sequence into spans: by expected cost, or of equal length with preset fast and in
// the Baseline profile. A span is a GOF or, in the High profile, several.
std::optional<InputError> SequenceEncoder::cut_gofs(const SequenceHeader& header) {
  const std::uint32_t longest = longest_span(settings_, header);
  if (header.num_frames > kMaxFrames) {
    return InputError{"a sequence has at most " + std::to_string(kMaxFrames) +
                      " frames (specification, Annex B), not " +
                      std::to_string(header.num_frames) + "; split it"};
  }
  if (!header.has_skinned_gofs() || settings_.preset == Preset::kFast ||
      settings_.usable_kinds() == KindChoice::kFrames) {
    spans_ = equal_gofs(header.num_frames, longest);
    divide_spans(spans_, longest_gof(settings_, header.num_vertices));
    return std::nullopt;
  }
  const double step = search_for(settings_, header, extent_.rms_spread).step();
  auto spans = cheapest_gofs(source_, longest, step * exact_exp2(header.grid.log2_step));
  if (!spans) return spans.error();
  spans_ = std::move(*spans);
  divide_spans(spans_, longest_gof(settings_, header.num_vertices));
  return std::nullopt;
}

void SequenceEncoder::use_grid(const GridChoice& grid) {
  SequenceHeader header = coding_->header();
  set_grid(header, grid);
  coding_->set_header(header);
  stream_.emplace(header, settings_, coding_->connectivity());
}

// The number of trials is unknown, so each trial counts for half of the remaining progress.
void SequenceEncoder::show_progress(std::uint32_t trial, double done) const {
  if (!progress_) return;
  progress_(settings_.target.has_search()
                ? 1.0 - exact_exp2(-static_cast<int>(trials_ + trial)) * (2.0 - done)
                : done);
}

InputResult<TargetResult> SequenceEncoder::search() {
  const SequenceHeader& header = coding_->header();
  GofBatch batch(*coding_, source_, spans_,
                 {.keep_analyses = keeps_analyses_,
                  .kept_frames = attributes_->frames(),
                  .together = spans_together(header, longest_gof_of(spans_), num_threads_)});
  const auto progress = [&](std::uint32_t trial, double done) { show_progress(trial, done); };
  auto best = reach_target({.settings = settings_,
                            .header = header,
                            .rms_spread = extent_.rms_spread,
                            .fixed_bits = fixed_bits(),
                            .progress = progress},
                           batch);
  if (best) trials_ += best->trials;
  return best;
}

// Bits outside the GOFs that count towards a rate. The index is taken at its largest size for
// GOFs that meet the target.
double SequenceEncoder::fixed_bits() const {
  constexpr double kMostBytes = 0x1p31;  // fixed: of a GOF in an index
  double bits = 8.0 * static_cast<double>(stream_->overhead_bytes()) + reserved_bits_;
  if (settings_.target.kind != Target::kBpvf) return bits;
  std::vector<GofEntry> largest;
  for (const GofSpan& span : spans_) {
    for (const GofSpan& gof : equal_spans(span.count, span.num_gofs)) {
      const double of_gof =
          settings_.target.value * coding_->header().num_vertices * gof.count / 8.0;
      largest.push_back({gof.count, static_cast<std::uint64_t>(std::min(of_gof, kMostBytes))});
    }
  }
  bits += 8.0 * static_cast<double>(stream_->index_bytes(std::move(largest)));
  return bits;
}

std::uint64_t SequenceEncoder::total_bytes(const TargetResult& result) {
  attributes_->encode(kept_frames(result.trial), *stream_);
  const ByteSink discard = [](std::span<const std::uint8_t>) { return true; };
  StreamAssembly stream = *stream_;
  stream.write_lead(coding_->header(), discard);
  for (const CodedGof& span : result.trial.gofs) {
    for (const GofBytes& gof : span.gofs) stream.write_gof(gof, discard);
  }
  stream.write_end(discard);
  EncodeReport report;
  stream.describe(coding_->header(), coding_->connectivity(), report);
  return report.bytes;
}

// A rate is that of the whole stream. What a search does not know, the size of attributes that
// are predicted from the first frame and of skinned models in the index, is reserved after it.
std::optional<InputError> SequenceEncoder::keep_to_rate(TargetResult& best) {
  constexpr int kMostSearches = 3;  // fixed: what is reserved hardly changes
  const SequenceHeader& header = coding_->header();
  const double most = settings_.target.value * (1.0 * header.num_vertices) * header.num_frames;
  for (int searches = 0; best.met; ++searches) {
    const double excess = 8.0 * static_cast<double>(total_bytes(best)) - most;
    if (excess <= 0.0) break;
    if (searches == kMostSearches) {
      best.met = false;
      break;
    }
    reserved_bits_ += excess;
    auto again = search();
    if (!again) return again.error();
    best = std::move(*again);
  }
  return std::nullopt;
}

// With a rate as the target, the error is known only after the search. If it would have
// required a finer grid, searches again on that grid and keeps the better result.
std::optional<InputError> SequenceEncoder::search_on_finer_grid(TargetResult& best) {
  const double error = extent_.rms_spread * best.trial.metrics.kg_error_percent / 100.0;
  const GridChoice grid = choose_grid(extent_, error);
  const SequenceHeader& header = coding_->header();
  if (grid.position_bits <= header.position_bits) return std::nullopt;
  const GridChoice before{header.grid, header.position_bits};
  use_grid(grid);
  auto finer = search();
  if (!finer) return finer.error();
  if (finer->met >= best.met &&
      finer->trial.metrics.kg_error_percent < best.trial.metrics.kg_error_percent) {
    best = std::move(*finer);
  } else {
    use_grid(before);
  }
  return std::nullopt;
}

InputResult<EncodeReport> SequenceEncoder::write(TargetResult best, const ByteSink& sink) {
  const ThreadPool::Use use(*threads_);
  SequenceHeader header = coding_->header();
  EncodeReport report;
  for (const CodedGof& gof : best.trial.gofs) {
    if (auto error = raise_level(header.level_idc, gof.needs, gof.gofs.front().num_frames)) {
      return *error;
    }
    report.clusters += gof.clusters;
    report.components += gof.components;
    count_patterns(gof.choices, report.patterns);
  }
  attributes_->encode(kept_frames(best.trial), *stream_);
  report.attributes = attributes_->reports();
  // Bytes leave once the whole stream has been verified.
  const auto stream = std::make_shared<StreamBuffer>(StreamBuffer::Keep::kAll);
  const ByteSink keep = [&](std::span<const std::uint8_t> bytes) {
    stream->add(bytes);
    return true;
  };
  std::uint64_t end_of_first_gof = 0;
  stream_->write_lead(header, keep);
  for (CodedGof& span : best.trial.gofs) {
    for (GofBytes& gof : span.gofs) {
      stream_->write_gof(std::exchange(gof, {}), keep);
      if (end_of_first_gof == 0) end_of_first_gof = stream->size();
    }
  }
  stream_->write_end(keep);
  stream_->describe(header, coding_->connectivity(), report);
  if (auto error = measure_cuts(best.trial, report)) return *error;
  report.metrics = std::move(best.trial.metrics);
  if (auto error = verify(stream, end_of_first_gof, report)) return *error;
  if (!stream->for_each_piece(sink)) return InputError{"the stream could not be written"};
  if (settings_.baseline.qu == 0) report.step = best.step * exact_exp2(header.grid.log2_step);
  report.trials = trials_;
  report.target_met = best.met && meets_rate(settings_.target, report);
  return report;
}

std::optional<InputError> SequenceEncoder::verify(const std::shared_ptr<StreamBuffer>& stream,
                                                  std::uint64_t end_of_first_gof,
                                                  EncodeReport& report) {
  StreamVerifier verifier(settings_, coding_->header(), coding_->connectivity().input_vertex,
                          stream, num_threads_);
  if (auto error = verifier.check_frames(source_, 0, source_.num_frames())) return error;
  if (auto error = verifier.finish(report.metrics)) return error;
  report.largest_rounding = verifier.largest_rounding();
  return check_rules(settings_, attributes_->has_sets(), stream, end_of_first_gof);
}

// Once, for the stream that was written.
std::optional<InputError> SequenceEncoder::measure_cuts(const BatchTrial& trial,
                                                        EncodeReport& report) {
  const SequenceHeader& header = coding_->header();
  std::mutex reading;
  for (std::uint32_t layers = 1; layers < settings_.temporal_layers(); ++layers) {
    MetricsAccumulator metrics(header.num_vertices, MetricsAccumulator::kTotals);
    for (std::size_t g = 0; g < spans_.size(); ++g) {
      const DecodeFrame frame = trial.gofs[g].cut(static_cast<int>(layers));
      const auto measured = coding_->measure({source_, reading}, spans_[g], frame, metrics);
      if (!measured) return measured.error();
    }
    report.temporal_cuts.push_back(
        {layers, stream_->cut_bytes(layers), metrics.result().kg_error_percent});
  }
  return std::nullopt;
}

InputResult<TargetResult> SequenceEncoder::find() {
  if (auto error = prepare()) return *error;
  const ThreadPool::Use use(*threads_);
  auto best = search();
  if (best && settings_.target.kind == Target::kBpvf) {
    if (auto error = search_on_finer_grid(*best)) return *error;
    if (auto error = keep_to_rate(*best)) return *error;
  }
  return best;
}

// Whether a result is at least as good as another.
bool is_as_good(const TargetResult& result, const TargetResult& other, Target::Kind kind) {
  if (result.met != other.met) return result.met;
  if (kind != Target::kBpvf) return result.trial.gof_bytes <= other.trial.gof_bytes;
  return result.trial.metrics.kg_error_percent <= other.trial.metrics.kg_error_percent;
}

// The searches of preset slow. Its own choices, which are better for each GOF, may by chance be
// worse at the target than those of preset medium; and one GOF worse than several.
std::vector<EncoderSettings> slow_searches(const EncoderSettings& settings,
                                           std::uint32_t num_vertices,
                                           std::uint32_t num_frames) {
  std::vector<EncoderSettings> searches{settings};
  if (settings.gof_frames >= num_frames && num_frames > 1) {
    EncoderSettings& several = searches.emplace_back(settings);
    several.gof_frames = 0;
    several.gof_frames =
        std::min(longest_gof(several, num_vertices), num_frames - num_frames / 2);
  }
  std::vector<EncoderSettings> usual = searches;
  for (EncoderSettings& search : usual) search.preset = Preset::kMedium;
  searches.insert(searches.end(), usual.begin(), usual.end());
  return searches;
}

// Preset slow keeps the best result of several searches.
InputResult<EncodeReport> encode_slowly(FrameSource& source, const EncoderSettings& settings,
                                        const ByteSink& sink, const Progress& progress) {
  const std::vector<EncoderSettings> searches =
      slow_searches(settings, source.num_vertices(), source.num_frames());
  constexpr double kSlowPart = 3.0;  // fixed: of the time, about, in usual searches
  const auto part_of = [](const EncoderSettings& search) {
    return search.preset == Preset::kSlow ? kSlowPart : 1.0;
  };
  double all = 0.0;
  for (const EncoderSettings& search : searches) all += part_of(search);
  double before = 0.0;
  double part = 0.0;
  const Progress of_search = [&](double done) { progress((before + part * done) / all); };
  std::unique_ptr<SequenceEncoder> best;
  std::optional<TargetResult> result;
  for (const EncoderSettings& search : searches) {
    before += part;
    part = part_of(search);
    auto encoder =
        std::make_unique<SequenceEncoder>(source, search, progress ? of_search : progress);
    auto found = encoder->find();
    if (!found) return found.error();
    if (!result || !is_as_good(*result, *found, settings.target.kind)) {
      best = std::move(encoder);
      result = std::move(*found);
    }
  }
  return best->write(std::move(*result), sink);
}

}  // namespace

InputResult<EncodeReport> encode(FrameSource& source, const EncoderSettings& settings,
                                 const ByteSink& sink, const Progress& progress) {
  if (auto error = check_settings(settings)) return *error;
  if (auto error = check_clips(settings.clips, source.num_frames())) return *error;
  if (auto error = check_attributes(settings.attributes, source.attributes())) return *error;
  if (settings.target.kind == Target::kMaxError) {
    const auto rounding = check_rounding(source, settings.target.value);
    if (!rounding) return rounding.error();
  }
  InputResult<EncodeReport> report = [&]() -> InputResult<EncodeReport> {
    if (settings.preset == Preset::kSlow && settings.target.has_search()) {
      return encode_slowly(source, settings, sink, progress);
    }
    SequenceEncoder encoder(source, settings, progress);
    auto best = encoder.find();
    if (!best) return best.error();
    return encoder.write(std::move(*best), sink);
  }();
  if (report && progress) progress(1.0);
  return report;
}

}  // namespace rlpc
