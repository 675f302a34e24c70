// RLPC decoder in C: attributes of a stream, such as texture coordinates, normals and materials
// (Annex F), and the vertices to draw with. C99 and C++.
//
// A vertex of the stream has one position, but may have several texture coordinates or normals:
// one for each of its corners. Graphics APIs want vertices with one value of each.
// rlpc_decoder_split makes these, the drawn vertices:
//
//   uint32_t num_sets, num_drawn;
//   rlpc_decoder_attributes(decoder, &num_sets);   // decodes them
//   rlpc_decoder_split(decoder, &num_drawn);
//   rlpc_decoder_split_indices(decoder, indices, 12 * (size_t)num_triangles, 4);
//   uint32_t uv = rlpc_decoder_find_attribute(decoder, "uv0");
//   if (uv != RLPC_ALL) rlpc_decoder_split_floats(decoder, uv, texcoords, 2 * num_drawn);
//   output.split = 1;                              // positions and normals of drawn vertices
//   rlpc_decoder_frame(decoder, 17, &output);
//
// Attributes are not needed for frames, and errors of theirs leave frames decodable. A mesh of
// fewer layers (coarse_layers) has none.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
typedef enum rlpc_domain {
  RLPC_OF_VERTICES = 0,   // value i is that of vertex i
  RLPC_OF_CORNERS = 1,    // rlpc_decoder_attribute_of_corners tells the value of each corner
  RLPC_OF_TRIANGLES = 2,  // value i is that of triangle i
} rlpc_domain;

typedef enum rlpc_value_kind {
  RLPC_INTEGERS = 0,
  RLPC_UNIT_VECTORS = 1,
  RLPC_FLOATS = 2,
  // No values, but which corners share a normal; normals of any frame follow from positions.
  RLPC_SMOOTHING = 3,
} rlpc_value_kind;

typedef struct rlpc_attribute {
  size_t struct_size;  // as passed to rlpc_decoder_attribute
  // "uv0", "normal", "colour0", "material", "part" and others (Table F-1). Valid until the
  // handle is closed; ends at a zero byte, if the name has one.
  const char* name;
  uint32_t domain;          // rlpc_domain
  uint32_t kind;            // rlpc_value_kind
  uint32_t num_components;  // of a value as floats: 1 to 4; 0 of smoothing
  uint32_t num_values;      // 0 of smoothing
} rlpc_attribute;
// NOLINTEND(readability-identifier-naming)

struct rlpc_decoder;

// Decodes the attributes, once. num_sets: how many sets there are; 0: the stream has none. Any
// error is that of the attributes alone. Time: that of parsing the first GOF, unless it is in
// use, and of some passes over all triangles; the next frame stays. Memory: all values, until
// the handle is closed.
RLPC_API rlpc_status rlpc_decoder_attributes(struct rlpc_decoder* decoder, uint32_t* num_sets);
// The functions below are of the sets that rlpc_decoder_attributes has decoded; before it,
// there are none. set: below num_sets, otherwise RLPC_BAD_ARGUMENT.
RLPC_API rlpc_status rlpc_decoder_attribute(struct rlpc_decoder* decoder, uint32_t set,
                                            rlpc_attribute* attribute, size_t struct_size);
// The set of that name; RLPC_ALL: none.
RLPC_API uint32_t rlpc_decoder_find_attribute(const struct rlpc_decoder* decoder,
                                              const char* name);
// Copies the values of a set. num_floats, num_integers: num_values times num_components.
// _floats: texture coordinates, colours from 0 to 1, unit vectors as x, y and z, or what the
// encoder was given; in the precision of the stream. _integers: of RLPC_INTEGERS and
// RLPC_FLOATS (their bits), without scale and offset.
RLPC_API rlpc_status rlpc_decoder_attribute_floats(struct rlpc_decoder* decoder, uint32_t set,
                                                   float* values, size_t num_floats);
RLPC_API rlpc_status rlpc_decoder_attribute_integers(struct rlpc_decoder* decoder, uint32_t set,
                                                     uint32_t* values, size_t num_integers);
// Of each corner, the index of its value; of smoothing, corners with the same number share a
// normal. num_corners: 3 * num_triangles.
RLPC_API rlpc_status rlpc_decoder_attribute_of_corners(struct rlpc_decoder* decoder,
                                                       uint32_t set, uint32_t* indices,
                                                       size_t num_corners);

// Makes the drawn vertices: those of the stream, each as often as it has different combinations
// of values at its corners. num_drawn: at least num_vertices; those of one vertex follow each
// other, in the order of the vertices. Time: in proportion to n log n, n the number of
// triangles; memory: some indices for each of them, until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_split(struct rlpc_decoder* decoder, uint32_t* num_drawn);
// The functions below need rlpc_decoder_split: otherwise RLPC_BAD_ARGUMENT.
//
// The vertex of the stream of each drawn vertex. num_values: num_drawn.
RLPC_API rlpc_status rlpc_decoder_split_vertices(struct rlpc_decoder* decoder,
                                                 uint32_t* vertices, size_t num_values);
// The triangles, in the order of the stream, with drawn vertices. As rlpc_decoder_indices.
RLPC_API rlpc_status rlpc_decoder_split_indices(struct rlpc_decoder* decoder, void* indices,
                                                size_t num_bytes, uint32_t index_bytes);
// The values of a set of vertices or corners, but smoothing, at the drawn vertices.
// num_floats: num_drawn times num_components.
RLPC_API rlpc_status rlpc_decoder_split_floats(struct rlpc_decoder* decoder, uint32_t set,
                                               float* values, size_t num_floats);

// The asset of the stream: materials, textures and names as a GLB without geometry, as the
// encoder was given it (6.16). It is not checked beyond its size; a reader of glTF must do
// that. Valid until the handle is closed. num_bytes: 0 if there is none.
RLPC_API rlpc_status rlpc_decoder_asset(struct rlpc_decoder* decoder, const void** bytes,
                                        size_t* num_bytes);

#ifdef __cplusplus
}
#endif
