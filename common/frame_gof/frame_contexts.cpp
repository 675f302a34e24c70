#include "common/frame_gof/frame_contexts.h"

namespace rlpc {

FrameContexts::FrameContexts(const CodedMesh& mesh, std::size_t num_layer_groups)
    : mesh_(mesh), models_(num_layer_groups), mean_(mesh.num_layers()) {
  magnitude_.assign(mesh.num_vertices(), 0);
  before_.assign(mesh.num_vertices(), 0);
}

// 9.8.6 StartFrameContexts( f )
void FrameContexts::start_frame(std::uint32_t frame) {
  is_first_ = frame == 0;
  if (frame < 2) {
    for (auto& models : models_) models = {};
    std::fill(mean_.begin(), mean_.end(), 256);
  }
  before_.swap(magnitude_);
  std::fill(magnitude_.begin(), magnitude_.end(), std::uint16_t{0});
  if (frame == 1) std::fill(before_.begin(), before_.end(), std::uint16_t{0});
}

// 9.8.6 StartFrameVertex( v )
void FrameContexts::start(std::uint32_t v) {
  vertex_ = v;
  axis_ = 0;
  latest_mean_ = 0;
  const std::uint32_t layer = mesh_.layer_of(v);
  class_ = layer == 0 ? 0 : layer + 2 < mesh_.num_layers() ? 1 : 2;
  layer_mean_ = &mean_[layer];
  ring_mean_ = mean_magnitude(mesh_.ring(v), *layer_mean_);
  outer_mean_ = mean_magnitude(mesh_.outer_ring(v), ring_mean_);
  before_mean_ = is_first_ ? *layer_mean_ : (std::uint32_t{before_[v]} << 8) / 3;
}

std::uint32_t FrameContexts::mean_magnitude(std::span<const std::uint32_t> ring,
                                            std::uint32_t otherwise) const {
  if (ring.empty()) return otherwise;
  std::uint32_t sum = 0;
  for (const std::uint32_t u : ring) sum += magnitude_[u];
  return static_cast<std::uint32_t>((std::uint64_t{sum} << 8) / (3 * ring.size()));
}

// 9.8.6 UpdateFrameVertex( v, c, residual )
void FrameContexts::update(std::int32_t residual) {
  const std::uint32_t magnitude = magnitude_of(residual);
  const std::uint32_t clipped = std::min(magnitude, kMaxMagnitude);
  latest_mean_ = axis_ == 0 ? clipped << 8 : (latest_mean_ + (clipped << 8)) >> 1;
  *layer_mean_ = update_mean(*layer_mean_, magnitude, 6);
  magnitude_[vertex_] = static_cast<std::uint16_t>(magnitude_[vertex_] + clipped);
  ++axis_;
}

}  // namespace rlpc
