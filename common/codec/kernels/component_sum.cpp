#include "common/codec/kernels/component_sum.h"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr int kNarrowBits = 16;
constexpr int kLowLimbBits = 13;
constexpr std::int64_t kMaxSegmentSum = (std::int64_t{1} << 31) - 1;
constexpr std::size_t kMaxRows = 24;  // rows of sums that are computed at a time

// Returns the limbs of a factor, the lowest first.
Vector<FactorLimb> limbs_of(int bits) {
  if (bits <= kNarrowBits) return {{0, bits - 1, false}};
  return {{0, kLowLimbBits - 1, true}, {kLowLimbBits, bits - 1 - kLowLimbBits, false}};
}

}  // namespace

std::int32_t FactorLimb::of(std::int32_t value) const {
  if (shift == 0 && !is_low) return value;
  const auto high = static_cast<std::int32_t>(round2(value, kLowLimbBits));
  return is_low ? value - high * (1 << kLowLimbBits) : high;
}

void SpatialFactors::add(std::span<const std::int32_t> spatial, int spatial_bits,
                         std::size_t stride) {
  assert(spatial.size() + stride > num_values_ * stride);
  const int factor_bits = spatial_factor_bits(spatial_bits);
  const std::int32_t scale = 1 << (factor_bits - spatial_bits);
  for (const FactorLimb& limb : limbs_of(factor_bits)) {
    Limbs& limbs = limbs_[limb.shift == 0 ? 0 : 1];
    const std::size_t side = limbs.places.size() % 2;
    limbs.places.push_back({num_components_, limb.size_log2});
    limbs.tiles.resize(num_tiles());
    if (side == 0) {
      for (auto& tile : limbs.tiles) tile.resize(tile.size() + 2 * kTileValues);
    }
    for (std::size_t i = 0; i < num_values_; ++i) {
      auto& tile = limbs.tiles[i / kTileValues];
      tile[tile.size() - 2 * kTileValues + 2 * (i % kTileValues) + side] =
          static_cast<std::int16_t>(limb.of(spatial[i * stride] * scale));
    }
  }
  ++num_components_;
}

Vector<std::int32_t> SpatialFactors::tile(std::size_t tile) const {
  Vector<std::int32_t> factors(kTileValues * num_components_);
  for (std::size_t list = 0; list < limbs_.size(); ++list) {
    const std::int32_t unit = list == 0 ? 1 : 1 << kLowLimbBits;
    const Limbs& limbs = limbs_[list];
    for (std::size_t p = 0; p < limbs.places.size(); ++p) {
      const std::int16_t* const pair = &limbs.tiles[tile][2 * kTileValues * (p / 2)];
      for (std::size_t i = 0; i < kTileValues; ++i) {
        factors[i * num_components_ + limbs.places[p].component] += unit * pair[2 * i + p % 2];
      }
    }
  }
  return factors;
}

// Makes the segments of the products of one list of spatial limbs and one limb of the temporal
// factors: the low or only limb (0), or the high limb (1).
class ComponentSum::SegmentMaker {
 public:
  SegmentMaker(ComponentSum& sum, std::span<const TemporalFactor> temporal, std::size_t list,
               std::size_t limb)
      : sum_(sum), temporal_(temporal), list_(list), limb_(limb) {}

  void run() {
    const auto& places = sum_.spatial_->limbs_[list_].places;
    for (std::size_t pair = 0; 2 * pair < places.size(); ++pair) {
      std::array<std::int64_t, 2> bounds{};
      for (std::size_t side = 0; side < 2 && 2 * pair + side < places.size(); ++side) {
        bounds[side] = bound_of(places[2 * pair + side]);
      }
      if (bounds[0] + bounds[1] <= kMaxSegmentSum) {
        add(pair, bounds);
      } else {
        add(pair, {bounds[0], 0});
        add(pair, {0, bounds[1]});
      }
    }
  }

 private:
  // Returns the bound of the products of a component; 0 if it has none.
  std::int64_t bound_of(const SpatialFactors::Limbs::Place& place) const {
    if (place.component >= temporal_.size()) return 0;
    const int bits = temporal_[place.component].bits;
    if (bits == 0) return 0;
    const Vector<FactorLimb> limbs = limbs_of(bits);
    if (limb_ >= limbs.size()) return 0;
    return std::int64_t{1} << (limbs[limb_].size_log2 + place.size_log2);
  }

  // Adds a pair, whose sides with a bound of 0 count as zeros.
  void add(std::size_t pair, const std::array<std::int64_t, 2>& bounds) {
    const std::int64_t bound = bounds[0] + bounds[1];
    if (bound == 0) return;
    if (!is_open_ || bound_ + bound > kMaxSegmentSum ||
        sum_.segments_.back().first_pair + sum_.segments_.back().num_pairs != pair) {
      const int shift = kLowLimbBits * static_cast<int>(list_ + limb_);
      sum_.segments_.push_back({list_, shift, pair, 0, {}});
      bound_ = 0;
      is_open_ = true;
    }
    bound_ += bound;
    Segment& segment = sum_.segments_.back();
    const std::size_t first = segment.temporal.size();
    segment.temporal.resize(first + 2 * sum_.num_rows_);
    ++segment.num_pairs;
    for (std::size_t side = 0; side < 2; ++side) {
      if (bounds[side] == 0) continue;
      const auto& place = sum_.spatial_->limbs_[list_].places[2 * pair + side];
      const TemporalFactor& factor = temporal_[place.component];
      const FactorLimb limb = limbs_of(factor.bits)[limb_];
      for (std::size_t r = 0; r < sum_.num_rows_; ++r) {
        segment.temporal[first + 2 * r + side] =
            static_cast<std::int16_t>(limb.of(factor.values[r]));
      }
    }
  }

  ComponentSum& sum_;
  std::span<const TemporalFactor> temporal_;
  std::size_t list_;
  std::size_t limb_;
  bool is_open_ = false;
  std::int64_t bound_ = 0;
};

ComponentSum::ComponentSum(std::shared_ptr<const SpatialFactors> spatial,
                           std::span<const TemporalFactor> temporal, std::size_t num_rows,
                           const Kernels& loops)
    : spatial_(std::move(spatial)), num_rows_(num_rows), loops_(loops) {
  assert(temporal.size() <= spatial_->num_components());
  for (std::size_t list = 0; list < 2; ++list) {
    for (std::size_t limb = 0; limb < 2; ++limb)
      SegmentMaker(*this, temporal, list, limb).run();
  }
}

void ComponentSum::add_tile(std::size_t tile, std::size_t first_row, std::size_t num_rows,
                            std::span<std::int64_t> sums) const {
  assert(tile < spatial_->num_tiles() && first_row + num_rows <= num_rows_);
  assert(sums.size() == num_rows * kTileValues);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): sum_products() sets what is read.
  std::array<std::int32_t, kMaxRows * kTileValues> segment_sums;
  for (std::size_t r = 0; r < num_rows; r += kMaxRows) {
    const std::size_t rows = std::min(kMaxRows, num_rows - r);
    std::int64_t* const out = &sums[r * kTileValues];
    for (const Segment& segment : segments_) {
      const Vector<std::int16_t>& tile_values = spatial_->limbs_[segment.list].tiles[tile];
      const FactorPairs factors{segment.temporal.data(), num_rows_,
                                &tile_values[2 * kTileValues * segment.first_pair],
                                segment.num_pairs};
      loops_.sum_products(factors, first_row + r, rows, segment_sums.data());
      loops_.add_weighted(segment_sums.data(), 1 << segment.shift, rows * kTileValues, out);
    }
  }
}

}  // namespace rlpc
