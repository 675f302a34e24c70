#include "encoder/codec/sequence/gof_batch.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// Calls pass(g), which returns an error or none, for all g < count on several threads. Returns
// the error of the lowest g, as if the calls had been in order.
std::optional<InputError> for_each_gof(
    std::size_t count, const std::function<std::optional<InputError>(std::size_t)>& pass) {
  std::vector<std::optional<InputError>> errors(count);
  std::atomic<std::size_t> failed = count;  // the lowest so far
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

void count_patterns(const std::vector<FrameChoice>& choices,
                    std::vector<PatternCount>& counts) {
  for (const FrameChoice& choice : choices) {
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

GofBatch::GofBatch(const SequenceCoding& coding, FrameSource& source,
                   const std::vector<GofSpan>& spans, const Options& options)
    : coding_(coding), source_(source), options_(options), gofs_(spans.size()) {
  if (!coding.has_models()) options_.has_followers = false;
  for (std::size_t g = 0; g < spans.size(); ++g) {
    Gof& gof = gofs_[g];
    gof.span = spans[g];
    if (!coding.has_models()) continue;
    gof.has_followers = options.has_followers || g + 1 < spans.size();
    if (g > 0 || options.model) gof.vertices = Vertices::kUndecided;
  }
}

std::uint32_t GofBatch::num_frames() const {
  std::uint32_t sum = 0;
  for (const Gof& gof : gofs_) sum += gof.span.count;
  return sum;
}

bool GofBatch::use_last_resort() {
  if (!coding_.has_last_resort()) return false;
  is_last_resort_ = true;
  for (Gof& gof : gofs_) {
    gof.coder.reset();
    gof.vertices = Vertices::kOwn;
  }
  return true;
}

void GofBatch::choose_again() {
  for (Gof& gof : gofs_) gof.coder.reset();
}

bool GofBatch::uses_earlier_models() const {
  return std::any_of(gofs_.begin(), gofs_.end(),
                     [](const Gof& gof) { return gof.vertices == Vertices::kOfEarlier; });
}

bool GofBatch::use_own_models() {
  const bool changed = uses_earlier_models();
  for (Gof& gof : gofs_) gof.vertices = Vertices::kOwn;
  return changed;
}

void GofBatch::set_done(Gof& gof, double done) {
  const std::lock_guard lock(counting_);
  if (!progress_ || done <= gof.done) return;
  gof.done = done;
  double sum = 0.0;
  for (const Gof& any : gofs_) sum += any.done;
  progress_(sum / static_cast<double>(gofs_.size()));
}

std::optional<InputError> GofBatch::read(Gof& gof) {
  if (!gof.frames.xyz.empty()) return std::nullopt;
  const std::lock_guard lock(reading_);
  auto frames = coding_.read_frames(source_, gof.span);
  if (!frames) return frames.error();
  gof.frames = std::move(*frames);
  gof.frames.first_frame += options_.first_frame;
  gof.frames.has_followers = gof.has_followers;
  return std::nullopt;
}

std::optional<InputError> GofBatch::prepare(Gof& gof, double step, double analysis_step) {
  const bool needed = !gof.coder || gof.coder->needs_frames(step, analysis_step);
  if (needed || gof.vertices == Vertices::kUndecided) {
    if (auto error = read(gof)) return error;
  }
  if (!gof.coder) {
    gof.coder = coding_.make_coder(gof.frames, is_last_resort_);
    gof.coder->set_progress([this, &gof](double done) { set_done(gof, done); });
  }
  return std::nullopt;
}

std::optional<InputError> GofBatch::analyse(double analysis_step, const Progress& progress) {
  if (!options_.keep_analyses) return std::nullopt;
  progress_ = progress;
  return for_each_gof(gofs_.size(), [&](std::size_t g) -> std::optional<InputError> {
    Gof& gof = gofs_[g];
    if (auto error = prepare(gof, analysis_step, analysis_step)) return error;
    gof.coder->analyse(analysis_step);
    gof.frames = {};
    return std::nullopt;
  });
}

std::function<double(double step)> GofBatch::expected_error() const {
  std::vector<const GofCoder*> coders;
  for (const Gof& gof : gofs_) {
    if (gof.vertices == Vertices::kOfEarlier) return {};
    if (!gof.coder || !gof.coder->expected_error(1.0)) return {};
    coders.push_back(gof.coder.get());
  }
  return [coders = std::move(coders)](double step) {
    double error = 0.0;
    for (const GofCoder* coder : coders) error += coder->expected_error(step).value_or(0.0);
    return error;
  };
}

InputResult<GofBatch::MeasuredGof> GofBatch::measure(Gof& gof, const EncodedGof& encoded) {
  MetricsAccumulator metrics(coding_.header().num_vertices);
  auto hash_units = coding_.measure({source_, reading_}, gof.span, encoded.frame, metrics);
  if (!hash_units) return hash_units.error();
  std::vector<GofBytes> gofs =
      write_gof_units(encoded, gof.span, coding_.header().open_end_flag);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    if (!gofs[g].has_own_hashes) gofs[g].hash_unit = std::move((*hash_units)[g]);
  }
  std::vector<DecodedFrame> kept;
  const std::uint32_t first = options_.first_frame + gof.span.first;
  for (const std::uint32_t frame : options_.kept_frames) {
    if (frame < first || frame - first >= gof.span.count) continue;
    kept.push_back({frame, {}});
    kept.back().positions.resize(3 * std::size_t{coding_.header().num_vertices});
    encoded.frame(frame - first, kept.back().positions);
  }
  return MeasuredGof{{std::move(gofs), LevelNeeds(encoded), encoded.clusters,
                      encoded.components, options_.keep_decoded ? encoded.frame : nullptr,
                      encoded.model, encoded.cut, encoded.choices, std::move(kept)},
                     std::move(metrics)};
}

InputResult<GofBatch::MeasuredGof> GofBatch::encode(Gof& gof, double step,
                                                    double analysis_step) {
  if (auto error = prepare(gof, step, analysis_step)) return *error;
  const EncodedGof encoded = gof.coder->encode(step, analysis_step);
  if (!options_.keep_analyses) gof.coder->release_analysis();
  const bool is_undecided = gof.vertices == Vertices::kUndecided;
  const double cost = is_undecided ? lagrangian_cost(encoded, gof.frames, step) : 0.0;
  if (!options_.keep_analyses || !gof.coder->needs_frames(step, analysis_step)) {
    gof.frames = {};
  }
  auto measured = measure(gof, encoded);
  if (measured) measured->cost = cost;
  return measured;
}

// None: it costs at least `most`.
InputResult<std::optional<GofBatch::MeasuredGof>> GofBatch::encode_with(const KeptModel& model,
                                                                        Gof& gof, double step,
                                                                        double most) {
  if (auto error = read(gof)) return *error;
  const auto encoded = coding_.encode_with(model, gof.frames, step, most);
  gof.frames = {};
  if (!encoded) return std::optional<MeasuredGof>();
  auto measured = measure(gof, *encoded);
  if (!measured) return measured.error();
  return std::optional(std::move(*measured));
}

// At equal step, if its cost is lower.
bool GofBatch::is_better(const MeasuredGof& with_model, const MeasuredGof& own) const {
  const std::uint32_t level_idc = coding_.header().level_idc;
  const auto level = [&](const MeasuredGof& gof) {
    return gof.coded.needs.level_from(level_idc).value_or(kMaxLevelIdc + 1);
  };
  if (level(with_model) > level(own)) return false;
  // The Lagrangian cost does not predict the largest error.
  return !coding_.has_largest_error() ||
         with_model.metrics.result().max_error <= own.metrics.result().max_error;
}

// Encodes a span with an earlier model, and keeps whichever is better.
std::optional<InputError> GofBatch::decide(const std::shared_ptr<const KeptModel>& model,
                                           Gof& gof, double step,
                                           std::optional<MeasuredGof>& measured) {
  gof.vertices = Vertices::kOwn;
  if (!model) return std::nullopt;
  auto other = encode_with(*model, gof, step, measured->cost);
  if (!other) return other.error();
  if (!*other || !is_better(**other, *measured)) return std::nullopt;
  measured = std::move(*other);
  gof.vertices = Vertices::kOfEarlier;
  if (gof.coder) gof.coder->release_analysis();
  return std::nullopt;
}

// Encodes some spans. Those with vertices of their own do not depend on others, and come first.
//
//   model  in force before them; then, after them
std::optional<InputError> GofBatch::encode_some(GofSpan spans, double step,
                                                double analysis_step,
                                                std::shared_ptr<const KeptModel>& model,
                                                Measured& measured) {
  const auto encode_own = [&](std::size_t i) -> std::optional<InputError> {
    Gof& gof = gofs_[spans.first + i];
    if (gof.vertices == Vertices::kOfEarlier) return std::nullopt;
    auto own = encode(gof, step, analysis_step);
    if (!own) return own.error();
    measured[spans.first + i] = std::move(*own);
    set_done(gof, 1.0);
    return std::nullopt;
  };
  if (auto error = for_each_gof(spans.count, encode_own)) return error;
  Models models(spans.count);
  for (std::uint32_t i = 0; i < spans.count; ++i) {
    const std::size_t g = spans.first + i;
    if (gofs_[g].vertices == Vertices::kOfEarlier) {
      models[i] = model;
      continue;
    }
    if (gofs_[g].vertices == Vertices::kUndecided) {
      if (auto error = decide(model, gofs_[g], step, measured[g])) return error;
    }
    if (measured[g]->coded.model) model = measured[g]->coded.model;
    if (!options_.keep_decoded) measured[g]->coded.model.reset();
  }
  return for_each_gof(spans.count, [&](std::size_t i) -> std::optional<InputError> {
    if (!models[i]) return std::nullopt;
    Gof& gof = gofs_[spans.first + i];
    auto with_model =
        encode_with(*models[i], gof, step, std::numeric_limits<double>::infinity());
    if (!with_model) return with_model.error();
    measured[spans.first + i] = std::move(*with_model);
    set_done(gof, 1.0);
    return std::nullopt;
  });
}

InputResult<BatchTrial> GofBatch::encode(double step, double analysis_step,
                                         const Progress& progress) {
  Measured measured(gofs_.size());
  progress_ = progress;
  std::shared_ptr<const KeptModel> model = options_.model;
  const auto num_spans = static_cast<std::uint32_t>(gofs_.size());
  const std::uint32_t together = coding_.has_models() ? options_.together : num_spans;
  for (std::uint32_t first = 0; first < num_spans; first += together) {
    const GofSpan spans{first, std::min(together, num_spans - first)};
    if (auto error = encode_some(spans, step, analysis_step, model, measured)) {
      return *error;
    }
  }
  for (Gof& gof : gofs_) gof.done = 0.0;
  BatchTrial trial;
  MetricsAccumulator metrics(coding_.header().num_vertices, options_.metrics);
  for (std::optional<MeasuredGof>& of_span : measured) {
    for (const GofBytes& gof : of_span->coded.gofs) trial.gof_bytes += gof.size();
    metrics.append(of_span->metrics);
    trial.gofs.push_back(std::move(of_span->coded));
  }
  trial.metrics = metrics.result();
  return trial;
}

}  // namespace rlpc
