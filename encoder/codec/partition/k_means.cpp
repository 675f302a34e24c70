#include "encoder/codec/partition/k_means.h"

#include <algorithm>
#include <limits>
#include <vector>

#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

constexpr int kRounds = 50;              // fixed: time; most meshes settle before
constexpr std::size_t kTogether = 1024;  // fixed: points of a pass

class KMeans {
 public:
  KMeans(std::span<const double> points, std::size_t dimensions)
      : points_(points),
        dimensions_(dimensions),
        num_points_(points.size() / dimensions),
        nearest_(num_points_) {}

  Partition run(std::uint32_t count) {
    seed(count);
    for (int i = 0; i < kRounds; ++i) {
      if (!assign()) break;
      move_centres();
    }
    return nearest_;
  }

 private:
  const double* point(std::size_t i) const { return &points_[i * dimensions_]; }
  double distance(const double* a, const double* b) const {
    double sum = 0.0;
    for (std::size_t d = 0; d < dimensions_; ++d) sum += (a[d] - b[d]) * (a[d] - b[d]);
    return sum;
  }

  void seed(std::uint32_t count) {
    std::vector<double> mean(dimensions_);
    for (std::size_t i = 0; i < num_points_; ++i) {
      for (std::size_t d = 0; d < dimensions_; ++d) mean[d] += point(i)[d];
    }
    for (double& x : mean) x /= static_cast<double>(num_points_);
    std::vector<double> away(num_points_);
    for (std::size_t i = 0; i < num_points_; ++i) away[i] = distance(point(i), mean.data());
    while (centres_.size() < count * dimensions_) {
      const auto farthest = std::max_element(away.begin(), away.end());
      if (!centres_.empty() && *farthest <= 0.0) return;
      const double* const chosen = point(static_cast<std::size_t>(farthest - away.begin()));
      if (centres_.empty()) {
        std::fill(away.begin(), away.end(), std::numeric_limits<double>::infinity());
      }
      centres_.insert(centres_.end(), chosen, chosen + dimensions_);
      for (std::size_t i = 0; i < num_points_; ++i) {
        away[i] = std::min(away[i], distance(point(i), chosen));
      }
    }
  }

  // Whether any point changed its centre.
  bool assign() {
    std::vector<std::uint8_t> changed(num_points_ / kTogether + 1);
    for_ranges(num_points_, kTogether, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        std::size_t best = 0;
        double min = std::numeric_limits<double>::infinity();
        for (std::size_t k = 0; k * dimensions_ < centres_.size(); ++k) {
          const double away = distance(point(i), &centres_[k * dimensions_]);
          if (away >= min) continue;
          min = away;
          best = k;
        }
        if (nearest_[i] != best) changed[i / kTogether] = 1;
        nearest_[i] = static_cast<std::uint16_t>(best);
      }
    });
    return std::find(changed.begin(), changed.end(), 1) != changed.end();
  }

  // A centre without points stays.
  void move_centres() {
    std::vector<double> sum(centres_.size());
    std::vector<double> count(centres_.size() / dimensions_);
    for (std::size_t i = 0; i < num_points_; ++i) {
      ++count[nearest_[i]];
      for (std::size_t d = 0; d < dimensions_; ++d) {
        sum[nearest_[i] * dimensions_ + d] += point(i)[d];
      }
    }
    for (std::size_t k = 0; k < count.size(); ++k) {
      for (std::size_t d = 0; d < dimensions_ && count[k] > 0.0; ++d) {
        centres_[k * dimensions_ + d] = sum[k * dimensions_ + d] / count[k];
      }
    }
  }

  std::span<const double> points_;
  std::size_t dimensions_;
  std::size_t num_points_;
  std::vector<double> centres_;  // [count][dimensions]
  Partition nearest_;
};

}  // namespace

Partition k_means(std::span<const double> points, std::size_t dimensions, std::uint32_t count) {
  return KMeans(points, dimensions).run(count);
}

}  // namespace rlpc
