// Buffers the frames of one span as they are added.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

class SpanBuffer final : public FrameSource {
 public:
  SpanBuffer(std::uint32_t num_vertices, std::uint32_t num_frames)
      : FrameSource({num_vertices, num_frames, {}, {}}) {
    xyz_.reserve(3 * std::size_t{num_vertices} * num_frames);
  }

  // All frames added to a span that ends before its buffer is full.
  struct Frames {
    std::uint32_t count = 0;
    std::vector<float> xyz;
    std::vector<double> exact;
  };
  SpanBuffer(std::uint32_t num_vertices, Frames frames)
      : FrameSource({num_vertices, frames.count, {}, {}}),
        xyz_(std::move(frames.xyz)),
        exact_(std::move(frames.exact)) {}
  Frames take() { return {frames_added(), std::move(xyz_), std::move(exact_)}; }

  // xyz, exact: as in FrameEncoder::add_frame().
  void add(std::span<const float> xyz, std::span<const double> exact) {
    const bool has_exact = !exact.empty() || !exact_.empty();
    if (has_exact && exact_.empty()) exact_.assign(xyz_.begin(), xyz_.end());
    xyz_.insert(xyz_.end(), xyz.begin(), xyz.end());
    if (!exact.empty()) {
      exact_.insert(exact_.end(), exact.begin(), exact.end());
    } else if (has_exact) {
      exact_.insert(exact_.end(), xyz.begin(), xyz.end());
    }
  }
  bool is_full() const { return frames_added() == num_frames(); }
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::copy_n(&xyz_[frame * xyz.size()], xyz.size(), xyz.begin());
    return std::nullopt;
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    if (exact_.empty()) return FrameSource::read_exact(frame, xyz);
    std::copy_n(&exact_[frame * xyz.size()], xyz.size(), xyz.begin());
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return !exact_.empty(); }

 private:
  std::uint32_t frames_added() const {
    return static_cast<std::uint32_t>(xyz_.size() / (3 * std::size_t{num_vertices()}));
  }

  std::vector<float> xyz_;
  std::vector<double> exact_;
};

}  // namespace rlpc
