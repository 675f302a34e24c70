// How long work will still take, by how far it has come.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace rlpc {

class TimeLeft {
 public:
  // The seconds that are left; none while that cannot be told: in the first seconds, and while
  // the work goes much faster or slower than before. seconds: since the start, rising;
  // fraction: done, 0 to 1.
  std::optional<double> update(double seconds, double fraction);

 private:
  struct Sample {
    double seconds = 0.0;
    double fraction = 0.0;
  };
  // Since the start, a second or more apart.
  std::vector<Sample> samples_{{}};
};

// "42 %", "42 %, 1 min 20 s left": rounded more where more is left.
std::string progress_text(double fraction, std::optional<double> seconds_left);

}  // namespace rlpc
