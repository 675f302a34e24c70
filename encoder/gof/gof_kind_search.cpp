#include "encoder/gof/gof_kind_search.h"

#include <utility>

#include "encoder/gof/component_cost.h"
#include "encoder/gof/lagrangian.h"

namespace rlpc {

GofKindSearch::GofKindSearch(const GofKinds& kinds, const GofFrames& frames, Preset preset)
    : kinds_(kinds), frames_(frames), preset_(preset), coders_(kinds.size()) {
  coders_.front() = kinds_.front()->make_coder(frames_);
}

void GofKindSearch::analyse(double analysis_step) { coders_[chosen_]->analyse(analysis_step); }

std::optional<double> GofKindSearch::expected_error(double step) const {
  return coders_[chosen_]->expected_error(step);
}

bool GofKindSearch::needs_frames(double step, double analysis_step) const {
  return must_compare() || coders_[chosen_]->needs_frames(step, analysis_step);
}

EncodedGof GofKindSearch::encode(double step, double analysis_step) {
  return must_compare() ? compare(step, analysis_step)
                        : coders_[chosen_]->encode(step, analysis_step);
}

bool GofKindSearch::may_win(const GofEncoder& kind, const EncodedGof& best, double step) const {
  if (preset_ == Preset::kSlow) return true;
  const auto expected = kind.estimate_cost(frames_, best, step);
  return expected && *expected < (1.0 + kTryMargin) * lagrangian_cost(best, frames_, step);
}

EncodedGof GofKindSearch::compare(double step, double analysis_step) {
  is_compared_ = true;
  EncodedGof best = coders_.front()->encode(step, analysis_step);
  for (std::size_t k = 1; k < kinds_.size(); ++k) {
    if (!may_win(*kinds_[k], best, step)) continue;
    auto coder = kinds_[k]->make_coder(frames_);
    EncodedGof other = coder->encode(step, analysis_step);
    if (lagrangian_cost(other, frames_, step) >= lagrangian_cost(best, frames_, step)) continue;
    best = std::move(other);
    coders_[k] = std::move(coder);
    chosen_ = k;
  }
  return best;
}

void GofKindSearch::release_analysis() {
  for (const auto& coder : coders_) {
    if (coder) coder->release_analysis();
  }
}

}  // namespace rlpc
