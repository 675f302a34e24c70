#include "encoder/codec/write/write_stream.h"

#include <zlib.h>

#include <cassert>
#include <memory>
#include <new>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/range_encoder.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {
namespace {

// Blocks of twice the default length take 0.1 % fewer bytes of PNG and JPEG images.
void append_deflated(std::string_view bytes, Bytes& payload) {
  constexpr int kLargestWindow = 15;
  constexpr int kLongestBlocks = MAX_MEM_LEVEL;
  z_stream deflate_state{};
  if (deflateInit2(&deflate_state, Z_BEST_COMPRESSION, Z_DEFLATED, kLargestWindow,
                   kLongestBlocks, Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  const std::unique_ptr<z_stream, int (*)(z_stream*)> owner(&deflate_state, deflateEnd);
  constexpr std::size_t kPiece = std::size_t{1} << 20;  // zlib counts bytes in 32 bits
  int status = Z_OK;
  for (std::size_t read = 0; status != Z_STREAM_END;) {
    if (deflate_state.avail_in == 0) {
      const std::string_view piece = bytes.substr(read, kPiece);
      read += piece.size();
      // zlib does not write to its input, but its member is not const.
      deflate_state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(piece.data()));
      deflate_state.avail_in = static_cast<uInt>(piece.size());
    }
    const std::size_t start = payload.size();
    payload.resize(start + kPiece);
    deflate_state.next_out = payload.data() + start;
    deflate_state.avail_out = static_cast<uInt>(kPiece);
    status = deflate(&deflate_state, read < bytes.size() ? Z_NO_FLUSH : Z_FINISH);
    payload.resize(payload.size() - deflate_state.avail_out);
  }
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
  ResidualModels rigs;
  std::uint32_t mean = 0;
  std::int64_t before = 0;
  for (const std::uint32_t index : output_vertex) {
    const auto delta = static_cast<std::int32_t>(index - before);
    write_residual(re, rigs, mean >> 4, delta);
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
