// 9.8.5 Expected magnitude of a rest residual.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/rest/counterparts.h"
#include "common/memory/owned.h"

namespace rlpc {

// 9.8.5: models of the elements of a vertex other than its residuals.
struct CounterpartModels {
  std::array<BitModel, 4> counterpart_flag;      // [Counterparts::context( )]
  std::array<BitModel, 2> new_counterpart_flag;  // [whether a counterpart was inherited]
};

// Models of residuals, [RestClass].
using RestModels = std::array<ResidualModels, kRestClasses>;

class RestContexts {
 public:
  explicit RestContexts(const RestOrder& order)
      : order_(order), magnitudes_(order.num_vertices()) {
    for (auto& class_means : mean_) class_means.fill(256);
  }

  // Starts vertex v, whose residuals follow, once its class is known. classes: classes of the
  // vertices before it.
  void start(std::uint32_t v, RestClass rest_class, const Counterparts& classes) {
    vertex_ = v;
    mean_of_class_ = &mean_[static_cast<std::size_t>(rest_class)];
    latest_mean_ = 0;
    std::array<std::uint32_t, kRestFactors> sums{};
    std::uint32_t count = 0;
    for (const std::uint32_t u : order_.ring(v)) {
      if (classes.class_of(u) != rest_class) continue;
      for (std::size_t c = 0; c < kRestFactors; ++c) sums[c] += magnitudes_[u][c];
      ++count;
    }
    for (std::size_t c = 0; c < kRestFactors; ++c) {
      ring_mean_[c] = count == 0 ? (*mean_of_class_)[c] : (sums[c] << 8) / count;
    }
  }
  std::uint32_t expected(std::size_t c) const {
    const std::uint64_t sum = 96 * std::uint64_t{(*mean_of_class_)[c]} +
                              88 * std::uint64_t{ring_mean_[c]} +
                              72 * std::uint64_t{latest_mean_};
    return static_cast<std::uint32_t>(sum >> 12);
  }
  // For estimates: the state that update() changes besides the magnitudes of the vertex.
  using OfCoordinates = std::array<std::uint32_t, kRestFactors>;
  using Means = std::array<OfCoordinates, kRestClasses>;
  const Means& means() const { return mean_; }
  void set_means(const Means& means) { mean_ = means; }

  void update(std::size_t c, std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    std::uint32_t& mean = (*mean_of_class_)[c];
    latest_mean_ = update_mean(latest_mean_, magnitude, 2);
    mean = update_mean(mean, magnitude, 5);
    magnitudes_[vertex_][c] =
        static_cast<std::uint8_t>(std::min<std::uint32_t>(magnitude, 255));
  }

 private:
  const RestOrder& order_;
  Means mean_{};                                               // RestMean
  Vector<std::array<std::uint8_t, kRestFactors>> magnitudes_;  // [num_vertices]
  // State of the current vertex.
  std::uint32_t vertex_ = 0;
  OfCoordinates* mean_of_class_ = nullptr;
  OfCoordinates ring_mean_{};
  std::uint32_t latest_mean_ = 0;
};

}  // namespace rlpc
