#include "encoder/math/few_components.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "encoder/math/det_math.h"
#include "encoder/math/eigenvectors.h"
#include "encoder/math/matrix_products.h"

namespace rlpc {
namespace {

using Vectors = std::vector<std::vector<double>>;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  constexpr std::size_t kSums = 4;  // shortens the chain of additions
  double sum[kSums] = {};
  std::size_t i = 0;
  for (; i + kSums <= a.size(); i += kSums) {
    for (std::size_t k = 0; k < kSums; ++k) sum[k] += a[i + k] * b[i + k];
  }
  for (; i < a.size(); ++i) sum[0] += a[i] * b[i];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

// Gram-Schmidt, twice because of rounding. Linearly dependent vectors become 0.
void orthonormalise(Vectors& vectors) {
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    std::vector<double>& v = vectors[k];
    const double before = dot(v, v);
    for (int again = 0; again < 2; ++again) {
      for (std::size_t j = 0; j < k; ++j) subtract_multiple(dot(v, vectors[j]), vectors[j], v);
    }
    constexpr double kRounding = 1e-12;  // of single precision
    const double square = dot(v, v);
    const double scale =
        square > kRounding * before && square > 0.0 ? 1.0 / std::sqrt(square) : 0.0;
    for (double& x : v) x *= scale;
  }
}

class RangeFinder {
 public:
  RangeFinder(std::span<const float> matrix, std::size_t num_frames)
      : matrix_(matrix), width_(num_frames) {}

  std::optional<ComponentsByRow> find(std::size_t max_components, double least) {
    constexpr std::size_t kFirstCount = 24;
    constexpr std::size_t kMoreCount = 8;  // beyond the last that is wanted
    constexpr std::size_t kFewPart = 6;    // of all components: more are faster otherwise
    for (std::size_t count = kFirstCount; count <= width_ / kFewPart; count *= 2) {
      widen(count);
      for (int i = 0; i < kRounds; ++i) multiply();
      const EigenPairs within = eigenvectors_within();
      const std::vector<double>& values = within.values;
      const auto wanted = static_cast<std::size_t>(
          std::find_if(values.begin(), values.end(), [&](double x) { return !(x > least); }) -
          values.begin());
      if (wanted + kMoreCount <= count || count >= max_components + kMoreCount) {
        return components(within, std::min(wanted, max_components));
      }
      if (least > 0.0 && at_this_rate(values, least) > width_ / kFewPart) break;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kRounds = 2;

  // Extrapolates the number of values above `least` from how fast the second half of the values
  // falls.
  static std::size_t at_this_rate(const std::vector<double>& values, double least) {
    const std::size_t half = values.size() / 2;
    if (!(values.back() > least) || !(values[half] > values.back())) return values.size();
    const double fall = det_log2(values[half] / values.back());
    const double left = det_log2(values.back() / least);
    const double more = std::min(static_cast<double>(half) * left / fall, 1e6);
    return values.size() + static_cast<std::size_t>(more);
  }

  // Appends pseudo-random vectors.
  void widen(std::size_t count) {
    while (block_.size() < count) {
      std::vector<double>& v = block_.emplace_back(width_);
      for (double& x : v) {
        random_ = random_ * 6364136223846793005U + 1442695040888963407U;
        x = static_cast<double>(random_ >> 40) * 0x1p-24 - 0.5;
      }
    }
    orthonormalise(block_);
    project_rows();
  }

  // rows_ = matrix * block
  void project_rows() {
    const std::vector<double> columns = as_columns(block_, width_);
    const std::vector<float> single(columns.begin(), columns.end());
    rows_ = matrix_product(matrix_, width_, single, block_.size());
  }

  // block = matrix^T * matrix * block, orthonormalised.
  void multiply() {
    const std::size_t count = block_.size();
    const std::vector<float> products = transposed_product(matrix_, width_, rows_, count);
    for (std::size_t k = 0; k < count; ++k) {
      for (std::size_t i = 0; i < width_; ++i) block_[k][i] = products[i * count + k];
    }
    orthonormalise(block_);
    project_rows();
  }

  // Rayleigh-Ritz: eigenvectors in the span of the block, as combinations of it.
  EigenPairs eigenvectors_within() const {
    const std::size_t count = block_.size();
    const std::vector<double> rows(rows_.begin(), rows_.end());
    return leading_eigenvectors(gram_matrix(rows, count), count, count, -1.0);
  }

  ComponentsByRow components(const EigenPairs& within, std::size_t wanted) const {
    ComponentsByRow result;
    result.energy = within.values;
    const Vectors mixing(within.vectors.begin(),
                         within.vectors.begin() + static_cast<std::ptrdiff_t>(wanted));
    for (const auto& factors : mixing) {
      std::vector<double>& v = result.temporal.emplace_back(width_);
      for (std::size_t k = 0; k < block_.size(); ++k) {
        subtract_multiple(-factors[k], block_[k], v);
      }
    }
    if (wanted == 0) return result;
    const std::vector<double> columns = as_columns(mixing, block_.size());
    const std::vector<float> single(columns.begin(), columns.end());
    result.spatial = matrix_product(rows_, block_.size(), single, wanted);
    return result;
  }

  std::span<const float> matrix_;
  std::size_t width_;
  Vectors block_;            // orthonormal
  std::vector<float> rows_;  // [num_values][block size]
  std::uint64_t random_ = 1;
};

}  // namespace

std::optional<ComponentsByRow> few_components(std::span<const float> matrix,
                                              std::size_t num_frames,
                                              std::size_t max_components, double min_energy) {
  return RangeFinder(matrix, num_frames).find(max_components, min_energy);
}

}  // namespace rlpc
