#include "encoder/write/write_stream.h"

#include <zlib.h>

#include <cassert>

#include "common/bitstream/bit_writer.h"
#include "common/bitstream/range_encoder.h"
#include "encoder/write/write_residual.h"

namespace rlpc {
namespace {

void append_deflated(std::string_view bytes, Bytes& payload) {
  uLongf length = compressBound(static_cast<uLong>(bytes.size()));
  Bytes deflated(length);
  [[maybe_unused]] const int status =
      compress2(deflated.data(), &length, reinterpret_cast<const Bytef*>(bytes.data()),
                static_cast<uLong>(bytes.size()), Z_BEST_COMPRESSION);
  assert(status == Z_OK);
  payload.insert(payload.end(), deflated.begin(),
                 deflated.begin() + static_cast<std::ptrdiff_t>(length));
}

}  // namespace

// 6.3 sequence_header( )
Bytes write_sequence_header(const SequenceHeader& h) {
  BitWriter w;
  w.u(8, h.profile_idc);
  w.u(8, h.level_idc);
  w.ue(h.num_vertices - 1);
  w.ue(h.num_triangles);
  if (h.profile_idc >= kProfileHigh) w.flag(h.open_end_flag);
  if (!h.open_end_flag) w.ue(h.num_frames - 1);
  w.ue(h.frame_rate.numerator - 1);
  w.ue(h.frame_rate.denominator - 1);
  w.se(h.grid.log2_step);
  for (const std::int32_t origin : h.grid.origin) w.se(origin);
  w.u(5, static_cast<std::uint32_t>(h.position_bits));
  w.byte_alignment();
  return w.take();
}

// 6.6 vertex_order( )
Bytes write_vertex_order(std::span<const std::uint32_t> output_vertex) {
  RangeEncoder re;
  ResidualModels models;
  std::uint32_t mean = 0;
  std::int64_t before = 0;
  for (const std::uint32_t index : output_vertex) {
    const auto delta = static_cast<std::int32_t>(index - before);
    write_residual(re, models, mean >> 4, delta);
    mean = update_mean(mean, magnitude_of(delta), 3);
    before = index;
  }
  return re.finish();
}

// 6.10 metadata( )
Bytes write_metadata(std::string_view json) {
  BitWriter size;
  size.u(32, static_cast<std::uint32_t>(json.size()));
  Bytes payload = size.take();
  append_deflated(json, payload);
  return payload;
}

// 6.16 asset( )
Bytes write_asset(std::string_view glb) {
  BitWriter w;
  w.u(8, 0);  // asset_format
  w.u(32, static_cast<std::uint32_t>(glb.size()));
  Bytes payload = w.take();
  append_deflated(glb, payload);
  return payload;
}

// 6.15 clip_table( )
Bytes write_clip_table(std::span<const Clip> clips) {
  BitWriter w;
  w.ue(static_cast<std::uint32_t>(clips.size()) - 1);
  std::uint32_t end = 0;
  for (const Clip& clip : clips) {
    w.se(static_cast<std::int32_t>(clip.first_frame) - static_cast<std::int32_t>(end));
    w.ue(clip.num_frames - 1);
    w.u(8, static_cast<std::uint32_t>(clip.name.size()) - 1);
    for (const char c : clip.name) w.u(8, static_cast<unsigned char>(c));
    end = clip.first_frame + clip.num_frames;
  }
  w.byte_alignment();
  return w.take();
}

}  // namespace rlpc
