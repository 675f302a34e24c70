// Files of the codecs: little-endian numbers and strings of bytes.
#pragma once

#include <bit>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "conformance/studies/peers/peer_codecs.h"

namespace rlpc::peers {

class ByteWriter {
 public:
  void u32(std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes_ += static_cast<char>(value >> shift);
  }
  void f32(float value) { u32(std::bit_cast<std::uint32_t>(value)); }
  void piece(std::string_view bytes) {
    u32(static_cast<std::uint32_t>(bytes.size()));
    bytes_ += bytes;
  }
  void raw(std::string_view bytes) { bytes_ += bytes; }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}
  std::uint32_t u32() {
    const std::string_view four = raw(4);
    std::uint32_t value = 0;
    for (int i = 3; i >= 0; --i) {
      value = value << 8 | static_cast<unsigned char>(four[static_cast<std::size_t>(i)]);
    }
    return value;
  }
  float f32() { return std::bit_cast<float>(u32()); }
  std::string_view piece() { return raw(u32()); }
  std::string_view raw(std::size_t size) {
    if (size > bytes_.size()) throw std::runtime_error("the file ends too early");
    const std::string_view front = bytes_.substr(0, size);
    bytes_.remove_prefix(size);
    return front;
  }

 private:
  std::string_view bytes_;
};

// The header of the files of most codecs.
struct Sizes {
  std::size_t num_vertices;
  std::size_t num_triangles;
  std::size_t num_frames;
};
inline void write_sizes(ByteWriter& out, const Sizes& sizes) {
  for (const std::size_t size : {sizes.num_vertices, sizes.num_triangles, sizes.num_frames}) {
    out.u32(static_cast<std::uint32_t>(size));
  }
}
inline Sizes read_sizes(ByteReader& in) {
  Sizes sizes{};
  sizes.num_vertices = in.u32();
  sizes.num_triangles = in.u32();
  sizes.num_frames = in.u32();
  return sizes;
}

// Triangles for a general-purpose compressor: differences of successive indices.
inline void write_triangles(ByteWriter& out, const std::vector<Triangle>& triangles) {
  std::uint32_t last = 0;
  for (const Triangle& t : triangles) {
    for (const std::uint32_t v : t) {
      out.u32(v - last);
      last = v;
    }
  }
}
inline std::vector<Triangle> read_triangles(ByteReader& in, std::size_t num_triangles) {
  std::vector<Triangle> triangles(num_triangles);
  std::uint32_t last = 0;
  for (Triangle& t : triangles) {
    for (std::uint32_t& v : t) v = last += in.u32();
  }
  return triangles;
}

// Sizes and grid of a quantised animation; read_head() leaves the frames zero.
inline void write_head(ByteWriter& out, const QuantisedAnimation& a) {
  write_sizes(out, {a.num_vertices, a.triangles.size(), a.frames.size()});
  for (const float value : a.origin) out.f32(value);
  out.f32(a.step);
}
inline QuantisedAnimation read_head(ByteReader& in) {
  const Sizes sizes = read_sizes(in);
  QuantisedAnimation a;
  a.num_vertices = static_cast<std::uint32_t>(sizes.num_vertices);
  a.triangles.resize(sizes.num_triangles);
  a.frames.assign(sizes.num_frames, std::vector<std::uint16_t>(3 * sizes.num_vertices));
  for (float& value : a.origin) value = in.f32();
  a.step = in.f32();
  return a;
}

}  // namespace rlpc::peers
