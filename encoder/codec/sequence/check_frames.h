// What FrameEncoder refuses.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "encoder/codec/frame_format.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

std::optional<InputError> check_format(const FrameFormat& format);
// The frame that follows num_added others; xyz and exact: as of FrameEncoder::add_frame().
std::optional<InputError> check_frame(const FrameFormat& format, std::uint32_t num_added,
                                      std::span<const float> xyz,
                                      std::span<const double> exact);
// When the stream is to end.
std::optional<InputError> check_count(const FrameFormat& format, std::uint32_t num_added);

}  // namespace rlpc
