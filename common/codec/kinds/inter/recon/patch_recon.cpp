#include "common/codec/kinds/inter/recon/patch_recon.h"

#include <algorithm>
#include <cstdlib>

#include "common/codec/bits/fixed_point.h"
#include "common/memory/owned.h"

namespace rlpc {
namespace {

constexpr std::int64_t kMaxOffset = std::int64_t{1} << 29;
constexpr std::int64_t kMaxMatrix = std::int64_t{1} << 18;

}  // namespace

// 8.19.5 StartPatches( )
PatchRecon::PatchRecon(std::uint32_t num_patches, const PatchOfVertex& patch_of_vertex,
                       std::span<const std::uint32_t> vertices,
                       std::span<const std::int32_t> first, std::uint32_t num_depths,
                       int value_bits)
    : patch_of_vertex_(patch_of_vertex),
      vertices_(vertices),
      value_bits_(value_bits),
      size_(num_patches, 0),
      reach_(num_patches, 1),
      last_(num_depths, Vector<Motion>(num_patches, Motion{})),
      modes_(num_patches, PatchMode::kNeighbours),
      centres_(num_patches) {
  for (const std::uint32_t v : vertices) ++size_[patch_of_vertex[v]];
  const Vector<Vec3i> centre = centres(first);
  const auto distance = [&](std::uint32_t v, std::size_t patch) {
    std::int64_t largest = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int64_t own = first[3 * std::size_t{v} + c];
      largest = std::max(largest, std::abs(own - centre[patch][c]));
    }
    return largest;
  };
  Vector<std::int64_t> sum(num_patches, 0);
  for (const std::uint32_t v : vertices)
    sum[patch_of_vertex[v]] += distance(v, patch_of_vertex[v]);
  const auto empty = std::find(size_.begin(), size_.end(), std::size_t{0});
  std::int64_t overall_sum = 0;
  if (empty != size_.end()) {
    const auto patch = static_cast<std::size_t>(empty - size_.begin());
    for (const std::uint32_t v : vertices) overall_sum += distance(v, patch);
  }
  for (std::size_t p = 0; p < num_patches; ++p) {
    const std::size_t size = size_[p] > 0 ? size_[p] : vertices.size();
    const std::int64_t mean =
        div_round(size_[p] > 0 ? sum[p] : overall_sum, static_cast<std::int64_t>(size));
    reach_[p] = std::max<std::int64_t>(1, mean);
  }
}

Vector<Vec3i> PatchRecon::centres(std::span<const std::int32_t> frame) const {
  Vector<Vec3l> sum(size_.size());
  Vec3l overall_sum{};
  for (const std::uint32_t v : vertices_) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t value = frame[3 * std::size_t{v} + c];
      sum[patch_of_vertex_[v]][c] += value;
      overall_sum[c] += value;
    }
  }
  Vector<Vec3i> centres(size_.size());
  for (std::size_t p = 0; p < size_.size(); ++p) {
    const Vec3l& total = size_[p] > 0 ? sum[p] : overall_sum;
    const auto count = static_cast<std::int64_t>(size_[p] > 0 ? size_[p] : vertices_.size());
    for (std::size_t c = 0; c < 3; ++c) {
      centres[p][c] = static_cast<std::int32_t>(div_round(total[c], count));
    }
  }
  return centres;
}

PatchRecon::Motion PatchRecon::motion(
    std::size_t patch, std::uint32_t depth, std::uint32_t step,
    const std::array<std::int32_t, kMotionValues>& residual) const {
  Motion motion = last_[depth][patch];
  for (std::size_t i = 0; i < kMotionValues; ++i) {
    const std::int64_t difference = std::int64_t{residual[i]} * step;
    if (i < kOffsetValues) {
      motion[i] = static_cast<std::int32_t>(
          clip3(-kMaxOffset, kMaxOffset, motion[i] + round2(difference, kMotionStepLog2)));
    } else {
      const std::int64_t turn =
          div_round(difference * (1 << (kMatrixFractionBits - kMotionStepLog2)), reach_[patch]);
      motion[i] = static_cast<std::int32_t>(clip3(-kMaxMatrix, kMaxMatrix, motion[i] + turn));
    }
  }
  return motion;
}

// 8.19.5 MovePatches( f )
void PatchRecon::start_frame(std::span<const std::int32_t> reference, std::uint32_t depth,
                             std::uint32_t step, const FramePatches& patches) {
  reference_ = reference;
  depth_ = depth;
  std::fill(modes_.begin(), modes_.end(), PatchMode::kNeighbours);
  if (patches.empty()) return;
  centres_ = centres(reference);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    modes_[p] = patches[p].mode;
    if (modes_[p] == PatchMode::kNeighbours) continue;
    last_[depth][p] = motion(p, depth, step, patches[p].residual);
  }
}

// 8.19.5 MovedByPatch( v, c )
std::int32_t PatchRecon::moved(const Motion& motion, std::uint32_t v, std::size_t c) const {
  const std::uint16_t p = patch_of_vertex_[v];
  const std::int32_t* const own = &reference_[3 * std::size_t{v}];
  std::int64_t sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += std::int64_t{motion[kOffsetValues + 3 * c + k]} *
           (std::int64_t{own[k]} - centres_[p][k]);
  }
  return clip_signed(value_bits_, own[c] + motion[c] + round2(sum, kMatrixFractionBits));
}

}  // namespace rlpc
