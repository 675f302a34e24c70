#include "encoder/codec/spans/kind_search.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {

KindSearch::KindSearch(const KindEncoders& kinds, const SpanFrames& frames, Preset preset)
    : kinds_(kinds), frames_(frames), preset_(preset), coders_(kinds.size()) {
  coders_.front() = kinds_.front()->make_coder(frames_);
}

void KindSearch::set_progress(const Progress& progress) {
  coders_.front()->set_progress(progress);
}

void KindSearch::analyse(double analysis_step) { coders_[chosen_]->analyse(analysis_step); }

std::optional<double> KindSearch::expected_error(double step) const {
  return coders_[chosen_]->expected_error(step);
}

bool KindSearch::needs_frames(double step, double analysis_step) const {
  return must_compare() || coders_[chosen_]->needs_frames(step, analysis_step);
}

EncodedSpan KindSearch::encode(double step, double analysis_step) {
  return must_compare() ? compare(step, analysis_step)
                        : coders_[chosen_]->encode(step, analysis_step);
}

EncodedSpan KindSearch::compare(double step, double analysis_step) {
  is_compared_ = true;
  coders_.front()->analyse(analysis_step);
  const std::uint32_t components = coders_.front()->expected_components();
  std::vector<std::size_t> tried{0};
  for (std::size_t k = 1; k < kinds_.size(); ++k) {
    if (preset_ != Preset::kSlow && !kinds_[k]->may_win(frames_, components)) continue;
    coders_[k] = kinds_[k]->make_coder(frames_);
    tried.push_back(k);
  }
  std::vector<EncodedSpan> encoded(tried.size());
  std::vector<double> cost(tried.size());
  for_each(tried.size(), [&](std::size_t i) {
    encoded[i] = coders_[tried[i]]->encode(step, analysis_step);
    cost[i] = tried.size() > 1 ? lagrangian_cost(encoded[i], frames_, step) : 0.0;
  });
  const auto best =
      static_cast<std::size_t>(std::min_element(cost.begin(), cost.end()) - cost.begin());
  chosen_ = tried[best];
  for (const std::size_t k : tried) {
    if (k != chosen_ && k > 0) coders_[k].reset();
  }
  return std::move(encoded[best]);
}

void KindSearch::release_analysis() {
  for (const auto& coder : coders_) {
    if (coder) coder->release_analysis();
  }
}

}  // namespace rlpc
