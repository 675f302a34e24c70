// Checks the input of FrameEncoder.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "encoder/codec/frame_format.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

std::optional<InputError> check_format(const FrameFormat& format);
// Checks the frame that follows num_added others; xyz, exact: as in FrameEncoder::add_frame().
std::optional<InputError> check_frame(const FrameFormat& format, std::uint32_t num_added,
                                      std::span<const float> xyz,
                                      std::span<const double> exact);
// Checks whether the stream may end.
std::optional<InputError> check_count(const FrameFormat& format, std::uint32_t num_added);

}  // namespace rlpc
