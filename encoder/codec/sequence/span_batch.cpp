#include "encoder/codec/sequence/span_batch.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// Calls pass(g), which returns an error or none, for all g < count on several threads. Returns
// the error of the lowest g, as if the calls had been in order.
std::optional<InputError> for_each_span(
    std::size_t count, const std::function<std::optional<InputError>(std::size_t)>& pass) {
  std::vector<std::optional<InputError>> errors(count);
  std::atomic<std::size_t> failed = count;  // lowest failed g so far
  for_each(count, [&](std::size_t g) {
    if (g > failed) return;
    errors[g] = pass(g);
    if (!errors[g]) return;
    for (std::size_t now = failed; g < now && !failed.compare_exchange_weak(now, g);) {
    }
  });
  return failed < count ? errors[failed] : std::nullopt;
}

}  // namespace

void count_patterns(const std::vector<InterChoice>& choices,
                    std::vector<PatternCount>& counts) {
  for (const InterChoice& choice : choices) {
    const auto same = [&](const PatternCount& count) {
      return count.pattern == choice.pattern && count.patches == choice.num_patches;
    };
    auto found = std::find_if(counts.begin(), counts.end(), same);
    if (found == counts.end()) {
      found = counts.insert(found, {choice.pattern, choice.num_patches, 0});
    }
    ++found->gofs;
  }
}

SpanBatch::SpanBatch(const SequenceCoding& coding, FrameSource& source,
                     const std::vector<FrameRange>& spans, const Options& options)
    : coding_(coding), source_(source), options_(options), spans_(spans.size()) {
  if (!coding.has_rigs()) options_.has_followers = false;
  for (std::size_t g = 0; g < spans.size(); ++g) {
    Span& span = spans_[g];
    span.range = spans[g];
    if (!coding.has_rigs()) continue;
    span.has_followers = options.has_followers || g + 1 < spans.size();
    if (g > 0 || options.rig) span.vertices = Vertices::kUndecided;
  }
}

std::uint32_t SpanBatch::num_frames() const {
  std::uint32_t sum = 0;
  for (const Span& span : spans_) sum += span.range.count;
  return sum;
}

bool SpanBatch::use_last_resort() {
  if (!coding_.has_last_resort()) return false;
  is_last_resort_ = true;
  for (Span& span : spans_) {
    span.coder.reset();
    span.vertices = Vertices::kOwn;
  }
  return true;
}

void SpanBatch::choose_again() {
  for (Span& span : spans_) span.coder.reset();
}

void SpanBatch::keep_num_components() {
  for (Span& span : spans_) {
    if (span.coder) span.coder->keep_num_components();
  }
}

bool SpanBatch::uses_earlier_rigs() const {
  return std::any_of(spans_.begin(), spans_.end(),
                     [](const Span& span) { return span.vertices == Vertices::kEarlier; });
}

bool SpanBatch::is_contested() const {
  return std::any_of(spans_.begin(), spans_.end(),
                     [](const Span& span) { return span.coder && span.coder->is_contested(); });
}

bool SpanBatch::use_own_rigs() {
  const bool changed = uses_earlier_rigs();
  for (Span& span : spans_) span.vertices = Vertices::kOwn;
  return changed;
}

void SpanBatch::set_done(Span& span, double done) {
  const std::lock_guard lock(counting_);
  if (!progress_ || done <= span.done) return;
  span.done = done;
  double sum = 0.0;
  for (const Span& any : spans_) sum += any.done;
  progress_(sum / static_cast<double>(spans_.size()));
}

std::optional<InputError> SpanBatch::read(Span& span) {
  if (!span.frames.xyz.empty()) return std::nullopt;
  const std::lock_guard lock(reading_);
  const Stage stage("reading");
  auto frames = coding_.read_frames(source_, span.range);
  if (!frames) return frames.error();
  span.frames = std::move(*frames);
  span.frames.first_frame += options_.first_frame;
  span.frames.has_followers = span.has_followers;
  return std::nullopt;
}

std::optional<InputError> SpanBatch::prepare(Span& span, double step, double analysis_step) {
  const bool needed = !span.coder || span.coder->needs_frames(step, analysis_step);
  if (needed || span.vertices == Vertices::kUndecided) {
    if (auto error = read(span)) return error;
  }
  if (!span.coder) {
    span.coder = coding_.make_coder(span.frames, is_last_resort_);
    span.coder->set_progress([this, &span](double done) { set_done(span, done); });
  }
  return std::nullopt;
}

std::optional<InputError> SpanBatch::analyse(double analysis_step, const Progress& progress) {
  if (!options_.keep_analyses) return std::nullopt;
  progress_ = progress;
  return for_each_span(spans_.size(), [&](std::size_t g) -> std::optional<InputError> {
    Span& span = spans_[g];
    if (auto error = prepare(span, analysis_step, analysis_step)) return error;
    span.coder->analyse(analysis_step);
    span.frames = {};
    return std::nullopt;
  });
}

std::function<double(double step)> SpanBatch::expected_error() const {
  std::vector<const SpanCoder*> coders;
  for (const Span& span : spans_) {
    if (span.vertices == Vertices::kEarlier) return {};
    if (!span.coder || !span.coder->expected_error(1.0)) return {};
    coders.push_back(span.coder.get());
  }
  return [coders = std::move(coders)](double step) {
    double error = 0.0;
    for (const SpanCoder* coder : coders) error += coder->expected_error(step).value_or(0.0);
    return error;
  };
}

InputResult<SpanBatch::MeasuredSpan> SpanBatch::measure(Span& span,
                                                        const EncodedSpan& encoded) {
  MetricsAccumulator metrics(coding_.header().num_vertices);
  auto hash_units = coding_.measure({source_, reading_}, span.range, encoded.frame, metrics);
  if (!hash_units) return hash_units.error();
  std::vector<GofBytes> gofs =
      write_gof_units(encoded, span.range, coding_.header().open_end_flag);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    if (!gofs[g].has_own_hashes) gofs[g].hash_unit = std::move((*hash_units)[g]);
  }
  std::vector<DecodedFrame> kept;
  const std::uint32_t first = options_.first_frame + span.range.first;
  for (const std::uint32_t frame : options_.kept_frames) {
    if (frame < first || frame - first >= span.range.count) continue;
    kept.push_back({frame, {}});
    kept.back().positions.resize(3 * std::size_t{coding_.header().num_vertices});
    encoded.frame(frame - first, kept.back().positions);
  }
  return MeasuredSpan{{std::move(gofs), LevelNeeds(encoded), encoded.clusters,
                       encoded.components, options_.keep_decoded ? encoded.frame : nullptr,
                       encoded.rig, encoded.cut, encoded.choices, std::move(kept)},
                      std::move(metrics)};
}

InputResult<SpanBatch::MeasuredSpan> SpanBatch::encode(Span& span, double step,
                                                       double analysis_step) {
  if (auto error = prepare(span, step, analysis_step)) return *error;
  const EncodedSpan encoded = span.coder->encode(step, analysis_step);
  if (!options_.keep_analyses) span.coder->release_analysis();
  const bool is_undecided = span.vertices == Vertices::kUndecided;
  const double cost = is_undecided ? lagrangian_cost(encoded, span.frames, step) : 0.0;
  if (!options_.keep_analyses || !span.coder->needs_frames(step, analysis_step)) {
    span.frames = {};
  }
  auto measured = measure(span, encoded);
  if (measured) measured->cost = cost;
  return measured;
}

// Encodes a span with an earlier rig. None: it costs at least `max_cost`.
InputResult<std::optional<SpanBatch::MeasuredSpan>> SpanBatch::encode_with(const KeptRig& rig,
                                                                           Span& span,
                                                                           double step,
                                                                           double max_cost) {
  if (auto error = read(span)) return *error;
  const auto encoded = coding_.encode_with(rig, span.frames, step, max_cost);
  span.frames = {};
  if (!encoded) return std::optional<MeasuredSpan>();
  auto measured = measure(span, *encoded);
  if (!measured) return measured.error();
  return std::optional(std::move(*measured));
}

// Compares at equal step, by cost.
bool SpanBatch::is_better(const MeasuredSpan& with_rig, const MeasuredSpan& own) const {
  const std::uint32_t level_idc = coding_.header().level_idc;
  const auto level = [&](const MeasuredSpan& span) {
    return span.coded.needs.level_from(level_idc).value_or(kMaxLevelIdc + 1);
  };
  if (level(with_rig) > level(own)) return false;
  // The Lagrangian cost does not predict the largest error.
  return !coding_.has_largest_error() ||
         with_rig.metrics.result().max_error <= own.metrics.result().max_error;
}

// Encodes a span with an earlier rig, and keeps whichever is better.
std::optional<InputError> SpanBatch::decide(const std::shared_ptr<const KeptRig>& rig,
                                            Span& span, double step,
                                            std::optional<MeasuredSpan>& measured) {
  span.vertices = Vertices::kOwn;
  if (!rig) return std::nullopt;
  auto other = encode_with(*rig, span, step, measured->cost);
  if (!other) return other.error();
  if (!*other || !is_better(**other, *measured)) return std::nullopt;
  measured = std::move(*other);
  span.vertices = Vertices::kEarlier;
  if (span.coder) span.coder->release_analysis();
  return std::nullopt;
}

// Encodes some spans. Those with vertices of their own do not depend on others, and come first.
//
//   rig  in force before them; set to the one in force after them
std::optional<InputError> SpanBatch::encode_some(SpanRange spans, double step,
                                                 double analysis_step,
                                                 std::shared_ptr<const KeptRig>& rig,
                                                 Measured& measured) {
  const auto encode_own = [&](std::size_t i) -> std::optional<InputError> {
    Span& span = spans_[spans.first + i];
    if (span.vertices == Vertices::kEarlier) return std::nullopt;
    auto own = encode(span, step, analysis_step);
    if (!own) return own.error();
    measured[spans.first + i] = std::move(*own);
    set_done(span, 1.0);
    return std::nullopt;
  };
  if (auto error = for_each_span(spans.count, encode_own)) return error;
  Rigs rigs(spans.count);
  for (std::uint32_t i = 0; i < spans.count; ++i) {
    const std::size_t g = spans.first + i;
    if (spans_[g].vertices == Vertices::kEarlier) {
      rigs[i] = rig;
      continue;
    }
    if (spans_[g].vertices == Vertices::kUndecided) {
      if (auto error = decide(rig, spans_[g], step, measured[g])) return error;
    }
    if (measured[g]->coded.rig) rig = measured[g]->coded.rig;
    if (!options_.keep_decoded) measured[g]->coded.rig.reset();
  }
  return for_each_span(spans.count, [&](std::size_t i) -> std::optional<InputError> {
    if (!rigs[i]) return std::nullopt;
    Span& span = spans_[spans.first + i];
    auto with_rig = encode_with(*rigs[i], span, step, std::numeric_limits<double>::infinity());
    if (!with_rig) return with_rig.error();
    measured[spans.first + i] = std::move(*with_rig);
    set_done(span, 1.0);
    return std::nullopt;
  });
}

InputResult<BatchTrial> SpanBatch::encode(double step, double analysis_step,
                                          const Progress& progress) {
  Measured measured(spans_.size());
  progress_ = progress;
  std::shared_ptr<const KeptRig> rig = options_.rig;
  const auto num_spans = static_cast<std::uint32_t>(spans_.size());
  const std::uint32_t together = coding_.has_rigs() ? options_.together : num_spans;
  for (std::uint32_t first = 0; first < num_spans; first += together) {
    const SpanRange spans{first, std::min(together, num_spans - first)};
    if (auto error = encode_some(spans, step, analysis_step, rig, measured)) {
      return *error;
    }
  }
  for (Span& span : spans_) span.done = 0.0;
  BatchTrial trial;
  MetricsAccumulator metrics(coding_.header().num_vertices, options_.metrics);
  for (std::optional<MeasuredSpan>& span_measure : measured) {
    for (const GofBytes& gof : span_measure->coded.gofs) trial.gof_bytes += gof.size();
    metrics.append(span_measure->metrics);
    trial.spans.push_back(std::move(span_measure->coded));
  }
  trial.metrics = metrics.result();
  return trial;
}

}  // namespace rlpc
