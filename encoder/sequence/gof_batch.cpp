#include "encoder/sequence/gof_batch.h"

#include <utility>

namespace rlpc {

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
  for (Gof& gof : gofs_) {
    if (auto error = prepare(gof, analysis_step, analysis_step)) return error;
    gof.coder->analyse(analysis_step);
    gof.frames = {};
  }
  return std::nullopt;
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

InputResult<CodedGof> GofBatch::encode(Gof& gof, double step, double analysis_step,
                                       MetricsAccumulator& metrics) {
  if (auto error = prepare(gof, step, analysis_step)) return *error;
  const EncodedGof encoded = gof.coder->encode(step, analysis_step);
  if (!options_.keep_analyses) gof.coder->release_analysis();
  if (!options_.keep_analyses || !gof.coder->needs_frames(step, analysis_step)) {
    gof.frames = {};
  }
  auto hash_units = coding_.measure(source_, gof.span, encoded.frame, metrics);
  if (!hash_units) return hash_units.error();
  std::vector<GofBytes> gofs = write_gof_units(encoded, gof.span);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    gofs[g].hash_unit = std::move((*hash_units)[g]);
  }
  return CodedGof{std::move(gofs), LevelNeeds(encoded), encoded.clusters, encoded.components,
                  options_.keep_decoded ? encoded.frame : nullptr};
}

InputResult<BatchTrial> GofBatch::encode(double step, double analysis_step,
                                         const Progress& progress) {
  BatchTrial trial;
  MetricsAccumulator metrics(coding_.header().num_vertices, options_.metrics);
  for (Gof& gof : gofs_) {
    auto coded = encode(gof, step, analysis_step, metrics);
    if (!coded) return coded.error();
    for (const GofBytes& of_gof : coded->gofs) trial.gof_bytes += of_gof.size();
    trial.gofs.push_back(std::move(*coded));
    if (progress) {
      progress(static_cast<double>(trial.gofs.size()) / static_cast<double>(gofs_.size()));
    }
  }
  trial.metrics = metrics.result();
  return trial;
}

}  // namespace rlpc
