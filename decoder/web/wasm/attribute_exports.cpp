// C++ functions exported to JavaScript (src/wasm_attributes.js) for attributes, drawn vertices
// and assets.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include "decoder/surface/attribute_values.h"
#include "decoder/surface/drawn_mesh.h"
#include "decoder/web/wasm/stream.h"

using rlpc::Stream;

RLPC_EXPORT(stream_decode_attributes) bool stream_decode_attributes(Stream* stream) {
  return stream->decoder.decode_attributes();
}

// The functions below must be called after stream_decode_attributes. set: below the number of
// sets.

RLPC_EXPORT(stream_num_sets) std::uint32_t stream_num_sets(const Stream* stream) {
  return static_cast<std::uint32_t>(stream->decoder.sets().size());
}

RLPC_EXPORT(stream_set_name)
const char* stream_set_name(const Stream* stream, std::uint32_t set) {
  return stream->decoder.sets()[set].header.name.c_str();
}

RLPC_EXPORT(stream_set_domain)
std::uint32_t stream_set_domain(const Stream* stream, std::uint32_t set) {
  return static_cast<std::uint32_t>(stream->decoder.sets()[set].header.domain);
}

RLPC_EXPORT(stream_set_kind)
std::uint32_t stream_set_kind(const Stream* stream, std::uint32_t set) {
  return static_cast<std::uint32_t>(stream->decoder.sets()[set].header.kind);
}

RLPC_EXPORT(stream_set_num_values)
std::uint32_t stream_set_num_values(const Stream* stream, std::uint32_t set) {
  return static_cast<std::uint32_t>(stream->decoder.sets()[set].num_values());
}

// Return the number of components of a value, as coded and as numbers.
RLPC_EXPORT(stream_set_coded_components)
std::uint32_t stream_set_coded_components(const Stream* stream, std::uint32_t set) {
  return stream->decoder.sets()[set].header.num_components;
}

RLPC_EXPORT(stream_set_components)
std::uint32_t stream_set_components(const Stream* stream, std::uint32_t set) {
  return rlpc::number_components(stream->decoder.sets()[set].header);
}

RLPC_EXPORT(stream_set_integers)
const std::uint32_t* stream_set_integers(const Stream* stream, std::uint32_t set) {
  return stream->decoder.sets()[set].values.data();
}

RLPC_EXPORT(stream_set_numbers)
const float* stream_set_numbers(Stream* stream, std::uint32_t set) {
  stream->numbers = rlpc::attribute_numbers(stream->decoder.sets()[set]);
  return stream->numbers.data();
}

// Returns the index of the value of each corner, in the domain of corners.
RLPC_EXPORT(stream_set_corners)
const std::uint32_t* stream_set_corners(const Stream* stream, std::uint32_t set) {
  return stream->decoder.sets()[set].value_of_corner.data();
}

RLPC_EXPORT(stream_num_drawn) std::uint32_t stream_num_drawn(Stream* stream) {
  return stream->decoder.drawn().vertices().num_vertices();
}

RLPC_EXPORT(stream_drawn_vertices)
const std::uint32_t* stream_drawn_vertices(Stream* stream) {
  return stream->decoder.drawn().vertices().stream_vertex.data();
}

RLPC_EXPORT(stream_drawn_triangles)
const std::uint32_t* stream_drawn_triangles(Stream* stream) {
  const auto& triangles = stream->decoder.drawn().vertices().triangles;
  return triangles.empty() ? nullptr : triangles.front().data();
}

// Returns the index of the value of each drawn vertex; null if they have no values of the set.
RLPC_EXPORT(stream_drawn_values)
const std::uint32_t* stream_drawn_values(Stream* stream, std::uint32_t set) {
  const rlpc::DrawnMesh& drawn = stream->decoder.drawn();
  const auto sets = drawn.sets();
  const auto* const wanted = &stream->decoder.sets()[set];
  const auto found = std::find(sets.begin(), sets.end(), wanted);
  if (found == sets.end() || rlpc::number_components(wanted->header) == 0) return nullptr;
  return drawn.vertices()
      .value_of_vertex[static_cast<std::size_t>(found - sets.begin())]
      .data();
}

// Returns the number of normals of the set `normal`; 0 if there is none.
RLPC_EXPORT(stream_num_set_normals) std::uint32_t stream_num_set_normals(Stream* stream) {
  rlpc::DrawnMesh& drawn = stream->decoder.drawn();
  return drawn.has_normals() ? drawn.normals().count() : 0;
}

// Computes the normals of the frame that was decoded last.
RLPC_EXPORT(stream_set_normals) const float* stream_set_normals(Stream* stream) {
  const auto positions = stream->decoder.positions();
  rlpc::unit_normals(stream->decoder.drawn().normals().sums(positions), stream->set_normals);
  return stream->set_normals.front().data();
}

// Returns the index of the normal of each drawn vertex.
RLPC_EXPORT(stream_drawn_normals) const std::uint32_t* stream_drawn_normals(Stream* stream) {
  return stream->decoder.drawn().normal_of_vertex().data();
}

// Reads the asset. Must be called before the functions below.
RLPC_EXPORT(stream_read_asset) bool stream_read_asset(Stream* stream) {
  return stream->decoder.read_asset();
}

RLPC_EXPORT(stream_asset_size) std::uint32_t stream_asset_size(const Stream* stream) {
  return static_cast<std::uint32_t>(stream->decoder.asset().size());
}

RLPC_EXPORT(stream_asset) const char* stream_asset(const Stream* stream) {
  return stream->decoder.asset().data();
}
