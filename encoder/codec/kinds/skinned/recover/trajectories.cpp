#include "encoder/codec/kinds/skinned/recover/trajectories.h"

#include <algorithm>
#include <cmath>

namespace rlpc {

Trajectories::Trajectories(const SpanFrames& frames, std::uint32_t max_frames)
    : frames_(frames) {
  const std::uint32_t count = std::min(frames.num_frames, max_frames);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint64_t place =
        count == 1 ? 0 : std::uint64_t{i} * (frames.num_frames - 1) / (count - 1);
    chosen_.push_back(static_cast<std::uint32_t>(place));
  }
  for (const std::uint32_t f : chosen_) {
    Vec3d sum = Vec3d::Zero();
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      const double* p = frames.at(f, v);
      sum += Vec3d(p[0], p[1], p[2]);
    }
    centre_.push_back(sum / frames.num_vertices);
  }
  double square = 0.0;
  for (std::size_t f = 0; f < count; ++f) {
    for (std::size_t v = 0; v < num_vertices(); ++v) square += centred(f, v).squaredNorm();
  }
  extent_ = std::sqrt(square / (3.0 * static_cast<double>(count * num_vertices())));
}

Vec3d Trajectories::centred(std::size_t frame, std::size_t vertex) const {
  const double* p = frames_.at(chosen_[frame], static_cast<std::uint32_t>(vertex));
  return Vec3d(p[0], p[1], p[2]) - centre_[frame];
}

Vec3d Trajectories::position(std::size_t frame, std::size_t vertex) const {
  return extent_ > 0.0 ? Vec3d(centred(frame, vertex) / extent_) : Vec3d(Vec3d::Zero());
}

std::vector<Vec3d> Trajectories::of(std::size_t vertex) const {
  std::vector<Vec3d> result;
  for (std::size_t f = 0; f < chosen_.size(); ++f) result.push_back(position(f, vertex));
  return result;
}

Vec3d Trajectories::mean(std::size_t frame, std::span<const std::uint32_t> vertices) const {
  Vec3d sum = Vec3d::Zero();
  for (const std::uint32_t v : vertices) sum += position(frame, v);
  return sum / static_cast<double>(vertices.size());
}

}  // namespace rlpc
