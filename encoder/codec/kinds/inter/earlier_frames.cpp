#include "encoder/codec/kinds/inter/earlier_frames.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <unordered_map>

#include "common/codec/bits/fixed_point.h"
#include "encoder/codec/kinds/inter/on_grid.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/spans/residual_choice.h"

namespace rlpc {
namespace {

constexpr std::size_t kSample = 256;          // fixed: time; coordinates
constexpr std::uint32_t kMaxSearched = 1024;  // fixed: time; places

// Returns FNV-1a of the coordinates on the grid.
std::uint64_t hash_on_grid(std::span<const double> xyz) {
  constexpr std::uint64_t kPrime = 0x100000001b3;  // fixed: FNV
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const double value : xyz) {
    hash =
        (hash ^ static_cast<std::uint64_t>(static_cast<std::int64_t>(on_grid(value)))) * kPrime;
  }
  return hash;
}

double squared_distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

class EarlierSearch {
 public:
  EarlierSearch(const FramePattern& pattern, std::span<const double> xyz, std::size_t values,
                std::uint32_t max_distance)
      : pattern_(pattern),
        xyz_(xyz),
        values_(values),
        max_distance_(max_distance),
        order_(pattern, static_cast<std::uint32_t>(xyz.size() / values)),
        sampled_(std::min(values, kSample)) {
    for (std::uint32_t f = 0; f < order_.num_frames(); ++f) {
      for (std::size_t i = 0; i < sampled_; ++i) {
        samples_.push_back(frame(f)[i * values / sampled_]);
      }
    }
  }

  std::vector<EarlierFrame> run() {
    std::vector<EarlierFrame> earlier(order_.num_frames());
    std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> places;  // [hash]
    for (std::uint32_t place = 0; place < order_.num_frames(); ++place) {
      auto& alike = places[hash_on_grid(frame(order_[place].frame))];
      if (const auto equal = last_equal(place, alike)) {
        earlier[place] = {place - *equal, true};
      } else if (place > 0) {
        earlier[place] = {nearest(place), false};
      }
      alike.push_back(place);
    }
    return earlier;
  }

 private:
  std::span<const double> frame(std::uint32_t f) const {
    return xyz_.subspan(f * values_, values_);
  }
  std::span<const double> sample(std::uint32_t f) const {
    return std::span(samples_).subspan(f * sampled_, sampled_);
  }
  bool may_refer(std::uint32_t place, std::uint32_t before) const {
    return pattern_.temporal_layer(order_[before].depth) <=
           pattern_.temporal_layer(order_[place].depth);
  }

  std::optional<std::uint32_t> last_equal(std::uint32_t place,
                                          const std::vector<std::uint32_t>& alike) const {
    const auto found = std::find_if(alike.rbegin(), alike.rend(), [&](std::uint32_t before) {
      return may_refer(place, before) &&
             are_equal_on_grid(frame(order_[before].frame), frame(order_[place].frame));
    });
    if (found == alike.rend() || place - *found > max_distance_) return std::nullopt;
    return *found;
  }

  // Returns the distance of the nearest frame; 0: none is nearer than the reference of the
  // pattern.
  std::uint32_t nearest(std::uint32_t place) const {
    const FramePlace& own = order_[place];
    const auto xyz = sample(own.frame);
    const std::vector<double> reference =
        reference_of(own, sample(own.first), sample(own.second));
    double min = squared_distance(xyz, reference);
    std::uint32_t distance = 0;
    for (std::uint32_t d = 1; d <= std::min({place, max_distance_, kMaxSearched}); ++d) {
      if (!may_refer(place, place - d)) continue;
      const double other = squared_distance(xyz, sample(order_[place - d].frame));
      if (other >= min) continue;
      min = other;
      distance = d;
    }
    return distance;
  }

  const FramePattern& pattern_;
  std::span<const double> xyz_;
  std::size_t values_;
  std::uint32_t max_distance_;
  FrameOrder order_;
  std::size_t sampled_;
  std::vector<double> samples_;  // [num_frames][sampled_]
};

// Returns the bits per value of a two-sided geometric distribution with this mean magnitude.
double entropy(double mean) {
  if (mean <= 0.0) return 0.0;
  const double ratio = (std::sqrt(1.0 + mean * mean) - 1.0) / mean;
  return det_log2((1.0 + ratio) / (1.0 - ratio)) - mean * det_log2(ratio);
}

}  // namespace

bool are_equal_on_grid(std::span<const double> xyz, std::span<const double> other) {
  return std::equal(xyz.begin(), xyz.end(), other.begin(), other.end(),
                    [](double a, double b) { return on_grid(a) == on_grid(b); });
}

std::vector<double> reference_of(const FramePlace& place, std::span<const double> first,
                                 std::span<const double> second) {
  const double second_weight =
      place.first == place.second
          ? 0.0
          : static_cast<double>(place.frame - place.first) / (place.second - place.first);
  std::vector<double> reference(first.size());
  for (std::size_t i = 0; i < first.size(); ++i) {
    reference[i] = first[i] + second_weight * (second[i] - first[i]);
  }
  return reference;
}

std::vector<EarlierFrame> earlier_frames(const FramePattern& pattern,
                                         std::span<const double> xyz, std::size_t values,
                                         std::uint32_t max_distance) {
  return EarlierSearch(pattern, xyz, values, max_distance).run();
}

double bits_from(const OrderedMesh& mesh, std::span<const double> xyz,
                 std::span<const double> reference, std::uint32_t step) {
  const double grid_step = static_cast<double>(step) / (1 << kPointFractionBits);
  const auto motion = [&](std::uint32_t v, std::size_t c) {
    return xyz[3 * std::size_t{v} + c] - reference[3 * std::size_t{v} + c];
  };
  double bits = 0.0;
  for (std::uint32_t layer = 0; layer < mesh.num_layers(); ++layer) {
    double magnitude = 0.0;
    const auto vertices = mesh.vertices_of_layers(layer, layer + 1);
    for (const std::uint32_t v : vertices) {
      const auto ring = mesh.ring(v);
      for (std::size_t c = 0; c < 3; ++c) {
        double mean = 0.0;
        for (const std::uint32_t u : ring) mean += motion(u, c);
        if (!ring.empty()) mean /= static_cast<double>(ring.size());
        magnitude +=
            std::abs(rounded_residual((motion(v, c) - mean) / grid_step, 0.5 - kDeadZone));
      }
    }
    const auto count = static_cast<double>(3 * vertices.size());
    if (count > 0.0) bits += count * entropy(magnitude / count);
  }
  return bits;
}

}  // namespace rlpc
