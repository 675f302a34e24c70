// Models and contexts of an attribute set (F.6).
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/attributes/sectors.h"
#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/mesh/corners.h"
#include "common/codec/mesh/mesh.h"
#include "common/memory/owned.h"

namespace rlpc {

// Data of earlier sets for the contexts of a set.
struct EarlierSets {
  Vector<bool> seams;    // EarlierSeam: seams of the last set of corners; empty: none
  Vector<bool> changes;  // EdgeChange: values of triangles differ across the edge

  // F.4 KeepSet( ), for a set of triangles with the given values.
  void add_triangle_values(std::span<const std::uint32_t> edge_mates,
                           std::span<const std::uint32_t> values, std::uint32_t components);
};

class SeamContexts {
 public:
  SeamContexts(std::uint32_t num_vertices, std::span<const Triangle> triangles,
               const EarlierSets& earlier)
      : triangles_(triangles), earlier_(earlier), count_(num_vertices, 0) {}

  BitModel& model(std::uint32_t c) {
    const std::uint32_t a = count_[vertex_of_corner(triangles_, c)];
    const std::uint32_t b = count_[vertex_of_corner(triangles_, next_corner(c))];
    // Index of an unordered pair of 0 to 2.
    std::uint32_t context = a + b;
    if (a == b && a > 0) {
      context = 3 + a;
    } else if (a + b == 3) {
      context = 3;
    }
    if (!earlier_.seams.empty()) context += earlier_.seams[c] ? 12U : 6U;
    if (earlier_.changes[c]) context += 18;
    return models_[context];
  }
  // SetSeam( ): counts the seam at its ends.
  void add_seam(std::uint32_t c, std::uint32_t mate) {
    for (const std::uint32_t corner : {c, mate}) {
      std::uint8_t& count = count_[vertex_of_corner(triangles_, corner)];
      count = static_cast<std::uint8_t>(std::min(count + 1, 2));
    }
  }

 private:
  std::array<BitModel, 36> models_;  // SeamModels
  std::span<const Triangle> triangles_;
  const EarlierSets& earlier_;
  Vector<std::uint8_t> count_;  // SeamCount, at most 2
};

class DiagonalContexts {
 public:
  explicit DiagonalContexts(std::size_t num_triangles) : count_(num_triangles, 0) {}

  BitModel& model(std::uint32_t c, std::uint32_t mate) {
    return models_[std::min<std::size_t>(2, std::size_t{count_[c / 3]} + count_[mate / 3])];
  }
  void add_flag(std::uint32_t c, std::uint32_t mate) {
    ++count_[c / 3];
    ++count_[mate / 3];
  }

 private:
  std::array<BitModel, 3> models_;  // DiagonalModels
  Vector<std::uint8_t> count_;      // DiagonalCount, at most 3
};

// Models of values, and means of residuals per class and component.
class ValueContexts {
 public:
  ValueContexts(const SectorOrder& order, std::uint32_t num_components)
      : order_(order), components_(num_components) {
    magnitude_.assign(order.order.size() * components_, 0);
    for (auto& means : mean_) means.fill(kFirstMean);
  }

  ResidualModels& models(std::uint32_t x) { return models_[order_.class_of[x]]; }
  std::array<BitModel, 64>& float_sizes(std::uint32_t x) {
    return float_sizes_[order_.class_of[x]];
  }
  // ValueExpected( c, x ). Its weights are tuned on the six models with texture coordinates or
  // normals: 40, 124, 92, or 72, 184 without the latest, take 1 % more bytes.
  std::uint32_t expected(std::uint32_t c, std::uint32_t x) const {
    const std::uint64_t mean = mean_[order_.class_of[x]][c];
    std::uint64_t ring = mean;
    if (const auto around = order_.ring[x]; !around.empty()) {
      std::uint64_t sum = 0;
      for (const std::uint32_t y : around) sum += magnitude_of_value(y, c);
      ring = (sum << 8) / around.size();
    }
    if (c == 0) return static_cast<std::uint32_t>((128 * mean + 128 * ring) >> 12);
    const std::uint64_t latest = std::uint64_t{magnitude_of_value(x, c - 1)} << 8;
    return static_cast<std::uint32_t>((96 * mean + 88 * ring + 72 * latest) >> 12);
  }
  // UpdateValueContext( )
  void update(std::uint32_t c, std::uint32_t x, std::int32_t residual) {
    std::uint32_t& mean = mean_[order_.class_of[x]][c];
    mean = update_mean(mean, magnitude_of(residual), 4);
    magnitude_[std::size_t{x} * components_ + c] =
        static_cast<std::uint16_t>(std::min<std::uint32_t>(magnitude_of(residual), 65535));
  }

 private:
  static constexpr std::uint32_t kFirstMean = 16 << 8;
  std::uint32_t magnitude_of_value(std::uint32_t x, std::uint32_t c) const {
    return magnitude_[std::size_t{x} * components_ + c];
  }

  const SectorOrder& order_;
  std::uint32_t components_;
  std::array<ResidualModels, kSectorClasses> models_;                 // ValueModels
  std::array<std::array<BitModel, 64>, kSectorClasses> float_sizes_;  // FloatSizeModels
  std::array<std::array<std::uint32_t, kMaxAttributeComponents>, kSectorClasses> mean_{};
  Vector<std::uint16_t> magnitude_;  // [sector][component], ValueMagnitude
};

// Candidates and models for values of triangles (F.2.3 triangle_values( )).
class TriangleContexts {
 public:
  TriangleContexts(std::span<const std::uint32_t> edge_mates, std::uint32_t num_components)
      : edge_mates_(edge_mates), components_(num_components) {
    mean_.fill(16 << 8);
  }

  // FindCandidates( t ): returns at most 3 triangles before t. values: all triangles before t.
  std::span<const std::uint32_t> find_candidates(std::uint32_t t,
                                                 std::span<const std::uint32_t> values);
  BitModel& same_rig(std::size_t i) { return same_models_[num_candidates_][i]; }
  ResidualModels& models() { return models_; }
  std::array<BitModel, 64>& float_sizes() { return float_sizes_; }
  std::uint32_t expected(std::uint32_t c) const { return mean_[c] >> 4; }
  void update(std::uint32_t c, std::int32_t residual) {
    mean_[c] = update_mean(mean_[c], magnitude_of(residual), 4);
  }

 private:
  std::span<const std::uint32_t> edge_mates_;
  std::uint32_t components_;
  std::array<std::uint32_t, 3> candidates_{};
  std::size_t num_candidates_ = 0;
  std::array<std::array<BitModel, 3>, 4> same_models_;  // SameValueModels
  ResidualModels models_;                               // ValueModels[ 0 ]
  std::array<BitModel, 64> float_sizes_;                // FloatSizeModels[ 0 ]
  std::array<std::uint32_t, kMaxAttributeComponents> mean_{};
};

}  // namespace rlpc
