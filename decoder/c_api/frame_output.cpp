#include "decoder/c_api/frame_output.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

namespace rlpc {
rlpc_status bad_output(rlpc_decoder& handle, const std::string& what) {
  return handle.error.set(RLPC_BAD_ARGUMENT, what);
}

namespace {

// Checks a channel. name: for messages; formats: the formats that it supports.
rlpc_status check_channel(rlpc_decoder& handle, const char* name, const rlpc_channel& channel,
                          std::span<const std::uint32_t> formats, std::size_t num_vertices) {
  if (channel.data == nullptr) return RLPC_OK;
  if (std::find(formats.begin(), formats.end(), channel.format) == formats.end()) {
    return bad_output(
        handle, std::string(name) + ": unsupported format " + std::to_string(channel.format));
  }
  rlpc_channel tight = channel;
  tight.stride = 0;
  const std::size_t bytes_of_vertex = bytes_needed(tight, 1);
  if (channel.stride != 0 && channel.stride < bytes_of_vertex) {
    return bad_output(handle, std::string(name) + ": a stride of " +
                                  std::to_string(channel.stride) + " bytes is less than the " +
                                  std::to_string(bytes_of_vertex) + " of a vertex");
  }
  const bool overflows =
      channel.stride > (SIZE_MAX - bytes_of_vertex) / std::max<std::size_t>(1, num_vertices);
  const std::size_t needed = overflows ? SIZE_MAX : bytes_needed(channel, num_vertices);
  if (channel.num_bytes >= needed) return RLPC_OK;
  return bad_output(handle, std::string(name) + ": the buffer has " +
                                std::to_string(channel.num_bytes) + " bytes, not " +
                                std::to_string(needed));
}

}  // namespace

rlpc_status check_output(rlpc_decoder& handle, const rlpc_frame_output& output) {
  constexpr std::array<std::uint32_t, 4> kPositionFormats{RLPC_FORMAT_INT32, RLPC_FORMAT_FLOAT,
                                                          RLPC_FORMAT_HALF, RLPC_FORMAT_INT16};
  constexpr std::array<std::uint32_t, 4> kNormalFormats{RLPC_FORMAT_FLOAT, RLPC_FORMAT_HALF,
                                                        RLPC_FORMAT_INT16, RLPC_FORMAT_INT8};
  if (output.normal_weight > RLPC_NORMAL_WEIGHT_ANGLE) {
    return bad_output(handle,
                      "normal_weight: unknown value " + std::to_string(output.normal_weight));
  }
  for (const double scale : output.int16_scale) {
    if (!(scale >= 0 && std::isfinite(scale)))
      return bad_output(handle, "int16_scale: expected a positive finite number, or 0");
  }
  for (const double offset : output.int16_offset) {
    if (!std::isfinite(offset))
      return bad_output(handle, "int16_offset: expected a finite number");
  }
  if (output.split != 0 && !handle.drawn) {
    return bad_output(handle, "split: call rlpc_decoder_split first");
  }
  const std::size_t num_vertices = output.split != 0 ? handle.drawn->vertices().num_vertices()
                                                     : handle.decoder->num_vertices();
  if (const auto status =
          check_channel(handle, "positions", output.positions, kPositionFormats, num_vertices);
      status != RLPC_OK) {
    return status;
  }
  return check_channel(handle, "normals", output.normals, kNormalFormats, num_vertices);
}

Int16Scale scale_of(const rlpc_frame_output& output, const SequenceHeader& header) {
  Int16Scale scale = int16_scale(header.grid, header.position_bits);
  for (std::size_t c = 0; c < 3; ++c) {
    if (output.int16_scale[c] == 0) continue;
    scale.scale[c] = output.int16_scale[c];
    scale.offset[c] = output.int16_offset[c];
  }
  return scale;
}

}  // namespace rlpc
