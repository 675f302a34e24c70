// Estimates the time left from the progress of work.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rlpc {

class TimeLeft {
 public:
  // Returns the seconds left; none while they are unknown: in the first seconds, and while work
  // is much faster or slower than before. seconds: since the start, increasing; fraction: done,
  // 0 to 1.
  std::optional<double> update(double seconds, double fraction);

 private:
  struct Sample {
    double seconds = 0.0;
    double fraction = 0.0;
  };
  // Samples since the start, at least a second apart.
  std::vector<Sample> samples_{{}};
};

// Formats "42 %" or "42 %, 1 min 20 s left"; longer times are rounded more.
std::string progress_text(double fraction, std::optional<double> seconds_left);

}  // namespace rlpc
