#include "common/kernels/component_sum.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

namespace rlpc {
namespace {

constexpr int kNarrowBits = 16;
constexpr int kLowLimbBits = 13;
constexpr std::int64_t kMaxGroupSum = (std::int64_t{1} << 31) - 1;
constexpr std::size_t kMaxRows = 24;  // of the sums that are found at a time

}  // namespace

std::int32_t ComponentSum::Limb::of(std::int32_t value) const {
  if (shift == 0 && !is_low) return value;
  const auto high = static_cast<std::int32_t>(round2(value, kLowLimbBits));
  return is_low ? value - high * (1 << kLowLimbBits) : high;
}

std::vector<ComponentSum::Limb> ComponentSum::limbs_of(int bits) {
  if (bits <= kNarrowBits) return {{0, bits - 1, false}};
  return {{0, kLowLimbBits - 1, true}, {kLowLimbBits, bits - 1 - kLowLimbBits, false}};
}

ComponentSum::Group& ComponentSum::group_for(int shift, std::int64_t bound) {
  for (Group& group : groups_) {
    if (group.shift == shift && group.bound + bound <= kMaxGroupSum) return group;
  }
  Group group;
  group.shift = shift;
  group.spatial.resize(num_tiles());
  groups_.push_back(std::move(group));
  return groups_.back();
}

void ComponentSum::add(std::span<const std::int32_t> temporal, int temporal_bits,
                       std::span<const std::int32_t> spatial, int spatial_bits,
                       std::size_t stride) {
  assert(temporal.size() == num_rows_ && spatial.size() + stride > num_values_ * stride);
  const int factor_bits = spatial_factor_bits(spatial_bits);
  const std::int32_t scale = 1 << (factor_bits - spatial_bits);
  for (const Limb& t : limbs_of(temporal_bits)) {
    for (const Limb& s : limbs_of(factor_bits)) {
      const std::int64_t bound = std::int64_t{1} << (t.size_log2 + s.size_log2);
      Group& group = group_for(t.shift + s.shift, bound);
      const std::size_t side = group.size % 2;
      if (side == 0) {
        group.temporal.resize(group.temporal.size() + 2 * num_rows_);
        for (auto& tile : group.spatial) tile.resize(tile.size() + 2 * kTileValues);
      }
      group.bound += bound;
      ++group.size;
      std::int16_t* const of_rows =
          group.temporal.data() + group.temporal.size() - 2 * num_rows_ + side;
      for (std::size_t r = 0; r < num_rows_; ++r) {
        of_rows[2 * r] = static_cast<std::int16_t>(t.of(temporal[r]));
      }
      for (std::size_t i = 0; i < num_values_; ++i) {
        auto& tile = group.spatial[i / kTileValues];
        tile[tile.size() - 2 * kTileValues + 2 * (i % kTileValues) + side] =
            static_cast<std::int16_t>(s.of(spatial[i * stride] * scale));
      }
    }
  }
}

void ComponentSum::sum_tile(std::size_t tile, std::size_t first_row, std::size_t num_rows,
                            std::span<std::int64_t> sums) const {
  assert(tile < num_tiles() && first_row + num_rows <= num_rows_);
  assert(sums.size() == num_rows * kTileValues);
  std::fill(sums.begin(), sums.end(), 0);
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-member-init): sum_products() fills what is read.
  std::array<std::int32_t, kMaxRows * kTileValues> of_group;
  for (std::size_t r = 0; r < num_rows; r += kMaxRows) {
    const std::size_t rows = std::min(kMaxRows, num_rows - r);
    std::int64_t* const out = &sums[r * kTileValues];
    for (const Group& group : groups_) {
      const FactorPairs factors{group.temporal.data(), num_rows_, group.spatial[tile].data(),
                                (group.size + 1) / 2};
      loops_.sum_products(factors, first_row + r, rows, of_group.data());
      loops_.add_weighted(of_group.data(), 1 << group.shift, rows * kTileValues, out);
    }
  }
}

void ComponentSum::sum(std::size_t row, std::span<std::int64_t> sums) const {
  assert(sums.size() == num_values_ && row < num_rows_);
  std::array<std::int64_t, kTileValues> of_tile{};
  for (std::size_t tile = 0; tile < num_tiles(); ++tile) {
    sum_tile(tile, row, 1, of_tile);
    const auto rest = sums.subspan(tile * kTileValues);
    std::copy_n(of_tile.begin(), std::min(rest.size(), kTileValues), rest.begin());
  }
}

}  // namespace rlpc
