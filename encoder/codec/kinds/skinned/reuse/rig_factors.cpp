#include "encoder/codec/kinds/skinned/reuse/rig_factors.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/codec/kernels/component_sum.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/math/matrix_products.h"

namespace rlpc {
namespace {

// Rows are visited in blocks of this size, a multiple of 4 (add_gram_matrix).
constexpr std::size_t kTogether = 4 * kTileValues;  // fixed: memory

// Calls use(first, count) for the vertices.
template <class Use>
void for_blocks(std::size_t num_vertices, const Use& use) {
  for (std::size_t first = 0; first < num_vertices; first += kTogether) {
    use(first, std::min(kTogether, num_vertices - first));
  }
}

// Returns normalised factors of 1, in the unit of the temporal values that the stream codes.
std::vector<double> units_of(const SharedRig& rig) {
  std::vector<double> units;
  for (const Trajectory& t : rig.trajectories) {
    const int shift = spatial_factor_bits(t.spatial_bits) - t.spatial_bits;
    units.push_back(exact_exp2(-shift) / kMaxLayerStep);
  }
  return units;
}

// Returns the upper triangle row by row, from the lower one.
std::vector<double> upper_triangle(std::vector<double> lower, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) lower[k * n + i] = lower[i * n + k];
  }
  return lower;
}

}  // namespace

RigFactors::RigFactors(const KeptRig& kept)
    : kept_(kept), unit_(units_of(*kept.rig)), system_({}, 0) {
  constexpr double kVanished = 1e-9;  // fixed: rounding
  const std::size_t n = count();
  std::vector<double> gram(n * n);
  for_blocks(kept.recon->num_vertices(), [&](std::size_t first, std::size_t size) {
    if (n > 0) add_gram_matrix(of(first, size), n, gram);
  });
  for (std::size_t l = 0; l < n; ++l) energy_.push_back(gram[l * n + l]);
  system_ = SymmetricSystem(upper_triangle(std::move(gram), n), n, kVanished);
}

std::vector<double> RigFactors::of(std::size_t first, std::size_t num_vertices) const {
  const std::size_t n = count();
  std::vector<double> factors(num_vertices * n);
  std::vector<std::int32_t> tile;
  for (std::size_t i = 0; i < num_vertices; ++i) {
    const std::size_t v = first + i;
    if (i == 0 || v % kTileValues == 0) tile = kept_.recon->factors()->tile(v / kTileValues);
    const std::size_t place = v % kTileValues * n;
    for (std::size_t l = 0; l < n; ++l) factors[i * n + l] = unit_[l] * tile[place + l];
  }
  return factors;
}

std::vector<double> RigFactors::fit(const TrajectoryRows& displacement) const {
  const std::size_t n = count();
  const std::size_t width = displacement.num_frames;
  std::vector<double> temporal(n * width);
  if (n == 0) return temporal;
  std::vector<double> rows;
  for_blocks(displacement.num_values, [&](std::size_t first, std::size_t size) {
    rows.resize(size * width);
    displacement.write(first, rows);
    const std::vector<double> factors = of(first, size);
    std::vector<double> transposed(factors.size());
    for (std::size_t i = 0; i < size; ++i) {
      for (std::size_t l = 0; l < n; ++l) transposed[l * size + i] = factors[i * n + l];
    }
    add_matrix_product(transposed, size, rows, width, temporal);
  });
  system_.solve(temporal, width);
  return temporal;
}

void RigRemainder::set_temporal(std::vector<double> temporal) {
  for (double& x : temporal) x = -x;
  negative_ = std::move(temporal);
}

TrajectoryRows RigRemainder::rows() const {
  return {frames_.num_vertices, width(),
          [this](std::size_t first, std::span<double> rows) { write(first, rows); }};
}

void RigRemainder::write(std::size_t first, std::span<double> rows) const {
  const std::size_t size = rows.size() / width();
  constexpr std::size_t kPassVertices = 32;  // fixed: vertices of a pass
  const SharedRig& rig = *kept_.rig;
  for_ranges(size, kPassVertices, [&](std::size_t i, std::size_t end) {
    MeanMotions motions(motions_);
    for (; i < end; ++i) {
      const auto v = static_cast<std::uint32_t>(first + i);
      Point rest;
      for (std::size_t c = 0; c < 3; ++c) rest[c] = kept_.rest[c][v] / kPointScale;
      write_displacement(frames_, chosen_, v, motions.of(rig.influences[v], rig.weight_bits),
                         rest, &rows[i * width()]);
    }
  });
  if (negative_.empty()) return;
  add_matrix_product(factors_.of(first, size), factors_.count(), negative_, width(), rows);
}

}  // namespace rlpc
