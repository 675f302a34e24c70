#include "encoder/codec/stage_clock.h"

#include <algorithm>
#include <utility>

namespace rlpc {
namespace {

thread_local StageClock* clock_of_thread = nullptr;

}  // namespace

StageClock::StageClock()
    : before_(std::exchange(clock_of_thread, this)),
      times_{{"other", 0.0}},
      since_(std::chrono::steady_clock::now()) {}

StageClock::~StageClock() { clock_of_thread = before_; }

std::vector<StageTime> StageClock::times() const {
  std::vector<StageTime> result = times_;
  const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - since_;
  result[now_].seconds += passed.count();
  return result;
}

std::size_t StageClock::change_to(std::size_t stage) {
  const auto now = std::chrono::steady_clock::now();
  times_[now_].seconds += std::chrono::duration<double>(now - since_).count();
  since_ = now;
  return std::exchange(now_, stage);
}

std::size_t StageClock::find(std::string_view name) {
  const auto found = std::find_if(times_.begin(), times_.end(),
                                  [&](const StageTime& time) { return time.stage == name; });
  if (found != times_.end()) return static_cast<std::size_t>(found - times_.begin());
  times_.push_back({name, 0.0});
  return times_.size() - 1;
}

Stage::Stage(std::string_view name) : clock_(clock_of_thread) {
  if (clock_ != nullptr) outer_ = clock_->change_to(clock_->find(name));
}

Stage::~Stage() {
  if (clock_ != nullptr) clock_->change_to(outer_);
}

}  // namespace rlpc
