// Frames in any order and form, and what concerns them (decoder/c_api/rlpc_decode.h).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <string>

#include "common/io/float_position.h"
#include "common/owned.h"
#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"

namespace rlpc {
namespace {

rlpc_status bad_output(rlpc_decoder& handle, const std::string& what) {
  return handle.error.set(RLPC_BAD_ARGUMENT, what);
}

// name: of the channel; formats: a list of those it has.
rlpc_status check_channel(rlpc_decoder& handle, const char* name, const rlpc_channel& channel,
                          std::span<const std::uint32_t> formats, std::size_t num_vertices) {
  if (channel.data == nullptr) return RLPC_OK;
  if (std::find(formats.begin(), formats.end(), channel.format) == formats.end()) {
    return bad_output(
        handle, std::string(name) + ": they have no format " + std::to_string(channel.format));
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

rlpc_status check_output(rlpc_decoder& handle, const rlpc_frame_output& output) {
  constexpr std::array<std::uint32_t, 4> kOfPositions{RLPC_INT32, RLPC_FLOAT, RLPC_HALF,
                                                      RLPC_INT16};
  constexpr std::array<std::uint32_t, 4> kOfNormals{RLPC_FLOAT, RLPC_HALF, RLPC_INT16,
                                                    RLPC_INT8};
  if (output.normal_weight > RLPC_BY_ANGLE) {
    return bad_output(handle,
                      "normal_weight: there is no " + std::to_string(output.normal_weight));
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
          check_channel(handle, "positions", output.positions, kOfPositions, num_vertices);
      status != RLPC_OK) {
    return status;
  }
  return check_channel(handle, "normals", output.normals, kOfNormals, num_vertices);
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

// decode(positions): a Result<bool>, false after the last frame.
template <class Decode>
rlpc_status give_frame(rlpc_decoder& handle, const rlpc_frame_output* wanted,
                       const Decode& decode) {
  rlpc_frame_output output{};
  if (wanted == nullptr || !take_struct(wanted, output)) {
    return bad_output(handle, "output: rlpc_frame_output_init has not set it");
  }
  if (const auto status = check_output(handle, output); status != RLPC_OK) return status;
  const SequenceHeader& header = handle.decoder->header();
  handle.positions.resize(3 * std::size_t{handle.decoder->num_vertices()});
  const Result<bool> more = decode(std::span(handle.positions));
  if (!more) {
    handle.has_frame = false;
    return fail(handle, more.error());
  }
  handle.error.clear();
  if (!*more) return RLPC_END;
  handle.has_frame = true;
  std::span<const std::uint32_t> vertices;
  if (output.split != 0) vertices = handle.drawn->vertices().stream_vertex;
  if (output.positions.data != nullptr) {
    write_positions({handle.positions, vertices}, header.grid, scale_of(output, header),
                    output.positions);
  }
  if (output.normals.data == nullptr) return RLPC_OK;
  if (output.split != 0 && handle.drawn->has_normals()) {
    write_normals(
        {handle.drawn->normals().sums(std::span<const std::int32_t>(handle.positions)),
         handle.drawn->normal_of_vertex()},
        output.normals);
  } else {
    sum_normals(handle.positions, handle.decoder->triangles(),
                output.normal_weight == RLPC_BY_ANGLE, handle.normal_sums);
    write_normals({handle.normal_sums, vertices}, output.normals);
  }
  return RLPC_OK;
}

}  // namespace
}  // namespace rlpc

void rlpc_frame_output_init(rlpc_frame_output* output, size_t struct_size) {
  rlpc::give_struct(rlpc_frame_output{}, output, struct_size);
}

rlpc_status rlpc_decoder_frame(rlpc_decoder* decoder, uint32_t frame,
                               const rlpc_frame_output* output) {
  return rlpc::guarded(decoder, [&] {
    if (rlpc::check_frame(*decoder, frame) != RLPC_OK) return RLPC_BAD_ARGUMENT;
    return rlpc::give_frame(*decoder, output, [&](std::span<std::int32_t> positions) {
      return decoder->decoder->frame(frame, positions);
    });
  });
}

rlpc_status rlpc_decoder_next(rlpc_decoder* decoder, const rlpc_frame_output* output) {
  return rlpc::guarded(decoder, [&] {
    return rlpc::give_frame(*decoder, output, [&](std::span<std::int32_t> positions) {
      return decoder->decoder->next_frame(positions);
    });
  });
}

rlpc_status rlpc_decoder_prefetch(rlpc_decoder* decoder, uint32_t frame) {
  return rlpc::guarded(decoder, [&] {
    if (rlpc::check_frame(*decoder, frame) != RLPC_OK) return RLPC_BAD_ARGUMENT;
    if (const auto ok = decoder->decoder->prefetch(frame); !ok) {
      return rlpc::fail(*decoder, ok.error());
    }
    decoder->error.clear();
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_gof_of(rlpc_decoder* decoder, uint32_t frame, rlpc_gof* gof) {
  return rlpc::guarded(decoder, [&] {
    if (rlpc::check_frame(*decoder, frame) != RLPC_OK) return RLPC_BAD_ARGUMENT;
    if (gof == nullptr) return decoder->error.set(RLPC_BAD_ARGUMENT, "gof is null");
    const auto found = decoder->decoder->gof_of(frame);
    if (!found) return rlpc::fail(*decoder, found.error());
    *gof = {found->first_frame, found->num_frames};
    decoder->error.clear();
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_gofs(rlpc_decoder* decoder, rlpc_gof* gofs, size_t max_gofs,
                              uint32_t* num_gofs) {
  return rlpc::guarded(decoder, [&] {
    if (num_gofs == nullptr || (gofs == nullptr && max_gofs > 0)) {
      return decoder->error.set(RLPC_BAD_ARGUMENT,
                                num_gofs == nullptr ? "num_gofs is null" : "gofs is null");
    }
    const auto found = decoder->decoder->gofs();
    if (!found) return rlpc::fail(*decoder, found.error());
    *num_gofs = static_cast<std::uint32_t>(found->size());
    for (std::size_t i = 0; i < std::min(max_gofs, found->size()); ++i) {
      gofs[i] = {(*found)[i].first_frame, (*found)[i].num_frames};
    }
    decoder->error.clear();
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_indices(rlpc_decoder* decoder, void* indices, size_t num_bytes,
                                 uint32_t index_bytes) {
  return rlpc::guarded(decoder, [&] {
    return rlpc::give_indices(*decoder, decoder->decoder->triangles(),
                              decoder->decoder->num_vertices(),
                              {indices, num_bytes, index_bytes});
  });
}

rlpc_status rlpc_decoder_int16_scale(rlpc_decoder* decoder, double scale[3], double offset[3]) {
  return rlpc::guarded(decoder, [&] {
    if (scale == nullptr || offset == nullptr) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, "scale or offset is null");
    }
    const rlpc::SequenceHeader& header = decoder->decoder->header();
    const rlpc::Int16Scale ours = rlpc::int16_scale(header.grid, header.position_bits);
    std::copy(ours.scale.begin(), ours.scale.end(), scale);
    std::copy(ours.offset.begin(), ours.offset.end(), offset);
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_bounds(rlpc_decoder* decoder, float least[3], float most[3]) {
  return rlpc::guarded(decoder, [&] {
    if (least == nullptr || most == nullptr || !decoder->has_frame) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, decoder->has_frame
                                                       ? "least or most is null"
                                                       : "no frame has been decoded");
    }
    const rlpc::Vector<std::int32_t>& positions = decoder->positions;
    for (std::size_t c = 0; c < 3; ++c) {
      std::int32_t low = positions[c];
      std::int32_t high = positions[c];
      for (std::size_t i = c; i < positions.size(); i += 3) {
        low = std::min(low, positions[i]);
        high = std::max(high, positions[i]);
      }
      const rlpc::Grid& grid = decoder->decoder->header().grid;
      least[c] = rlpc::float_position(grid, c, low);
      most[c] = rlpc::float_position(grid, c, high);
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_memory(rlpc_decoder* decoder, rlpc_memory* memory,
                                size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (memory == nullptr || struct_size < sizeof(std::size_t)) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, "there is no room for the description");
    }
    const rlpc::DecoderMemory now = decoder->decoder->memory();
    rlpc_memory ours{};
    ours.stream_bytes = now.stream_bytes;
    ours.gof_bytes = now.gof_bytes;
    ours.cached_bytes = now.cached_bytes;
    rlpc::give_struct(ours, memory, struct_size);
    return RLPC_OK;
  });
}
