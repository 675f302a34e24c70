// Source that reads a stream from its buffer while it is being written.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>

#include "common/verify/stream_buffer.h"
#include "decoder/codec/units/byte_source.h"

namespace rlpc {

class BufferSource final : public ByteSource {
 public:
  // max: number of bytes that are visible.
  explicit BufferSource(std::shared_ptr<StreamBuffer> stream,
                        std::uint64_t max = std::numeric_limits<std::uint64_t>::max())
      : stream_(std::move(stream)), max_(max) {}

  std::uint64_t size() const override { return std::min(stream_->size(), max_); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    return offset <= size() && out.size() <= size() - offset && stream_->read(offset, out);
  }
  // Releases bytes that a decoder forgets, from now on.
  void release_forgotten() { releases_ = true; }
  void forget(std::uint64_t before) override {
    if (releases_) stream_->forget(before);
  }

 private:
  std::shared_ptr<StreamBuffer> stream_;
  std::uint64_t max_;
  bool releases_ = false;
};

}  // namespace rlpc
