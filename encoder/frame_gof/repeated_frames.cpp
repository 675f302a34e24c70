#include "encoder/frame_gof/repeated_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <unordered_map>

namespace rlpc {
namespace {

double on_grid(double value) { return std::floor(value + 0.5); }

// FNV-1a of the coordinates on the grid.
std::uint64_t hash_on_grid(std::span<const double> xyz) {
  constexpr std::uint64_t kPrime = 0x100000001b3;  // fixed: of FNV
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const double value : xyz) {
    hash =
        (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(on_grid(value)))) * kPrime;
  }
  return hash;
}

}  // namespace

bool are_equal_on_grid(std::span<const double> xyz, std::span<const double> other) {
  return std::equal(xyz.begin(), xyz.end(), other.begin(), other.end(),
                    [](double a, double b) { return on_grid(a) == on_grid(b); });
}

std::vector<std::uint32_t> repeat_distances(const FramePattern& pattern,
                                            std::span<const double> xyz, std::size_t values,
                                            std::uint32_t max_distance) {
  const FrameOrder order(pattern, static_cast<std::uint32_t>(xyz.size() / values));
  const auto frame_at = [&](std::uint32_t place) {
    return xyz.subspan(order[place].frame * values, values);
  };
  const auto layer_at = [&](std::uint32_t place) {
    return pattern.temporal_layer(order[place].depth);
  };
  std::vector<std::uint32_t> distances(order.num_frames());
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places;  // by hash
  for (std::uint32_t place = 0; place < order.num_frames(); ++place) {
    auto& alike = places[hash_on_grid(frame_at(place))];
    const auto found = std::find_if(alike.rbegin(), alike.rend(), [&](std::uint32_t before) {
      return layer_at(before) <= layer_at(place) &&
             are_equal_on_grid(frame_at(before), frame_at(place));
    });
    if (found != alike.rend() && place - *found <= max_distance) {
      distances[place] = place - *found;
    }
    alike.push_back(place);
  }
  return distances;
}

}  // namespace rlpc
