// Times the stages of an encoding, so that slow ones show.
#pragma once

#include <chrono>
#include <cstddef>
#include <string_view>
#include <vector>

namespace rlpc {

struct StageTime {
  std::string_view stage;
  double seconds = 0.0;  // without the stages within it
};

// Times what the thread that makes it does during its lifetime. Other threads that share its
// loops are not timed: with one thread, all of the time is.
class StageClock {
 public:
  StageClock();
  ~StageClock();
  StageClock(const StageClock&) = delete;
  StageClock& operator=(const StageClock&) = delete;

  // Returns the stages in the order in which they first began; the first one, "other", is what
  // was done in no stage. Cost: the number of stages.
  std::vector<StageTime> times() const;

 private:
  friend class Stage;

  // Ends the stage that is under way, begins another one and returns the one that ended.
  std::size_t change_to(std::size_t stage);
  std::size_t find(std::string_view name);

  StageClock* const before_;  // of the thread, until this one ends
  std::vector<StageTime> times_;
  std::size_t now_ = 0;  // index of the stage under way
  std::chrono::steady_clock::time_point since_;
};

// A stage, from here to the end of the scope, if the thread has a clock. name: a literal.
class Stage {
 public:
  explicit Stage(std::string_view name);
  ~Stage();
  Stage(const Stage&) = delete;
  Stage& operator=(const Stage&) = delete;

 private:
  StageClock* const clock_;  // may be null
  std::size_t outer_ = 0;    // index of the stage that this one is within
};

}  // namespace rlpc
