// C++ functions exported to JavaScript (src/wasm_decoder.js), except those for attributes.
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "common/codec/bits/crc32.h"
#include "common/files/float_position.h"
#include "decoder/describe_error.h"
#include "decoder/web/wasm/frame_surface.h"
#include "decoder/web/wasm/script_source.h"
#include "decoder/web/wasm/stream.h"

namespace rlpc {
namespace {

std::string member(const char* name, std::int64_t value) {
  return "\"" + std::string(name) + "\":" + std::to_string(value);
}

// Returns the header as JSON, with the names of the syntax elements.
std::string describe(SeekingDecoder& seeking) {
  const Decoder& decoder = seeking.decoder();
  const SequenceHeader& h = decoder.header();
  const auto& origin = h.grid.origin;
  std::string text = "{";
  for (const auto& [name, value] : std::initializer_list<std::pair<const char*, std::int64_t>>{
           {"profile_idc", h.profile_idc},
           {"level_idc", h.level_idc},
           {"num_vertices", decoder.num_vertices()},
           {"num_triangles", static_cast<std::int64_t>(decoder.triangles().size())},
           {"num_frames", seeking.num_frames()},
           {"position_bits", h.position_bits},
           {"frame_rate_numerator", h.frame_rate.numerator},
           {"frame_rate_denominator", h.frame_rate.denominator},
           {"grid_log2_step", h.grid.log2_step},
           {"num_layers", decoder.num_layers()},
           {"num_clips", static_cast<std::int64_t>(decoder.clips().size())},
           {"has_attributes", decoder.has_attributes() ? 1 : 0},
           {"has_asset", decoder.has_asset() ? 1 : 0},
           {"num_damaged_units", static_cast<std::int64_t>(decoder.damaged_units().size())}}) {
    text += member(name, value) + ",";
  }
  return text + "\"grid_origin\":[" + std::to_string(origin[0]) + "," +
         std::to_string(origin[1]) + "," + std::to_string(origin[2]) + "]}";
}

// Returns null for an empty list, as of the whole mesh.
const std::uint32_t* address_of(std::span<const std::uint32_t> list) {
  return list.empty() ? nullptr : list.data();
}

void compute_coordinates(Stream& stream) {
  const auto positions = stream.decoder.positions();
  stream.coordinates.resize(positions.size());
  centred_coordinates(positions, extent_of(positions),
                      stream.decoder.decoder().header().position_bits, stream.coordinates);
}

}  // namespace
}  // namespace rlpc

using rlpc::Stream;

// Makes a stream. coarse_layers: 0 for the whole mesh.
RLPC_EXPORT(stream_new)
Stream* stream_new(double num_bytes, double max_memory_bytes, std::uint32_t coarse_layers,
                   bool verify_hashes, bool skip_damaged_units) {
  rlpc::DecoderOptions options;
  options.skip_damaged_units = skip_damaged_units;
  options.limits.max_memory_bytes = static_cast<std::uint64_t>(max_memory_bytes);
  options.verify_hashes = verify_hashes;
  if (coarse_layers > 0) options.coarse_layers = coarse_layers;
  options.read_dropped_slices = false;
  const auto open = [size = static_cast<std::uint64_t>(num_bytes)] {
    return std::make_unique<rlpc::ScriptSource>(size);
  };
  return new Stream(rlpc::SeekingDecoder(open, options));
}

RLPC_EXPORT(stream_open) bool stream_open(Stream* stream) { return stream->decoder.open(); }

RLPC_EXPORT(stream_describe) const char* stream_describe(Stream* stream) {
  stream->text = rlpc::describe(stream->decoder);
  return stream->text.c_str();
}

RLPC_EXPORT(stream_metadata) const char* stream_metadata(const Stream* stream) {
  return stream->decoder.decoder().metadata().c_str();
}

RLPC_EXPORT(stream_clip_name)
const char* stream_clip_name(const Stream* stream, std::uint32_t clip) {
  return stream->decoder.decoder().clips()[clip].name.c_str();
}

RLPC_EXPORT(stream_clip_first_frame)
std::uint32_t stream_clip_first_frame(const Stream* stream, std::uint32_t clip) {
  return stream->decoder.decoder().clips()[clip].first_frame;
}

RLPC_EXPORT(stream_clip_num_frames)
std::uint32_t stream_clip_num_frames(const Stream* stream, std::uint32_t clip) {
  return stream->decoder.decoder().clips()[clip].num_frames;
}

RLPC_EXPORT(stream_find_index) bool stream_find_index(Stream* stream) {
  return stream->decoder.find_index();
}

RLPC_EXPORT(stream_num_landmarks) std::uint32_t stream_num_landmarks(const Stream* stream) {
  return static_cast<std::uint32_t>(stream->decoder.landmarks().size());
}

RLPC_EXPORT(stream_landmarks) const double* stream_landmarks(Stream* stream) {
  const auto landmarks = stream->decoder.landmarks();
  stream->landmarks.assign(landmarks.begin(), landmarks.end());
  return stream->landmarks.data();
}

RLPC_EXPORT(stream_decode) bool stream_decode(Stream* stream, std::uint32_t frame) {
  return stream->decoder.decode(frame);
}

RLPC_EXPORT(stream_finish) bool stream_finish(Stream* stream) {
  return stream->decoder.finish();
}

RLPC_EXPORT(stream_hash_differs) bool stream_hash_differs(const Stream* stream) {
  return stream->decoder.hash_differs();
}

RLPC_EXPORT(stream_compared_frames) std::uint32_t stream_compared_frames(const Stream* stream) {
  return stream->decoder.compared_frames();
}

RLPC_EXPORT(stream_error_text) const char* stream_error_text(Stream* stream) {
  stream->text = rlpc::describe_error(stream->decoder.error());
  return stream->text.c_str();
}

RLPC_EXPORT(stream_error_rule) const char* stream_error_rule(const Stream* stream) {
  return stream->decoder.error().rule;
}

RLPC_EXPORT(stream_error_element) const char* stream_error_element(const Stream* stream) {
  return stream->decoder.error().element;
}

RLPC_EXPORT(stream_error_bit) double stream_error_bit(const Stream* stream) {
  return static_cast<double>(stream->decoder.error().bit_pos);
}

// Returns an Errc.
RLPC_EXPORT(stream_error_code) std::uint32_t stream_error_code(const Stream* stream) {
  return static_cast<std::uint32_t>(stream->decoder.error().code);
}

RLPC_EXPORT(stream_triangles) const std::uint32_t* stream_triangles(const Stream* stream) {
  const auto triangles = stream->decoder.decoder().triangles();
  return triangles.empty() ? nullptr : triangles.front().data();
}

// Returns the index in the whole mesh of each vertex; null for the whole mesh.
RLPC_EXPORT(stream_coarse_vertices)
const std::uint32_t* stream_coarse_vertices(const Stream* stream) {
  return rlpc::address_of(stream->decoder.decoder().coarse_vertices());
}

// The functions below refer to the frame that was decoded last.

RLPC_EXPORT(stream_positions) const std::int32_t* stream_positions(const Stream* stream) {
  return stream->decoder.positions().data();
}

// Returns coordinates (clause 7.3).
RLPC_EXPORT(stream_floats) const float* stream_floats(Stream* stream) {
  const auto positions = stream->decoder.positions();
  const rlpc::Grid& grid = stream->decoder.decoder().header().grid;
  stream->floats.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    for (std::size_t c = 0; c < 3; ++c) {
      stream->floats[i + c] = rlpc::float_position(grid, c, positions[i + c]);
    }
  }
  return stream->floats.data();
}

RLPC_EXPORT(stream_coordinates) const float* stream_coordinates(Stream* stream) {
  rlpc::compute_coordinates(*stream);
  return stream->coordinates.data();
}

// Returns the extent in grid units: three minima, then three maxima.
RLPC_EXPORT(stream_extent) const std::int32_t* stream_extent(Stream* stream) {
  stream->extent = rlpc::extent_of(stream->decoder.positions());
  return stream->extent.min.data();
}

RLPC_EXPORT(stream_normals) const float* stream_normals(Stream* stream) {
  rlpc::compute_coordinates(*stream);
  rlpc::vertex_normals(stream->coordinates, stream->decoder.decoder().triangles(),
                       stream->normals);
  return stream->normals.front().data();
}

// Returns the hash of 9.7.2 of the frame in output order.
RLPC_EXPORT(stream_frame_crc) std::uint32_t stream_frame_crc(const Stream* stream) {
  return rlpc::crc32_of_positions(stream->decoder.positions());
}

RLPC_EXPORT(stream_num_edges) std::uint32_t stream_num_edges(Stream* stream) {
  stream->edges = rlpc::drawn_edges(stream->decoder.decoder().triangles());
  return static_cast<std::uint32_t>(stream->edges.size());
}

// Returns the edges. Must be called after stream_num_edges.
RLPC_EXPORT(stream_edges) const std::uint32_t* stream_edges(const Stream* stream) {
  return stream->edges.empty() ? nullptr : stream->edges.front().data();
}
