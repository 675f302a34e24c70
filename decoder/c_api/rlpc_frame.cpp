// Frames in any order and form, GOFs, indices, bounds and memory
// (decoder/c_api/rlpc_c_decoder.h).
#include <algorithm>
#include <cstdint>
#include <span>

#include "common/files/float_position.h"
#include "common/memory/owned.h"
#include "decoder/c_api/convert_frame.h"
#include "decoder/c_api/decoder_handle.h"
#include "decoder/c_api/frame_output.h"

namespace rlpc {
namespace {

// Writes a frame. decode(positions) returns a Result<bool>, false after the last frame.
template <class Decode>
rlpc_status give_frame(rlpc_decoder& handle, const rlpc_frame_output* wanted,
                       const Decode& decode) {
  rlpc_frame_output output{};
  if (wanted == nullptr || !take_struct(wanted, output)) {
    return bad_output(handle, "output is not initialised (rlpc_frame_output_init)");
  }
  if (const auto status = check_output(handle, output); status != RLPC_OK) return status;
  const SequenceHeader& header = handle.decoder->header();
  handle.positions.resize(3 * std::size_t{handle.decoder->num_vertices()});
  handle.blend.is_shown = false;
  const Result<bool> more = decode(std::span(handle.positions));
  if (!more) {
    handle.has_frame = false;
    return fail(handle, more.error());
  }
  handle.error.clear();
  if (!*more) return RLPC_END;
  handle.has_frame = true;
  handle.next_of_frame = handle.decoder->position();
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
                output.normal_weight == RLPC_NORMAL_WEIGHT_ANGLE, handle.normal_sums);
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

rlpc_status rlpc_decoder_bounds(rlpc_decoder* decoder, float min[3], float max[3]) {
  return rlpc::guarded(decoder, [&] {
    if (min == nullptr || max == nullptr || !decoder->has_frame) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, decoder->has_frame
                                                       ? "min or max is null"
                                                       : "no frame has been decoded");
    }
    if (decoder->blend.is_shown) {
      rlpc::give_bounds(*decoder, min, max);
      return RLPC_OK;
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
      min[c] = rlpc::float_position(grid, c, low);
      max[c] = rlpc::float_position(grid, c, high);
    }
    return RLPC_OK;
  });
}

rlpc_status rlpc_decoder_memory(rlpc_decoder* decoder, rlpc_memory* memory,
                                size_t struct_size) {
  return rlpc::guarded(decoder, [&] {
    if (memory == nullptr || struct_size < sizeof(std::size_t)) {
      return decoder->error.set(RLPC_BAD_ARGUMENT, "memory is null, or struct_size too small");
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
