#include "encoder/codec/sequence/target_loop.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "encoder/codec/spans/span_coder.h"

namespace rlpc {
namespace {

// Returns the KG error or, if vertex normals are bounded as well, the part of the bounds that
// an encoding uses up, in units of the likely KG error.
double likely_kg_of(const Target& target, const Metrics& metrics) {
  if (target.max_normals == 0.0) return metrics.kg_error_percent;
  return target.likely_kg() *
         std::max(metrics.kg_error_percent / target.value,
                  metrics.vertex_normals.value_or(0.0) / target.max_normals);
}

double measured(const TargetTask& task, const BatchTrial& trial, std::uint32_t num_frames) {
  switch (task.settings.target.kind) {
    case Target::kKg:
      return likely_kg_of(task.settings.target, trial.metrics);
    case Target::kMaxError:
      return trial.metrics.max_error;
    case Target::kBpvf:
      return (8.0 * static_cast<double>(trial.gof_bytes) + task.fixed_bits) /
             (static_cast<double>(task.header.num_vertices) * num_frames);
    case Target::kNone:
    case Target::kLossless:
      break;
  }
  return 0.0;
}

// Estimates the KG error at a step from the analyses; empty if there is no estimate.
TargetSearch::Expected expected_kg(const TargetTask& task, const SpanBatch& batch) {
  if (task.settings.target.kind != Target::kKg) return {};
  auto squared_error = batch.expected_error();
  if (!squared_error) return {};
  const double spread = task.rms_spread * exact_exp2(-task.header.grid.log2_step);
  const double squared_spread =
      spread * spread * 3.0 * task.header.num_vertices * batch.num_frames();
  return [squared_error = std::move(squared_error), squared_spread](double step) {
    return 100.0 * std::sqrt(squared_error(step) / squared_spread);
  };
}

bool fits_level(const TargetTask& task, const BatchTrial& trial) {
  const std::uint32_t level_idc = task.header.level_idc;
  return std::all_of(trial.spans.begin(), trial.spans.end(), [&](const SpanResult& gof) {
    const auto needed = gof.needs.level_from(level_idc);
    return needed && (!task.keeps_level || *needed == level_idc);
  });
}

SpanBatch::Progress progress_of(const TargetTask& task, std::uint32_t trial) {
  return [&task, trial](double done) {
    if (task.progress) task.progress(trial, done);
  };
}

InputResult<TargetSearch> begin_search(const TargetTask& task, SpanBatch& batch,
                                       std::uint32_t trials) {
  TargetSearch search = search_for(task.settings, task.header, task.rms_spread);
  if (task.settings.profile == Profile::kHigh) search.set_costly();
  if (task.settings.preset == Preset::kFast) search.set_quick();
  if (task.first_step > 0.0) {
    search.begin_at(task.first_step);
  } else if (task.settings.target.kind == Target::kKg) {
    const auto progress = progress_of(task, trials + 1);
    if (auto error = batch.analyse(search.analysis_step(), progress)) return *error;
    if (const auto expected = expected_kg(task, batch)) search.begin_at(expected);
  }
  return search;
}

// tuned (off: 1): A search is given up where an encoding takes more bytes than the best result,
// at equal error, by this factor.
constexpr double kFarAll = 1.05;

InputResult<TargetResult> search_steps(const TargetTask& task, SpanBatch& batch,
                                       std::uint32_t trials_before) {
  auto begun = begin_search(task, batch, trials_before);
  if (!begun) return begun.error();
  TargetSearch& search = *begun;
  std::uint32_t trials = trials_before;
  std::optional<TargetResult> best;
  std::uint64_t bytes = 0;
  while (!search.finished()) {
    ++trials;
    auto trial = batch.encode(search.step(), search.analysis_step(), progress_of(task, trials));
    if (!trial) return trial.error();
    const double value = measured(task, *trial, batch.num_frames());
    const bool better = search.report(value, trial->gof_bytes, expected_kg(task, batch));
    if (search.is_located()) batch.keep_num_components();
    // Bones, rest positions and factors of earlier rigs do not follow the step.
    const bool is_stuck =
        !search.met() && batch.uses_earlier_rigs() && trial->gof_bytes == bytes;
    bytes = trial->gof_bytes;
    const bool is_hopeless = task.rival && task.rival->is_out_of_reach(*trial, kFarAll);
    if (better || !best) best = TargetResult{std::move(*trial), search.last_step(), value};
    best->given_up = is_hopeless;
    if (is_stuck || is_hopeless) break;
  }
  best->met = search.met();
  best->trials = trials;
  return std::move(*best);
}

}  // namespace

TargetSearch search_for(const EncoderSettings& settings, const SequenceHeader& header,
                        double rms_spread) {
  const double steps_per_unit = exact_exp2(-header.grid.log2_step);
  // tuned: The first step of a search, per error of a coordinate. It decides how close the
  // first encoding is to the target, and with it how many encodings follow.
  constexpr double kStepOfError = 9.0;
  // The same if all GOFs are inter GOFs, whose positions are quantised themselves.
  constexpr double kStepOfFrameError = 2.9;  // fixed: measured: mostly 2.8 to 3.2
  // tuned (off: 1): With the fast preset, an analysis is made for a step that is finer by this
  // factor. Its rest positions then cost more, and leave less for trajectories whose residuals
  // are not chosen by rate.
  constexpr double kFinerFast = 1.25;
  const bool fast = settings.profile != Profile::kBaseline && settings.preset == Preset::kFast;
  const double finer = fast ? kFinerFast : 1.0;
  const AnalysisRange range{.finest = finer / kAnalysisServes,
                            .made_for = finer,
                            .coarsest = finer * kAnalysisServes};
  const double step_of_error =
      settings.usable_kind() == GofKind::kInter ? kStepOfFrameError : kStepOfError;
  Target target = settings.target;
  if (target.kind == Target::kKg) target.value = target.likely_kg();
  return {target, rms_spread * steps_per_unit, steps_per_unit, step_of_error, range};
}

InputResult<TargetResult> reach_target(const TargetTask& task, SpanBatch& batch) {
  auto best = search_steps(task, batch, 0);
  const auto is_missed = [&] { return best && !best->met && !best->given_up; };
  const auto search_again = [&](const TargetTask& changed) {
    auto other = search_steps(changed, batch, best->trials);
    if (!other) {
      best = std::move(other);
      return;
    }
    const std::uint32_t trials = other->trials;
    const bool closer = other->met || other->measured < best->measured;
    if (closer && fits_level(task, other->trial)) best = std::move(other);
    best->trials = trials;
  };
  if (is_missed() && batch.use_own_rigs()) search_again(task);
  if (is_missed() && task.settings.target.kind == Target::kBpvf) {
    // Clusters and components that were chosen at a fine step can need more bits than a low
    // rate allows, at any step.
    batch.choose_again();
    TargetTask from_there = task;
    from_there.first_step = best->step;
    search_again(from_there);
  }
  if (is_missed() && batch.use_last_resort()) search_again(task);
  if (best) best->contested = batch.is_contested();
  return best;
}

}  // namespace rlpc
