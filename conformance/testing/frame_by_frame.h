// Streams of a FrameEncoder, for tests.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <utility>
#include <vector>

#include "conformance/testing/small_animation.h"
#include "encoder/codec/sequence/choices/grid_choice.h"
#include "encoder/frame_encoder.h"

namespace rlpc {

inline FrameFormat format_of(FrameSource& source) {
  FrameFormat format;
  format.num_vertices = source.num_vertices();
  format.num_frames = source.num_frames();
  format.frame_rate = source.frame_rate();
  format.triangles = source.triangles();
  const auto extent = measure_extent(source);
  for (std::size_t c = 0; c < 3; ++c) {
    format.box_min[c] = static_cast<float>(extent->min[c]);
    format.box_max[c] = static_cast<float>(extent->max[c]);
  }
  return format;
}

inline std::vector<float> frame_of(FrameSource& source, std::uint32_t f) {
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  if (auto error = source.read_frame(f, xyz)) throw std::logic_error(error->message);
  return xyz;
}

// Encodes frame by frame. held: max_held_frames; one GOF by default.
inline Encoded encode_frames(FrameSource& source, const EncoderSettings& settings,
                             std::uint32_t held = 1) {
  Encoded out;
  FrameFormat format = format_of(source);
  format.max_held_frames = held;
  auto encoder = FrameEncoder::create(format, settings, [&](auto more) {
    out.bytes.insert(out.bytes.end(), more.begin(), more.end());
    return true;
  });
  if (!encoder) throw std::logic_error(encoder.error().message);
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (const auto error = encoder->add_frame(frame_of(source, f))) {
      throw std::logic_error(error->message);
    }
  }
  auto report = encoder->finish();
  if (!report) throw std::logic_error(report.error().message);
  out.report = std::move(*report);
  require_conforming(out.bytes);
  return out;
}

}  // namespace rlpc
