#include "encoder/sequence/gof_batch.h"

#include <algorithm>
#include <atomic>
#include <utility>

#include "encoder/parallel/for_each.h"

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

GofBatch::GofBatch(const SequenceCoding& coding, FrameSource& source,
                   const std::vector<GofSpan>& spans, const Options& options)
    : coding_(coding), source_(source), options_(options), gofs_(spans.size()) {
  for (std::size_t g = 0; g < spans.size(); ++g) gofs_[g].span = spans[g];
}

std::uint32_t GofBatch::num_frames() const {
  std::uint32_t sum = 0;
  for (const Gof& gof : gofs_) sum += gof.span.count;
  return sum;
}

bool GofBatch::use_last_resort() {
  if (!coding_.has_last_resort()) return false;
  is_last_resort_ = true;
  for (Gof& gof : gofs_) gof.coder.reset();
  return true;
}

std::optional<InputError> GofBatch::prepare(Gof& gof, double step, double analysis_step) {
  const bool needed = !gof.coder || gof.coder->needs_frames(step, analysis_step);
  if (needed && gof.frames.xyz.empty()) {
    const std::lock_guard lock(reading_);
    auto frames = coding_.read_frames(source_, gof.span);
    if (!frames) return frames.error();
    gof.frames = std::move(*frames);
    gof.frames.first_frame += options_.first_frame;
  }
  if (!gof.coder) gof.coder = coding_.make_coder(gof.frames, is_last_resort_);
  return std::nullopt;
}

std::optional<InputError> GofBatch::analyse(double analysis_step) {
  if (!options_.keep_analyses) return std::nullopt;
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
    if (!gof.coder || !gof.coder->expected_error(1.0)) return {};
    coders.push_back(gof.coder.get());
  }
  return [coders = std::move(coders)](double step) {
    double error = 0.0;
    for (const GofCoder* coder : coders) error += coder->expected_error(step).value_or(0.0);
    return error;
  };
}

InputResult<GofBatch::MeasuredGof> GofBatch::encode(Gof& gof, double step,
                                                    double analysis_step) {
  if (auto error = prepare(gof, step, analysis_step)) return *error;
  const EncodedGof encoded = gof.coder->encode(step, analysis_step);
  if (!options_.keep_analyses) gof.coder->release_analysis();
  if (!options_.keep_analyses || !gof.coder->needs_frames(step, analysis_step)) {
    gof.frames = {};
  }
  MetricsAccumulator metrics(coding_.header().num_vertices);
  auto hash_units = coding_.measure({source_, reading_}, gof.span, encoded.frame, metrics);
  if (!hash_units) return hash_units.error();
  std::vector<GofBytes> gofs = write_gof_units(encoded, gof.span);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    gofs[g].hash_unit = std::move((*hash_units)[g]);
  }
  return MeasuredGof{
      {std::move(gofs), LevelNeeds(encoded), encoded.clusters, encoded.components,
       options_.keep_decoded ? encoded.frame : nullptr, encoded.cut},
      std::move(metrics)};
}

InputResult<BatchTrial> GofBatch::encode(double step, double analysis_step,
                                         const Progress& progress) {
  std::vector<std::optional<MeasuredGof>> measured(gofs_.size());
  std::mutex counting;
  std::size_t done = 0;
  const auto encode_one = [&](std::size_t g) -> std::optional<InputError> {
    auto one = encode(gofs_[g], step, analysis_step);
    if (!one) return one.error();
    measured[g] = std::move(*one);
    const std::lock_guard lock(counting);
    ++done;
    if (progress) progress(static_cast<double>(done) / static_cast<double>(gofs_.size()));
    return std::nullopt;
  };
  if (auto error = for_each_gof(gofs_.size(), encode_one)) return *error;
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
