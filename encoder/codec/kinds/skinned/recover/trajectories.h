// Trajectories of the vertices of a span.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Positions in a sample of the frames, relative to the centre of all vertices in each frame, in
// extents: the RMS distance of a coordinate from that centre.
class Trajectories {
 public:
  // Keeps a reference to the frames: at least one, with at least one vertex. Takes max_frames
  // evenly spaced ones, or all if there are fewer; the first is one of them.
  Trajectories(const SpanFrames& frames, std::uint32_t max_frames);

  std::size_t num_frames() const { return chosen_.size(); }  // of the sample
  std::size_t num_vertices() const { return frames_.num_vertices; }
  double extent() const { return extent_; }  // grid units; 0: all vertices are in one place
  Vec3d position(std::size_t frame, std::size_t vertex) const;
  std::vector<Vec3d> of(std::size_t vertex) const;  // [frame]
  // Returns the mean position of some vertices: at least one.
  Vec3d mean(std::size_t frame, std::span<const std::uint32_t> vertices) const;

 private:
  Vec3d centred(std::size_t frame, std::size_t vertex) const;

  const SpanFrames& frames_;
  std::vector<std::uint32_t> chosen_;  // numbers of the frames
  std::vector<Vec3d> centre_;          // [frame], grid units
  double extent_ = 0.0;
};

}  // namespace rlpc
