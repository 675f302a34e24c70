// Stream whose bytes JavaScript holds or fetches: read() fails where bytes are missing, and
// JavaScript, which records the request, calls again once it has them.
#pragma once

#include <cstdint>
#include <span>

#include "decoder/codec/units/byte_source.h"

// Copies bytes of a stream into memory; returns false if they are missing. Implemented in
// decoder/web/package/src/wasm_decoder.js.
extern "C" [[clang::import_module("rlpc"), clang::import_name("read_stream")]] bool read_stream(
    double offset, std::uint8_t* out, std::uint32_t num_bytes);

namespace rlpc {

class ScriptSource final : public ByteSource {
 public:
  explicit ScriptSource(std::uint64_t num_bytes) : num_bytes_(num_bytes) {}
  std::uint64_t size() const override { return num_bytes_; }
  bool read(std::uint64_t offset, std::span<std::uint8_t> out) override {
    if (offset > num_bytes_ || out.size() > num_bytes_ - offset) return false;
    return read_stream(static_cast<double>(offset), out.data(),
                       static_cast<std::uint32_t>(out.size()));
  }

 private:
  std::uint64_t num_bytes_;
};

}  // namespace rlpc
