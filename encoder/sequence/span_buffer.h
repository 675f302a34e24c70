// Buffers the frames of one span as they are added.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "encoder/input/frame_source.h"

namespace rlpc {

class SpanBuffer final : public FrameSource {
 public:
  SpanBuffer(std::uint32_t num_vertices, std::uint32_t num_frames)
      : FrameSource({num_vertices, num_frames, {}, {}}) {
    xyz_.reserve(3 * std::size_t{num_vertices} * num_frames);
  }

  // A span that ends with the frames of another buffer.
  SpanBuffer(std::uint32_t num_vertices, std::vector<float> xyz)
      : FrameSource({num_vertices,
                     static_cast<std::uint32_t>(xyz.size() / (3 * std::size_t{num_vertices})),
                     {},
                     {}}),
        xyz_(std::move(xyz)) {}

  void add(std::span<const float> xyz) { xyz_.insert(xyz_.end(), xyz.begin(), xyz.end()); }
  std::vector<float> take() { return std::move(xyz_); }
  bool is_full() const { return xyz_.size() == 3 * std::size_t{num_vertices()} * num_frames(); }
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::copy_n(&xyz_[frame * xyz.size()], xyz.size(), xyz.begin());
    return std::nullopt;
  }

 private:
  std::vector<float> xyz_;
};

}  // namespace rlpc
