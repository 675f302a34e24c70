#include "encoder/codec/sequence/sequence_encoder.h"

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/verify/stream_buffer.h"
#include "encoder/codec/kinds/skinned/input_rig.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/sequence/choices/gof_cuts.h"
#include "encoder/codec/sequence/choices/level_choice.h"
#include "encoder/codec/sequence/choices/lossless_grid.h"
#include "encoder/codec/sequence/memory_need.h"
#include "encoder/codec/sequence/stream_verifier.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// Analyses of all GOFs are kept in memory if the frames, as doubles, take at most this many
// bytes.
constexpr std::uint64_t kKeepBytes = std::uint64_t{1} << 30;  // fixed: memory

bool keeps_analyses(const SequenceHeader& header) {
  return std::uint64_t{header.num_vertices} * 3 * sizeof(double) * header.num_frames <=
         kKeepBytes;
}

// Limit of the positions of spans that are encoded at the same time, one span for each thread,
// as each is held with its results. Threads also share a single span.
constexpr std::uint64_t kPositionsTogether = std::uint64_t{1} << 25;  // fixed: memory

std::uint32_t spans_together(const SequenceHeader& header, std::uint32_t longest,
                             std::uint32_t num_threads) {
  const std::uint64_t max = kPositionsTogether / (std::uint64_t{header.num_vertices} * longest);
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(max, 1, num_threads));
}

// Whether the search of a contained profile may end before it has reached the target. One that
// takes some tenths of a second may not: where streams have few bytes, sizes and errors jump
// from one step to the next.
bool may_give_up(const FrameSource& source) {
  constexpr std::uint64_t kSmall = 1 << 15;  // fixed: time; vertices of all frames
  return std::uint64_t{source.num_vertices()} * source.num_frames() > kSmall;
}

// Returns the decoded frames that attributes refer to.
std::vector<DecodedFrame> kept_frames(const BatchTrial& trial) {
  std::vector<DecodedFrame> frames;
  for (const SpanResult& span : trial.spans) {
    frames.insert(frames.end(), span.kept.begin(), span.kept.end());
  }
  return frames;
}

}  // namespace

std::optional<InputError> SequenceEncoder::prepare() {
  SequenceHeader header;
  header.profile_idc = static_cast<std::uint32_t>(written_);
  header.num_vertices = source_.num_vertices();
  header.num_triangles = static_cast<std::uint32_t>(source_.triangles().size());
  header.num_frames = source_.num_frames();
  header.frame_rate = source_.frame_rate();
  if (header.num_frames > kMaxFrames) {
    return InputError{"a sequence has at most " + std::to_string(kMaxFrames) +
                      " frames (specification, Annex B), not " +
                      std::to_string(header.num_frames) + "; split it"};
  }
  longest_gof_ = longest_gof(settings_, header.num_vertices);
  if (auto error = allot_memory(header)) return error;
  threads_.emplace(num_threads_);
  if (auto error = survey(header)) return error;
  threads_.emplace(num_threads_);
  const ThreadPool::Use use(*threads_);
  if (auto error = cut_gofs(header)) return error;
  if (auto error = choose_level(header, longest_gof(spans_))) return error;
  {
    const Stage stage("connectivity");
    coding_.emplace(header, settings_, source_.triangles());
  }
  stream_.emplace(header, settings_, coding_->connectivity());
  attributes_.emplace(source_.attributes(), source_.triangles(), settings_,
                      coding_->connectivity(), header.num_frames > 1);
  if (attributes_->has_sets()) {
    // The size of attributes is part of the rate; it barely depends on the error of the first
    // frame.
    if (settings_.target.kind == Target::kBpvf) {
      auto frames = coding_->nearest_frames(source_, attributes_->frames());
      if (!frames) return frames.error();
      attributes_->encode(*frames, *stream_);
    }
  }
  return std::nullopt;
}

// Chooses, before memory is allotted, the grid and the maximum length of GOFs.
std::optional<InputError> SequenceEncoder::survey(SequenceHeader& header) {
  const Stage stage("survey");
  const ThreadPool::Use use(*threads_);
  const auto extent = measure_extent(source_);
  if (!extent) return extent.error();
  extent_ = *extent;
  const auto grid = first_grid();
  if (!grid) return grid.error();
  set_grid(header, *grid);
  return lengthen_gofs(header);
}

InputResult<GridChoice> SequenceEncoder::first_grid() const {
  const Target& target = settings_.target;
  if (target.kind != Target::kLossless) {
    return choose_grid(extent_, finest_error(target, extent_.rms_spread));
  }
  if (target.value == 0.0) return grid_of_source(source_, extent_);
  return grid_of_bits(extent_, static_cast<int>(target.value));
}

SourceMemory SequenceEncoder::source_memory() const {
  SourceMemory memory{.bytes = source_.memory_bytes(), .encoded_frames = source_.num_frames()};
  if (source_.rig()) {
    const std::uint64_t n = source_.num_vertices();
    memory.bytes_of_position = (pose_bytes(source_.rig()->bones.size()) + n - 1) / n;
  }
  return memory;
}

std::uint32_t SequenceEncoder::longest_span_of(const SequenceHeader& header) const {
  return settings_.profile == Profile::kHigh ? longest_span(settings_, header, source_memory())
                                             : longest_gof_;
}

// Returns the likely step, in the unit of the coordinates.
double SequenceEncoder::likely_step(const SequenceHeader& header) const {
  return search_for(settings_, header, extent_.rms_spread).step() *
         exact_exp2(header.grid.log2_step);
}

// Lets GOFs be longer than usual where that costs less and memory allows it.
std::optional<InputError> SequenceEncoder::lengthen_gofs(const SequenceHeader& header) {
  const std::uint32_t usual = longest_gof_;
  const auto longest = choose_longest_gof(
      source_, usual, longest_gof_of_all(settings_, header.num_vertices), likely_step(header));
  if (!longest) return longest.error();
  longest_gof_ = *longest;
  if (longest_gof_ == usual || !allot_memory(header)) return std::nullopt;
  longest_gof_ = usual;
  return allot_memory(header);
}

// Allots memory: analyses are kept if there is room for them.
std::optional<InputError> SequenceEncoder::allot_memory(const SequenceHeader& header) {
  const std::uint32_t largest = std::min(longest_span_of(header), header.num_frames);
  const auto threads = [&](bool keeps) {
    return check_memory(settings_, header, largest, keeps ? header.num_frames : 0,
                        source_memory());
  };
  // The data for measuring cuts is smaller than an analysis.
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
  const Stage stage("GOF cuts");
  const std::uint32_t longest = longest_span_of(header);
  if (settings_.profile == Profile::kBaseline || settings_.preset == Preset::kFast ||
      settings_.usable_kind() == GofKind::kInter) {
    spans_ = equal_gofs(header.num_frames, longest);
    divide_spans(spans_, longest_gof_);
    return std::nullopt;
  }
  auto spans = cheapest_gofs(source_, longest, likely_step(header));
  if (!spans) return spans.error();
  spans_ = std::move(*spans);
  divide_spans(spans_, longest_gof_);
  return std::nullopt;
}

void SequenceEncoder::use_grid(const GridChoice& grid) {
  SequenceHeader header = coding_->header();
  set_grid(header, grid);
  coding_->set_header(header);
  stream_.emplace(header, settings_, coding_->connectivity());
}

// Shows the progress: the number of trials is unknown, so each counts for half of the
// remainder.
void SequenceEncoder::show_progress(std::uint32_t trial, double done) const {
  if (!progress_) return;
  progress_(settings_.target.has_search()
                ? 1.0 - exact_exp2(-static_cast<int>(trials_ + trial)) * (2.0 - done)
                : done);
}

TargetTask SequenceEncoder::task(const EncoderSettings& settings) const {
  return {.settings = settings,
          .header = coding_->header(),
          .rms_spread = extent_.rms_spread,
          .fixed_bits = fixed_bits(),
          .progress = [this](std::uint32_t trial, double done) { show_progress(trial, done); }};
}

InputResult<TargetResult> SequenceEncoder::search(const Rival* rival) {
  SpanBatch batch(
      *coding_, source_, spans_,
      {.keep_analyses = keeps_analyses_,
       .kept_frames = attributes_->frames(),
       .together = spans_together(coding_->header(), longest_gof(spans_), num_threads_)});
  TargetTask whole = task(settings_);
  whole.rival = rival;
  auto best = reach_target(whole, batch);
  if (best) trials_ += best->trials;
  return best;
}

// Returns the bits outside the GOFs that count towards a rate. The index has its largest size
// for GOFs that meet the target.
double SequenceEncoder::fixed_bits() const {
  constexpr double kMaxBytes = 0x1p31;  // fixed: largest GOF in an index
  double bits = 8.0 * static_cast<double>(stream_->overhead_bytes()) + reserved_bits_;
  if (settings_.target.kind != Target::kBpvf) return bits;
  std::vector<GofEntry> largest;
  for (const FrameRange& span : spans_) {
    for (const FrameRange& gof : equal_ranges(span.count, span.num_gofs)) {
      const double gof_bytes =
          settings_.target.value * coding_->header().num_vertices * gof.count / 8.0;
      largest.push_back(
          {gof.count, static_cast<std::uint64_t>(std::min(gof_bytes, kMaxBytes))});
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
  for (const SpanResult& span : result.trial.spans) {
    for (const GofBytes& gof : span.gofs) stream.write_gof(gof, discard);
  }
  stream.write_end(discard);
  EncodeReport report;
  stream.describe(coding_->header(), coding_->connectivity(), report);
  return report.bytes;
}

// Keeps the whole stream within a rate. After a search, reserves the bits that it does not
// know: attributes that are predicted from the first frame, and shared rigs in the index.
std::optional<InputError> SequenceEncoder::keep_to_rate(TargetResult& best) {
  constexpr int kMaxSearches = 3;  // fixed: reserved bits barely change
  const SequenceHeader& header = coding_->header();
  const double max = settings_.target.value * (1.0 * header.num_vertices) * header.num_frames;
  for (int searches = 0; best.met; ++searches) {
    const double excess = 8.0 * static_cast<double>(total_bytes(best)) - max;
    if (excess <= 0.0) break;
    if (searches == kMaxSearches) {
      best.met = false;
      break;
    }
    reserved_bits_ += excess;
    auto again = search(nullptr);
    if (!again) return again.error();
    best = std::move(*again);
  }
  return std::nullopt;
}

// Searches again on a finer grid, if the error required one, and keeps the better result: with
// a rate as the target, the error is known only after the search.
std::optional<InputError> SequenceEncoder::search_on_finer_grid(TargetResult& best) {
  const double error = extent_.rms_spread * best.trial.metrics.kg_error_percent / 100.0;
  const GridChoice grid = choose_grid(extent_, error);
  const SequenceHeader& header = coding_->header();
  if (grid.position_bits <= header.position_bits) return std::nullopt;
  const GridChoice before{header.grid, header.position_bits};
  use_grid(grid);
  auto finer = search(nullptr);
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
  for (const SpanResult& span : best.trial.spans) {
    if (auto error = raise_level(header.level_idc, span.needs, span.gofs.front().num_frames)) {
      return *error;
    }
    report.clusters += span.clusters;
    report.components += span.components;
    count_patterns(span.choices, report.patterns);
  }
  attributes_->encode(kept_frames(best.trial), *stream_);
  report.attributes = attributes_->reports();
  // Bytes are passed on once the whole stream has been verified.
  const auto stream = std::make_shared<StreamBuffer>(StreamBuffer::Keep::kAll);
  const ByteSink keep = [&](std::span<const std::uint8_t> bytes) {
    stream->add(bytes);
    return true;
  };
  std::uint64_t end_of_first_gof = 0;
  stream_->write_lead(header, keep);
  for (SpanResult& span : best.trial.spans) {
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
  const Stage stage("verification");
  StreamVerifier verifier(settings_, coding_->header(), coding_->connectivity().input_vertex,
                          stream, num_threads_);
  verifier.measure_normals(source_.triangles());
  if (auto error = verifier.check_frames(source_, 0, source_.num_frames())) return error;
  if (auto error = verifier.finish(report.metrics)) return error;
  // The search measures normals only if they are bounded.
  report.metrics.vertex_normals = verifier.vertex_normals();
  report.largest_rounding = verifier.largest_rounding();
  return check_rules(settings_, attributes_->has_sets(), stream, end_of_first_gof);
}

// Measures the cuts once, for the stream that was written.
std::optional<InputError> SequenceEncoder::measure_cuts(const BatchTrial& trial,
                                                        EncodeReport& report) {
  const SequenceHeader& header = coding_->header();
  std::mutex reading;
  for (std::uint32_t layers = 1; layers < settings_.temporal_layers(); ++layers) {
    MetricsAccumulator metrics(header.num_vertices, MetricsAccumulator::kTotals);
    for (std::size_t g = 0; g < spans_.size(); ++g) {
      const DecodeFrame frame = trial.spans[g].cut(static_cast<int>(layers));
      const auto measured = coding_->measure({source_, reading}, spans_[g], frame, metrics);
      if (!measured) return measured.error();
    }
    report.temporal_cuts.push_back(
        {layers, stream_->cut_bytes(layers), metrics.result().kg_error_percent});
  }
  return std::nullopt;
}

std::uint64_t SequenceEncoder::bytes_of(const TargetResult& result) const {
  std::vector<GofEntry> gofs;
  for (const SpanResult& span : result.trial.spans) {
    for (const GofBytes& gof : span.gofs) gofs.push_back({gof.num_frames, gof.size()});
  }
  return stream_->overhead_bytes() + result.trial.gof_bytes +
         stream_->index_bytes(std::move(gofs));
}

InputResult<TargetResult> SequenceEncoder::find(const Rival* rival) {
  if (!may_give_up(source_)) rival = nullptr;
  // Searches of the preset fast take little time.
  const bool takes_long = settings_.preset != Preset::kFast;
  if (rival != nullptr && rival->is_uncontested() && takes_long) {
    TargetResult none;
    none.given_up = true;
    return none;
  }
  if (auto error = prepare()) return *error;
  const ThreadPool::Use use(*threads_);
  auto best = search(rival);
  if (best && !best->given_up && settings_.target.kind == Target::kBpvf) {
    if (auto error = search_on_finer_grid(*best)) return *error;
    if (auto error = keep_to_rate(*best)) return *error;
  }
  return best;
}

}  // namespace rlpc
