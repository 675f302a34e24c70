#include "encoder/meshes/gltf/frame_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::uint32_t kUsual = 30;
constexpr std::uint32_t kLowest = 24;       // lowest tried; lower rates have multiples above
constexpr std::uint32_t kHighest = 60;      // highest that needs no key at every other frame
constexpr std::uint32_t kDense = 240;       // highest that needs such keys
constexpr std::uint32_t kMaxAdvised = 600;  // the least common multiple of 24, 25 and 60
constexpr double kLimit = 1000.0;           // frames per second, for short clips

double frames_at(double seconds, const FrameRate& rate) {
  return seconds * rate.numerator / rate.denominator;
}

// Returns the distinct times of the keys of a clip, ascending. Channels often share theirs.
std::vector<float> key_times(const GltfClip& clip) {
  std::vector<float> times;
  const std::vector<float>* last = nullptr;
  for (const GltfClip::Channel& channel : clip.channels) {
    if (last != nullptr && *last == channel.track.times) continue;
    last = &channel.track.times;
    times.insert(times.end(), last->begin(), last->end());
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  times.erase(times.begin(), std::lower_bound(times.begin(), times.end(), 0.0F));
  return times;
}

using Keys = std::vector<std::vector<float>>;  // [clip], distinct times from 0 on

bool all_on(const GltfFrameGrid& grid, const std::vector<float>& times) {
  return std::all_of(times.begin(), times.end(), [&](float t) { return grid.holds(t); });
}

bool all_on(const GltfFrameGrid& grid, const Keys& keys) {
  return std::all_of(keys.begin(), keys.end(),
                     [&](const auto& times) { return all_on(grid, times); });
}

// Whether half of the frames, or more, are at keys.
bool is_dense(const GltfFrameGrid& grid, const Keys& keys) {
  double num_frames = 0.0;
  std::size_t num_keys = 0;
  for (const std::vector<float>& times : keys) {
    if (times.empty()) continue;
    num_frames += frames_at(times.back(), grid.rate) + 1.0;
    num_keys += times.size();
  }
  return 2.0 * static_cast<double>(num_keys) >= num_frames;
}

// Returns the rates to try, in this order.
std::vector<FrameRate> common_rates() {
  std::vector<FrameRate> rates{{kUsual, 1},   {kLowest, 1},  {25, 1},
                               {30000, 1001}, {24000, 1001}, {60000, 1001}};
  for (std::uint32_t n = kLowest; n <= kHighest; ++n) {
    if (n != kUsual && n != kLowest && n != 25) rates.push_back({n, 1});
  }
  return rates;
}

std::vector<FrameRate> dense_rates() {
  std::vector<FrameRate> rates{{120000, 1001}};
  for (std::uint32_t n = kHighest + 1; n <= kDense; ++n) rates.push_back({n, 1});
  return rates;
}

// Returns the rate on whose grid all keys are, if any.
std::optional<GltfFrameGrid> shared_grid(const Keys& keys,
                                         const std::optional<FrameRate>& hint) {
  std::vector<FrameRate> rates = common_rates();
  if (hint) rates.insert(rates.begin(), *hint);
  for (const FrameRate& rate : rates) {
    const GltfFrameGrid grid{rate};
    if (all_on(grid, keys)) return grid;
  }
  for (const FrameRate& rate : dense_rates()) {
    const GltfFrameGrid grid{rate};
    if (is_dense(grid, keys) && all_on(grid, keys)) return grid;
  }
  if (!all_on(GltfFrameGrid{{1000, 1}}, keys)) return std::nullopt;
  for (const FrameRate& rate : {FrameRate{30, 1},
                                {24, 1},
                                {25, 1},
                                {60, 1},
                                {50, 1},
                                {48, 1},
                                {30000, 1001},
                                {24000, 1001},
                                {60000, 1001}}) {
    const GltfFrameGrid grid{rate, true};
    if (all_on(grid, keys)) return grid;
  }
  return std::nullopt;
}

// Returns the simplest fraction that is x > 0 to the precision of a 32-bit float, from the
// continued fraction.
FrameRate simplest_fraction(double x) {
  constexpr double kMax = std::numeric_limits<std::uint32_t>::max();
  double before[2] = {0.0, 1.0};  // numerator, denominator
  double now[2] = {1.0, 0.0};
  double rest = x;
  for (;;) {
    const double whole = std::floor(rest);
    const double next[2] = {whole * now[0] + before[0], whole * now[1] + before[1]};
    if (next[0] > kMax || next[1] > kMax) break;
    std::copy(now, now + 2, before);
    std::copy(next, next + 2, now);
    if (std::abs(now[0] / now[1] - x) <= x * 0x1p-26 || rest == whole) break;
    rest = 1.0 / (rest - whole);
  }
  return {static_cast<std::uint32_t>(now[0]), static_cast<std::uint32_t>(now[1])};
}

std::string rate_text(const FrameRate& rate) {
  const double value = static_cast<double>(rate.numerator) / rate.denominator;
  return shortest_text(static_cast<float>(std::round(value * 1000.0) / 1000.0));
}

// Returns a note if keys lie on no common rate: the chosen rate, and a rate with all keys.
std::string note_of(const FrameRate& rate, const std::string& why, const Keys& keys) {
  const char* const of = keys.size() > 1 ? "animations lie" : "animation lie";
  std::string note = std::string("the keys of the ") + of +
                     " on no common frame rate: sampled at " + rate_text(rate) +
                     " frames per second, " + why + "; 'frame_rate' sets another rate";
  for (std::uint32_t n = kHighest + 1; n <= kMaxAdvised; ++n) {
    if (!all_on(GltfFrameGrid{{n, 1}}, keys)) continue;
    return note + ", " + to_string(n) + " has frames at all keys";
  }
  return note;
}

// Whether half of the keys, or more, are at frames.
bool half_on(const GltfFrameGrid& grid, const Keys& keys) {
  std::size_t num_keys = 0;
  std::size_t num_on = 0;
  for (const std::vector<float>& times : keys) {
    num_keys += times.size();
    num_on += static_cast<std::size_t>(
        std::count_if(times.begin(), times.end(), [&](float t) { return grid.holds(t); }));
  }
  return 2 * num_on >= num_keys;
}

// Returns a common rate at which all clips end with a frame, if any. A single clip always has
// such rates near 30, and takes another only if that has half of its keys.
std::optional<GltfFrameGrid> grid_of_ends(const Keys& keys) {
  Keys ends;
  for (const std::vector<float>& times : keys) {
    ends.emplace_back(times.end() - (times.empty() ? 0 : 1), times.end());
  }
  for (const FrameRate& rate : common_rates()) {
    const GltfFrameGrid grid{rate};
    const bool suits = keys.size() > 1 || rate == FrameRate{kUsual, 1} || half_on(grid, keys);
    if (!suits || !all_on(grid, ends)) continue;
    const char* const why = keys.size() > 1 ? "at which all of them end with a frame"
                                            : "at which it ends with a frame";
    return GltfFrameGrid{rate, false, note_of(rate, why, keys)};
  }
  return std::nullopt;
}

// Returns, for one clip, the next rate from 30 on that has a frame at its end.
GltfFrameGrid grid_to_end(double end, const Keys& keys) {
  const double steps = std::ceil(frames_at(end, {kUsual, 1}));
  FrameRate rate{kUsual, 1};
  const char* why = "as usual";
  if (steps > kLimit * end) {
    rate.numerator = static_cast<std::uint32_t>(kLimit);
    why = "as it is short";
  } else if (steps < 0x1p24) {
    rate = simplest_fraction(steps / end);
    why = "at which it ends with a frame";
  }
  return {rate, false, note_of(rate, why, keys)};
}

// Returns, for several clips, the rate with the keys of most clips; of several such rates, the
// one with most keys.
GltfFrameGrid grid_of_most(const Keys& keys) {
  GltfFrameGrid best{{kUsual, 1}};
  std::pair<std::size_t, std::size_t> max;  // clips, keys
  for (const FrameRate& rate : common_rates()) {
    const GltfFrameGrid grid{rate};
    std::pair<std::size_t, std::size_t> count;
    for (const std::vector<float>& times : keys) {
      if (times.empty() || times.back() == 0.0F || !all_on(grid, times)) continue;
      ++count.first;
      count.second += times.size();
    }
    if (count > max) max = count, best = grid;
  }
  std::size_t num_moving = 0;
  double late = 0.0;
  for (const std::vector<float>& times : keys) {
    if (times.empty() || times.back() == 0.0F) continue;
    ++num_moving;
    const double end = frames_at(times.back(), best.rate);
    if (!best.holds(times.back())) late = std::max(late, std::ceil(end) - end);
  }
  late = late * best.rate.denominator / best.rate.numerator;
  best.note =
      note_of(best.rate,
              "where those of " + to_string(max.first) + " of " + to_string(num_moving) +
                  " lie, and last poses come up to " +
                  shortest_text(static_cast<float>(std::ceil(late * 1e3) / 1e3)) + " s late",
              keys);
  return best;
}

}  // namespace

bool GltfFrameGrid::holds(double seconds) const {
  const double frames = frames_at(seconds, rate);
  const double off = std::abs(frames - std::round(frames));
  if (off <= std::min(1e-3 + frames * 0x1p-23, 0.02)) return true;
  return has_milliseconds && off <= frames_at(0.00051, rate);
}

double GltfFrameGrid::num_frames(const GltfClip& clip) const {
  if (clip.end == 0.0) return 1.0;
  const double frames = frames_at(clip.end, rate);
  const double last = holds(clip.end) ? std::round(frames) : std::ceil(frames);
  return std::max(last, 1.0) + 1.0;
}

double GltfFrameGrid::time_of(std::uint32_t frame, const GltfClip& clip) const {
  const double time =
      static_cast<float>(static_cast<double>(frame) * rate.denominator / rate.numerator);
  return frame + 1.0 < num_frames(clip) ? time : std::max(time, clip.end);
}

GltfFrameGrid choose_frame_grid(const std::vector<GltfClip>& clips,
                                const std::optional<FrameRate>& wanted,
                                const std::optional<FrameRate>& hint) {
  Keys keys;
  for (const GltfClip& clip : clips) keys.push_back(key_times(clip));
  if (wanted) {
    const GltfFrameGrid rounded{*wanted, true};
    const bool has_milliseconds = !all_on(GltfFrameGrid{*wanted}, keys) &&
                                  all_on(GltfFrameGrid{{1000, 1}}, keys) &&
                                  all_on(rounded, keys);
    return {*wanted, has_milliseconds};
  }
  if (const auto grid = shared_grid(keys, hint)) return *grid;
  if (const auto grid = grid_of_ends(keys)) return *grid;
  return clips.size() == 1 ? grid_to_end(clips[0].end, keys) : grid_of_most(keys);
}

void align_steps(const GltfFrameGrid& grid, std::vector<GltfClip>& clips) {
  for (GltfClip& clip : clips) {
    if (!all_on(grid, key_times(clip))) continue;
    for (GltfClip::Channel& channel : clip.channels) {
      std::vector<float>& times = channel.track.times;
      if (channel.track.interpolation != GltfInterpolation::kStep) continue;
      for (std::size_t i = 0; i < times.size(); ++i) {
        const double frame = std::round(frames_at(times[i], grid.rate));
        const auto aligned =
            static_cast<float>(frame * grid.rate.denominator / grid.rate.numerator);
        // Two keys at one frame are a jump right after it.
        if ((i > 0 && times[i - 1] >= aligned) ||
            (i + 1 < times.size() && times[i + 1] <= aligned)) {
          continue;
        }
        times[i] = aligned;
      }
    }
  }
}

}  // namespace rlpc
