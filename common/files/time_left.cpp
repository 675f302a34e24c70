#include "common/files/time_left.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace rlpc {
namespace {

constexpr double kInterval = 1.0;  // seconds between samples
constexpr double kMinSeconds = 4.0;
constexpr double kMinFraction = 0.01;
constexpr double kRecent = 0.25;   // recent part of the time that has passed
constexpr double kMaxRatio = 1.5;  // ratio of the estimates from recent and total pace

std::string left_text(double seconds) {
  const auto rounded = [&](long step) {
    return std::max(step, std::lround(seconds / static_cast<double>(step)) * step);
  };
  constexpr long kMinute = 60;
  constexpr long kHour = 3600;
  if (rounded(5) < kMinute) return std::to_string(rounded(5)) + " s left";
  const bool is_long = rounded(10) >= kHour;
  const long whole = is_long ? rounded(5 * kMinute) : rounded(10);
  const long unit = is_long ? kHour : kMinute;
  const long rest = whole % unit / (is_long ? kMinute : 1);
  std::string text = std::to_string(whole / unit) + (is_long ? " h" : " min");
  if (rest > 0) text += " " + std::to_string(rest) + (is_long ? " min" : " s");
  return text + " left";
}

}  // namespace

std::optional<double> TimeLeft::update(double seconds, double fraction) {
  if (seconds >= samples_.back().seconds + kInterval) samples_.push_back({seconds, fraction});
  if (seconds < kMinSeconds || fraction < kMinFraction) return std::nullopt;
  const double recently = seconds - std::max(kRecent * seconds, kInterval);
  const auto after =
      std::upper_bound(samples_.begin(), samples_.end(), recently,
                       [](double time, const Sample& s) { return time < s.seconds; });
  const Sample& before = *std::prev(after);  // the first is at 0
  // The recent pace is unknown after a long time without an update.
  if (before.seconds < seconds - 2 * kRecent * seconds) return std::nullopt;
  if (fraction <= before.fraction) return std::nullopt;
  const double usual = seconds * (1.0 - fraction) / fraction;
  const double recent =
      (seconds - before.seconds) * (1.0 - fraction) / (fraction - before.fraction);
  if (std::max(usual, recent) > kMaxRatio * std::min(usual, recent)) return std::nullopt;
  return (usual + recent) / 2;
}

std::string progress_text(double fraction, std::optional<double> seconds_left) {
  const int percent = static_cast<int>(fraction * 100.0);
  std::string text = std::to_string(percent) + " %";
  if (seconds_left && percent < 100) text += ", " + left_text(*seconds_left);
  return text;
}

}  // namespace rlpc
