// Animations and settings for the encoder, derived from arbitrary bytes: legal ones, illegal
// ones, and edge cases.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/c_api/rlpc_c_encoder.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

struct EncoderCase {
  std::uint32_t num_vertices = 0;
  std::vector<std::uint32_t> indices;      // three per triangle
  std::vector<std::vector<float>> frames;  // 3 * num_vertices values each
  std::uint32_t num_frames = 0;            // announced; 0: the stream is open-ended
  FrameRate frame_rate;
  std::array<float, 3> box_min{};
  std::array<float, 3> box_max{};

  // Options of the C interface, which takes frames one by one; `metadata` replaces the pointer.
  rlpc_encode_options options{};
  std::string metadata;
  bool placed = false;
  std::uint32_t failing_write = 0;  // the call that fails, from 1; 0: none
  // If present, these replace the options: rlpc_encoder.h encodes the sequence as a whole.
  std::optional<EncoderSettings> settings;
  bool twice = false;  // encode twice and compare the bytes

  // Return what the public headers say of the case.
  bool has_legal_target() const;
  std::uint32_t expected_frames() const {
    return num_frames > 0 ? num_frames : static_cast<std::uint32_t>(frames.size());
  }
  bool has_known_options() const;
  bool is_legal() const;  // frames are not considered
  bool is_legal_frame(std::size_t frame) const;
};

// Flags, then 26 bytes of settings, the mesh, the frames; missing bytes are 0.
EncoderCase make_encoder_case(std::span<const std::uint8_t> bytes);

}  // namespace rlpc
