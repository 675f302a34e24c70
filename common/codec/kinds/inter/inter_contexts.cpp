#include "common/codec/kinds/inter/inter_contexts.h"

#include <type_traits>
#include <utility>

namespace rlpc {

static_assert(!std::is_copy_constructible_v<InterContexts> &&
              !std::is_copy_assignable_v<InterContexts>);

InterContexts::InterContexts(const OrderedMesh& mesh, std::size_t num_layer_groups,
                             std::uint32_t num_depths)
    : mesh_(mesh), num_layer_groups_(num_layer_groups), states_(num_depths + 1) {}

// 9.8.6 StartFrameContexts( )
void InterContexts::start_group(std::uint32_t place, std::uint32_t depth,
                                std::size_t layer_group) {
  if (last_use_) frames_.erase(*last_use_);
  last_use_.reset();
  group_ = layer_group;
  is_first_ = place == 0;
  state_ = &states_[is_first_ ? 0 : depth + 1];
  if (state_->models.empty()) {
    state_->models.assign(num_layer_groups_, {});
    state_->mean.assign(mesh_.num_layers(), 256);
  }
  Frame& frame = frames_[place];
  if (layer_group == 0) {
    frame.magnitude.assign(mesh_.num_vertices(), 0);
    frame.before = std::exchange(state_->latest, place);
  }
  magnitude_ = &frame.magnitude;
  before_ = frame.before ? &frames_.at(*frame.before).magnitude : nullptr;
  if (layer_group + 1 == num_layer_groups_) last_use_ = frame.before;
}

// 9.8.6 StartFrameVertex( v )
void InterContexts::start(std::uint32_t v) {
  vertex_ = v;
  axis_ = 0;
  latest_mean_ = 0;
  const std::uint32_t layer = mesh_.layer_of(v);
  class_ = layer == 0 ? 0 : layer + 2 < mesh_.num_layers() ? 1 : 2;
  layer_mean_ = &state_->mean[layer];
  ring_mean_ = mean_magnitude(mesh_.ring(v), *layer_mean_);
  outer_mean_ = mean_magnitude(mesh_.outer_ring(v), ring_mean_);
  before_mean_ = before_ == nullptr ? 0 : (std::uint32_t{(*before_)[v]} << 8) / 3;
  if (is_first_) before_mean_ = *layer_mean_;
}

std::uint32_t InterContexts::mean_magnitude(std::span<const std::uint32_t> ring,
                                            std::uint32_t otherwise) const {
  if (ring.empty()) return otherwise;
  std::uint32_t sum = 0;
  for (const std::uint32_t u : ring) sum += (*magnitude_)[u];
  return static_cast<std::uint32_t>((std::uint64_t{sum} << 8) / (3 * ring.size()));
}

// 9.8.6 UpdateFrameVertex( v, c, residual )
void InterContexts::update(std::int32_t residual) {
  const std::uint32_t magnitude = magnitude_of(residual);
  const std::uint32_t clipped = std::min(magnitude, kMaxMagnitude);
  latest_mean_ = axis_ == 0 ? clipped << 8 : (latest_mean_ + (clipped << 8)) >> 1;
  *layer_mean_ = update_mean(*layer_mean_, magnitude, 6);
  std::uint16_t& sum = (*magnitude_)[vertex_];
  sum = static_cast<std::uint16_t>(sum + clipped);
  ++axis_;
}

}  // namespace rlpc
