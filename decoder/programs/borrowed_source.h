// Reference to a source, for a decoder, which would otherwise own the source.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/codec/units/byte_source.h"

namespace rlpc {

class BorrowedSource final : public ByteSource {
 public:
  // source: must outlive it.
  explicit BorrowedSource(ByteSource& source) : source_(source) {}
  std::uint64_t size() const override { return source_.size(); }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    return source_.read(offset, out);
  }
  std::uint64_t memory_bytes() const override { return source_.memory_bytes(); }

 private:
  ByteSource& source_;
};

}  // namespace rlpc
