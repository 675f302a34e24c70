#include "common/codec/kinds/skinned/influences.h"

#include <algorithm>
#include <cassert>

#include "common/codec/bits/int_math.h"
#include "common/codec/components/track_models.h"

namespace rlpc {

void InfluencePrediction::start(std::span<const std::uint32_t> ring) {
  ring_ = ring;
  found_ = {};
  num_extra_ = 0;
  left_ = total_;
  magnitude_before_ = 0;
  candidates_.clear();
  for (const std::uint32_t u : ring) {
    for (const Influence& influence : influences_[u]) {
      const auto known =
          std::find_if(candidates_.begin(), candidates_.end(),
                       [&](const Candidate& c) { return c.bone == influence.bone; });
      if (known != candidates_.end()) {
        known->sum += influence.weight;
      } else {
        candidates_.push_back({influence.bone, influence.weight});
      }
    }
  }
  std::sort(candidates_.begin(), candidates_.end(), [](const Candidate& a, const Candidate& b) {
    return a.sum != b.sum ? a.sum > b.sum : a.bone < b.bone;
  });
  if (candidates_.empty()) candidates_.push_back({0, 0});
}

bool InfluencePrediction::is_new_bone(std::uint32_t bone) const {
  return std::none_of(candidates_.begin(), candidates_.end(),
                      [&](const Candidate& c) { return c.bone == bone; }) &&
         std::none_of(found_.begin(), found_.end(),
                      [&](const Influence& i) { return i.bone == bone; });
}

void InfluencePrediction::add_extra_bone(std::uint32_t bone, int weight) {
  assert(can_add_bone() && weight > 0 && weight <= left_);
  ++num_extra_;
  add_influence(bone, weight);
}

int InfluencePrediction::candidate_mean(std::size_t k) const {
  const auto n = static_cast<std::int64_t>(ring_.size());
  return static_cast<int>(div_round(candidates_[k].sum, n));
}

std::uint32_t InfluencePrediction::expected(std::size_t k) const {
  const int mean = candidate_mean(k);
  std::int64_t difference = 0;
  for (const std::uint32_t u : ring_) {
    int weight = 0;
    for (const Influence& influence : influences_[u]) {
      if (influence.bone == candidates_[k].bone) weight = influence.weight;
    }
    difference += weight > mean ? weight - mean : mean - weight;
  }
  const auto n = static_cast<std::int64_t>(ring_.size());
  const std::int64_t sum =
      128 * div_round(16 * difference, n) + 5 * std::int64_t{magnitude_before_};
  return static_cast<std::uint32_t>(sum >> 8);
}

void InfluencePrediction::add_candidate(std::size_t k, std::int32_t residual) {
  if (found_.size < kMaxInfluences - 1) {
    add_influence(candidates_[k].bone,
                  clip3(0, left_, std::int64_t{candidate_mean(k)} + residual));
  }
  magnitude_before_ = clipped_magnitude(residual);
}

void InfluencePrediction::add_influence(std::uint32_t bone, std::int64_t weight) {
  if (weight == 0) return;
  found_.list[found_.size] = {static_cast<std::uint16_t>(bone),
                              static_cast<std::uint16_t>(weight)};
  ++found_.size;
  left_ -= static_cast<int>(weight);
}

Influences InfluencePrediction::finish() {
  add_influence(candidates_[0].bone, left_);
  return found_;
}

}  // namespace rlpc
