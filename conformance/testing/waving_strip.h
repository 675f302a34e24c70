// A waving strip of triangles, encoded through the C interface. This code allocates nothing
// while it encodes, so that tests see what the library allocates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/c_api/rlpc_c_encoder.h"

namespace rlpc {

struct WavingStrip {
  std::uint32_t num_vertices;
  std::vector<std::uint32_t> indices;
  std::vector<std::vector<float>> frames;

  WavingStrip(std::uint32_t vertices, std::uint32_t num_frames) : num_vertices(vertices) {
    for (std::uint32_t v = 0; v + 2 < vertices; ++v) {
      for (const std::uint32_t i : {v, v + 1 + v % 2, v + 2 - v % 2}) indices.push_back(i);
    }
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      std::vector<float> xyz;
      for (std::uint32_t v = 0; v < vertices; ++v) {
        const std::uint32_t column = v / 2;
        const double x = column * 0.05;
        for (const double c : {x, v % 2 * 0.3, 0.2 * std::sin(0.2 * f + 4 * x)}) {
          xyz.push_back(static_cast<float>(c));
        }
      }
      frames.push_back(std::move(xyz));
    }
  }
  std::size_t num_values() const { return 3 * std::size_t{num_vertices}; }

  // Begins a stream that is written to `to`; writing fails beyond its capacity.
  rlpc_status create(const rlpc_encode_options& options, std::vector<std::uint8_t>& to,
                     rlpc_encoder** encoder) const {
    rlpc_frame_format format;
    rlpc_frame_format_init(&format, sizeof format);
    format.num_vertices = num_vertices;
    format.num_triangles = num_vertices - 2;
    format.indices = indices.data();
    format.num_frames = static_cast<std::uint32_t>(frames.size());
    format.box_max[0] = std::max(1.0F, 0.026F * static_cast<float>(num_vertices));
    format.box_max[1] = 1;
    format.box_min[2] = -0.2F;
    format.box_max[2] = 0.2F;
    return rlpc_encoder_create(&format, &options, append, &to, encoder);
  }
  // Adds the frames and finishes the stream.
  rlpc_status add_all(rlpc_encoder* encoder) const {
    rlpc_status status = RLPC_OK;
    for (std::size_t f = 0; status == RLPC_OK && f < frames.size(); ++f) {
      status = rlpc_encoder_add_frame(encoder, frames[f].data(), num_values());
    }
    return status == RLPC_OK ? rlpc_encoder_finish(encoder, nullptr, 0) : status;
  }

 private:
  static int append(void* user, const void* bytes, std::size_t num_bytes) {
    auto& stream = *static_cast<std::vector<std::uint8_t>*>(user);
    const auto* begin = static_cast<const std::uint8_t*>(bytes);
    if (num_bytes > stream.capacity() - stream.size()) return 1;
    stream.insert(stream.end(), begin, begin + num_bytes);
    return 0;
  }
};

}  // namespace rlpc
