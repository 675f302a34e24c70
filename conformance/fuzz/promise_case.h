// Random animations and settings for the promises of the encoder: lossless coordinates, largest
// errors, KG errors and rates that are never broken without a word.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/frame_encoder.h"
#include "encoder/meshes/frame_source.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// Frames with the numbers of an input, which floats may not represent.
class ExactFrames final : public FrameSource {
 public:
  ExactFrames(Shape shape, std::vector<std::vector<double>> frames);

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override;
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override;
  bool is_finer_than_floats() const override { return is_finer_; }

  const std::vector<double>& exact(std::uint32_t frame) const { return frames_[frame]; }

 private:
  std::vector<std::vector<double>> frames_;
  bool is_finer_ = false;
};

struct PromiseCase {
  // Function that encodes: encode(), or a FrameEncoder that holds spans or has low delay.
  enum Way : std::uint8_t { kWhole, kSpans, kLowDelay };

  Way way = kWhole;
  bool open_ended = false;            // for a FrameEncoder
  std::uint32_t max_held_frames = 0;  // for a FrameEncoder
  EncoderSettings settings;
  FrameSource::Shape shape;
  std::vector<std::vector<double>> frames;  // [frame][3 * num_vertices]
  std::string kind;                         // kind of animation
};

// The same seed makes the same case on every machine.
PromiseCase make_promise_case(std::uint64_t seed);

}  // namespace rlpc
