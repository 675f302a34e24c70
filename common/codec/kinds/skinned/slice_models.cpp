#include "common/codec/kinds/skinned/slice_models.h"

#include <cassert>

#include "common/memory/owned.h"

namespace rlpc {
namespace {

// floor(x / n) = (x * reciprocal(n)) >> 32 while x * n < 2^32.
constexpr std::uint64_t reciprocal(std::size_t n) {
  return ((std::uint64_t{1} << 32) - 1) / n + 1;
}

// Largest n for which this holds for sums of n 8-bit magnitudes with 8 fractional bits. Rings
// are smaller.
constexpr std::size_t kMaxReciprocal = 255;
static_assert(kMaxReciprocal * (kMaxReciprocal * 255 * 256) < (std::uint64_t{1} << 32));

}  // namespace

VertexContexts::VertexContexts(const OrderedMesh& mesh, std::size_t num_factors)
    : mesh_(&mesh),
      mean_(num_factors, 256),
      magnitudes_(make_shared_owned<Vector<std::uint8_t>>(mesh.num_vertices() * num_factors)),
      sums_(num_factors),
      ring_mean_(num_factors),
      outer_mean_(num_factors) {}

void VertexContexts::start(std::uint32_t v) {
  vertex_ = v;
  next_ = 0;
  latest_mean_ = 0;
  activity_sum_ = 256;
  activity_mean_ = 256;
  mean_magnitudes(mesh_->ring(v), mean_, ring_mean_);
  mean_magnitudes(mesh_->outer_ring(v), ring_mean_, outer_mean_);
}

void VertexContexts::mean_magnitudes(std::span<const std::uint32_t> ring,
                                     std::span<const std::uint32_t> otherwise,
                                     std::span<std::uint32_t> means) {
  if (ring.empty()) {
    std::copy(otherwise.begin(), otherwise.end(), means.begin());
    return;
  }
  const std::size_t n = means.size();
  std::fill(sums_.begin(), sums_.end(), std::uint16_t{0});
  for (const std::uint32_t u : ring) {
    const std::uint8_t* const magnitudes = magnitudes_->data() + std::size_t{u} * n;
    for (std::size_t k = 0; k < n; ++k) {
      sums_[k] = static_cast<std::uint16_t>(sums_[k] + magnitudes[k]);
    }
  }
  assert(ring.size() <= kMaxReciprocal);
  const std::uint64_t scale = reciprocal(ring.size());
  for (std::size_t k = 0; k < n; ++k) {
    means[k] = static_cast<std::uint32_t>((std::uint64_t{sums_[k]} * 256 * scale) >> 32);
  }
}

}  // namespace rlpc
