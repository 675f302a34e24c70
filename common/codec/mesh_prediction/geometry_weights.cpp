#include "common/codec/mesh_prediction/geometry_weights.h"

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr int kOffsetBits = 11;
constexpr int kMomentBits = 14;
constexpr int kSolutionFractionBits = 16;
constexpr int kChangeBits = 17;
constexpr std::int64_t kOne = std::int64_t{1} << kWeightFractionBits;

using Moment = std::array<std::int64_t, 6>;  // xx, yy, zz, xy, xz, yz
constexpr std::array<std::size_t, 6> kMomentRow{0, 1, 2, 0, 0, 1};
constexpr std::array<std::size_t, 6> kMomentColumn{0, 1, 2, 1, 2, 2};

// 8.11.2 SolveMoment( m ): none if the determinant is not positive.
std::optional<Vec3l> solve_moment(const Moment& m, const Vec3l& gap) {
  const std::int64_t xx = m[1] * m[2] - m[5] * m[5];
  const std::int64_t yy = m[0] * m[2] - m[4] * m[4];
  const std::int64_t zz = m[0] * m[1] - m[3] * m[3];
  const std::int64_t xy = m[4] * m[5] - m[3] * m[2];
  const std::int64_t xz = m[3] * m[5] - m[4] * m[1];
  const std::int64_t yz = m[3] * m[4] - m[5] * m[0];
  const std::int64_t determinant = m[0] * xx + m[3] * xy + m[4] * xz;
  if (determinant <= 0) return std::nullopt;
  Vec3l solution{xx * gap[0] + xy * gap[1] + xz * gap[2],
                 xy * gap[0] + yy * gap[1] + yz * gap[2],
                 xz * gap[0] + yz * gap[1] + zz * gap[2]};
  for (std::int64_t& x : solution) {
    x = clip_signed(32, div_round(x * (std::int64_t{1} << kSolutionFractionBits), determinant));
  }
  return solution;
}

// Computes the weights of one vertex.
class VertexWeights {
 public:
  VertexWeights(const WeightSettings& settings,
                const std::array<std::span<const std::int32_t>, 3>& rest)
      : settings_(settings), rest_(rest) {}

  std::span<const std::int64_t> find(std::uint32_t v, std::span<const std::uint32_t> ring,
                                     std::span<const std::uint32_t> outer_ring) {
    ring_size_ = ring.size();
    plain_weights(outer_ring.size());
    if (settings_.damping_log2 > 0 && ring_size_ > 1) {
      vertices_.assign(ring.begin(), ring.end());
      vertices_.insert(vertices_.end(), outer_ring.begin(), outer_ring.end());
      find_offsets(v);
      adjust();
    }
    return weights_;
  }

 private:
  // 8.11 PlainWeights( v )
  void plain_weights(std::size_t outer_size) {
    weights_.assign(ring_size_ + outer_size, 0);
    const auto n = static_cast<std::int64_t>(ring_size_);
    const auto m = static_cast<std::int64_t>(outer_size);
    const std::int64_t a = m == 0 ? 0 : settings_.outer_weight;
    const std::int64_t ring_weight = n > 0 ? div_round((16 + a) << 10, n) : 0;
    const std::int64_t outer_weight = m > 0 ? -div_round(a << 10, m) : 0;
    std::fill_n(weights_.begin(), ring_size_, ring_weight);
    std::fill(weights_.begin() + static_cast<std::ptrdiff_t>(n), weights_.end(), outer_weight);
    const std::int64_t left = kOne - n * ring_weight - m * outer_weight;
    if (n > 0) weights_[0] += left;
  }

  // 8.11.1 Offsets
  void find_offsets(std::uint32_t v) {
    offsets_.resize(vertices_.size());
    std::int64_t largest = 1;
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < ring_size_; ++k) sum += rest_[c][vertices_[k]];
      const std::int64_t centre = div_round(sum, static_cast<std::int64_t>(ring_size_));
      gap_[c] = rest_[c][v] - centre;
      largest = std::max(largest, std::abs(gap_[c]));
      for (std::size_t k = 0; k < vertices_.size(); ++k) {
        offsets_[k][c] = rest_[c][vertices_[k]] - centre;
        largest = std::max(largest, std::abs(offsets_[k][c]));
      }
    }
    const int shift = floor_log2(static_cast<std::uint64_t>(largest)) - (kOffsetBits - 1);
    for (std::size_t c = 0; c < 3; ++c) {
      std::int64_t sum = 0;
      for (std::size_t k = 0; k < vertices_.size(); ++k) {
        offsets_[k][c] = shift_by(offsets_[k][c], shift);
        sum += weights_[k] * offsets_[k][c];
      }
      gap_[c] = shift_by(gap_[c], shift) - round2(sum, kWeightFractionBits);
    }
  }

  // 8.11.2 Adjustment
  void adjust() {
    const auto n = static_cast<std::int64_t>(ring_size_);
    std::int64_t square = 0;
    Moment moment{};
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      Vec3l& o = offsets_[k];
      for (std::int64_t& x : o) {
        if (k < ring_size_) {
          square += x * x;
        } else {
          x = round2(x * settings_.outer_scale, 4);
        }
      }
      for (std::size_t i = 0; i < 6; ++i) moment[i] += o[kMomentRow[i]] * o[kMomentColumn[i]];
    }
    const std::int64_t damping =
        std::max<std::int64_t>(div_round(square, n) >> settings_.damping_log2, 1);
    for (std::size_t i = 0; i < 3; ++i) moment[i] += damping;
    const std::int64_t largest = std::max({moment[0], moment[1], moment[2]});
    const int shift =
        std::max(floor_log2(static_cast<std::uint64_t>(largest)) - (kMomentBits - 1), 0);
    for (std::int64_t& m : moment) m = round2(m, shift);
    const auto solution = solve_moment(moment, gap_);
    if (!solution) return;
    std::int64_t total = 0;
    for (std::size_t k = 0; k < offsets_.size(); ++k) {
      const Vec3l& o = offsets_[k];
      const std::int64_t sum =
          o[0] * (*solution)[0] + o[1] * (*solution)[1] + o[2] * (*solution)[2];
      std::int64_t change = round2(sum, kSolutionFractionBits - kWeightFractionBits + shift);
      if (k >= ring_size_) change = round2(change * settings_.outer_scale, 4);
      change = clip_signed(kChangeBits, change);
      weights_[k] += change;
      total += change;
    }
    const std::int64_t share = div_round(total, n);
    for (std::size_t k = 0; k < ring_size_; ++k) weights_[k] -= share;
    weights_[0] -= total - n * share;
  }

  const WeightSettings& settings_;
  const std::array<std::span<const std::int32_t>, 3>& rest_;
  std::size_t ring_size_ = 0;
  Vector<std::uint32_t> vertices_;  // ring, then outer ring
  Vector<std::int64_t> weights_;
  Vector<Vec3l> offsets_;
  Vec3l gap_{};
};

}  // namespace

GeometryWeights::GeometryWeights(const OrderedMesh& mesh, const WeightSettings& settings,
                                 const std::array<std::span<const std::int32_t>, 3>& rest,
                                 const VertexLists* outer)
    : first_(std::size_t{mesh.num_vertices()} + 1, 0) {
  const auto outer_of = [&](std::uint32_t v) {
    return outer == nullptr ? mesh.outer_ring(v) : (*outer)[v];
  };
  std::size_t count = 0;
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    count += mesh.ring(v).size() + outer_of(v).size();
  }
  weights_.reserve(count);
  VertexWeights vertex(settings, rest);
  for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
    for (const std::int64_t w : vertex.find(v, mesh.ring(v), outer_of(v))) {
      weights_.push_back(static_cast<std::int32_t>(w));
    }
    first_[v + 1] = static_cast<std::uint32_t>(weights_.size());
  }
}

}  // namespace rlpc
