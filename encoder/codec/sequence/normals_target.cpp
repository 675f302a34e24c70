#include "encoder/codec/sequence/normals_target.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/metrics/vertex_normals.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kFrames = 4;  // fixed: shapes of an animation differ little
// tuned (off: 1): The error of an encoding is smoother than noise: at the same deviation of
// normals, it is larger by about this factor.
constexpr double kSmoother = 1.2;

// Returns the same numbers every time, evenly distributed about 0, with a mean square of 1.
class Noise {
 public:
  double next() {
    constexpr std::uint32_t kFactor = 1664525;      // fixed: Numerical Recipes
    constexpr std::uint32_t kSummand = 1013904223;  // fixed: Numerical Recipes
    state_ = kFactor * state_ + kSummand;
    constexpr double kHalfWidth = 1.7320508075688772;  // fixed: square root of 3
    constexpr double kHalf = 0x1p31;                   // fixed: of all numbers
    return kHalfWidth * (static_cast<double>(state_) / kHalf - 1.0);
  }

 private:
  std::uint32_t state_ = 1;
};

// Some frames, one after the other.
struct Frames {
  std::vector<double> xyz;
  std::size_t values = 0;  // of a frame

  std::span<const double> frame(std::size_t f) const {
    return std::span(xyz).subspan(f * values, values);
  }
  std::size_t count() const { return xyz.size() / values; }
};

InputResult<Frames> read_some(FrameSource& source) {
  Frames frames{{}, 3 * std::size_t{source.num_vertices()}};
  const std::uint32_t count = std::min(source.num_frames(), kFrames);
  std::vector<double> xyz(frames.values);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t f =
        (2 * std::uint64_t{i} + 1) * source.num_frames() / (2 * std::uint64_t{count});
    if (auto error = source.read_exact(static_cast<std::uint32_t>(f), xyz)) return *error;
    frames.xyz.insert(frames.xyz.end(), xyz.begin(), xyz.end());
  }
  return frames;
}

// Returns the RMS of the coordinates about the mean of their frame.
double rms_spread(const Frames& frames) {
  double sum = 0.0;
  for (std::size_t f = 0; f < frames.count(); ++f) {
    const auto xyz = frames.frame(f);
    const std::size_t num_points = xyz.size() / 3;
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0.0;
      for (std::size_t i = c; i < xyz.size(); i += 3) mean += xyz[i];
      mean /= static_cast<double>(num_points);
      for (std::size_t i = c; i < xyz.size(); i += 3) sum += (xyz[i] - mean) * (xyz[i] - mean);
    }
  }
  return std::sqrt(sum / static_cast<double>(frames.xyz.size()));
}

// Returns the deviation of vertex normals under noise of an RMS error of a coordinate.
SquaredAngles deviation(const Frames& frames, std::span<const Triangle> triangles,
                        double rms_error) {
  Noise noise;
  SquaredAngles angles;
  std::vector<float> noisy(frames.values);
  for (std::size_t f = 0; f < frames.count(); ++f) {
    const auto xyz = frames.frame(f);
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      noisy[i] = static_cast<float>(xyz[i] + rms_error * noise.next());
    }
    angles += normal_deviation(triangles, xyz, noisy);
  }
  return angles;
}

}  // namespace

InputResult<double> expected_kg(FrameSource& source, std::span<const Triangle> triangles,
                                const Target& target) {
  constexpr int kHalvings = 16;          // fixed: precise enough
  constexpr double kSmallest = 0x1p-20;  // fixed: about the precision of floats
  const auto frames = read_some(source);
  if (!frames) return frames.error();
  const double spread = rms_spread(*frames);
  const auto keeps = [&](double part) {
    const double rms_error = part / kSmoother * spread;
    return deviation(*frames, triangles, rms_error).rms() <= target.max_normals;
  };
  if (keeps(target.value / 100.0)) return target.value;
  // The deviation rises with the noise.
  double low = kSmallest;
  double high = target.value / 100.0;
  for (int i = 0; i < kHalvings && low < high; ++i) {
    const double middle = std::sqrt(low * high);
    (keeps(middle) ? low : high) = middle;
  }
  return std::min(100.0 * low, target.value);
}

}  // namespace rlpc
