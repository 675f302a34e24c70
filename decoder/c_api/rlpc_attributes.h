// RLPC decoder in C: attributes of a stream, such as texture coordinates, normals and materials
// (Annex F), and the vertices to draw. C99 and C++.
//
// A vertex of the stream has one position, but may have several texture coordinates or normals,
// one per corner. Graphics APIs need vertices with one value of each: rlpc_decoder_split makes
// these drawn vertices.
//
//   uint32_t num_sets, num_drawn;
//   rlpc_decoder_attributes(decoder, &num_sets);  // decodes them
//   rlpc_decoder_split(decoder, &num_drawn);
//   rlpc_decoder_split_indices(decoder, indices, 12 * (size_t)num_triangles, 4);
//   uint32_t uv = rlpc_decoder_find_attribute(decoder, "uv0");
//   if (uv != RLPC_ALL)
//     rlpc_decoder_split_floats(decoder, uv, coordinates, 2 * (size_t)num_drawn);
//   output.split = 1;  // positions and normals of drawn vertices
//   rlpc_decoder_frame(decoder, 17, &output);
//
// Frames do not depend on attributes, and errors in attributes do not affect frames. A coarse
// mesh (coarse_layers) has no attributes. Status codes: as in rlpc_c_decoder.h; versions and
// structures: rlpc_status.h. Everything in this header is there since 1.2.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Places that have the values of a set. Since 1.2.
typedef enum rlpc_domain {
  RLPC_DOMAIN_VERTICES = 0,   // one value per vertex, in order
  RLPC_DOMAIN_CORNERS = 1,    // corners refer to values: rlpc_decoder_attribute_of_corners
  RLPC_DOMAIN_TRIANGLES = 2,  // one value per triangle, in order
} rlpc_domain;

// Kinds of values. Since 1.2.
typedef enum rlpc_value_kind {
  RLPC_VALUE_KIND_INTEGERS = 0,
  RLPC_VALUE_KIND_UNIT_VECTORS = 1,
  RLPC_VALUE_KIND_FLOATS = 2,
  // No values: defines which corners share a normal, computed from the positions of any frame.
  RLPC_VALUE_KIND_SMOOTHING = 3,
} rlpc_value_kind;

// Properties of a set. Since 1.2.
typedef struct rlpc_attribute {
  size_t struct_size;  // size passed to rlpc_decoder_attribute
  // "uv0", "normal", "colour0", "material", "part" and others (Table F-1). Valid until the
  // handle is closed; ends at the first zero byte.
  const char* name;
  uint32_t domain;          // rlpc_domain
  uint32_t kind;            // rlpc_value_kind
  uint32_t num_components;  // floats per value, 1 to 4; smoothing: 0
  uint32_t num_values;      // smoothing: 0
} rlpc_attribute;
// NOLINTEND(readability-identifier-naming)

struct rlpc_decoder;

// Decodes the attributes on the first call, and sets num_sets to the number of sets, 0 if the
// stream has none. The next frame stays the same. Returns a stream error if the attributes
// cannot be decoded; frames still can. Time: parses the first GOF, unless it is in use, and
// makes several passes over all triangles. Memory: all values, until the handle is closed.
// Since 1.2.
RLPC_API rlpc_status rlpc_decoder_attributes(struct rlpc_decoder* decoder, uint32_t* num_sets);
// Describes a set. set, here and below: less than num_sets, otherwise RLPC_BAD_ARGUMENT, as
// before rlpc_decoder_attributes. struct_size: sizeof *attribute. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_attribute(struct rlpc_decoder* decoder, uint32_t set,
                                            rlpc_attribute* attribute, size_t struct_size);
// Returns the number of the set with a name, or RLPC_ALL if there is none. Since 1.2.
RLPC_API uint32_t rlpc_decoder_find_attribute(const struct rlpc_decoder* decoder,
                                              const char* name);
// Copies the values of a set as floats: texture coordinates, colours from 0 to 1, unit vectors
// as x, y and z, or other numbers of the encoder's input, in the precision of the stream.
// num_floats: num_values * num_components. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_attribute_floats(struct rlpc_decoder* decoder, uint32_t set,
                                                   float* values, size_t num_floats);
// Copies the values of a set as integers, without scale and offset, or the bits of
// RLPC_VALUE_KIND_FLOATS. num_integers: num_values * num_components. Returns RLPC_BAD_ARGUMENT
// for RLPC_VALUE_KIND_UNIT_VECTORS. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_attribute_integers(struct rlpc_decoder* decoder, uint32_t set,
                                                     uint32_t* values, size_t num_integers);
// Copies the index of the value of each corner; in a smoothing set, corners with the same index
// share a normal. num_corners: 3 * num_triangles. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_attribute_of_corners(struct rlpc_decoder* decoder,
                                                       uint32_t set, uint32_t* indices,
                                                       size_t num_corners);

// Makes the drawn vertices on the first call: a copy of each vertex of the stream for each
// combination of values at its corners, in the order of the vertices. Decodes the attributes if
// needed, and then returns the errors of rlpc_decoder_attributes. num_drawn: their number, at
// least num_vertices. Time: proportional to n log n for n triangles. Memory: some indices per
// triangle, until the handle is closed. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_split(struct rlpc_decoder* decoder, uint32_t* num_drawn);
// Copies the vertex of the stream of each drawn vertex. num_values: num_drawn. Like the other
// rlpc_decoder_split_ functions, returns RLPC_BAD_ARGUMENT before rlpc_decoder_split.
// Since 1.2.
RLPC_API rlpc_status rlpc_decoder_split_vertices(struct rlpc_decoder* decoder,
                                                 uint32_t* vertices, size_t num_values);
// Copies the triangles, in the order of the stream, as indices of drawn vertices. Parameters
// and errors: as for rlpc_decoder_indices, with num_drawn vertices. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_split_indices(struct rlpc_decoder* decoder, void* indices,
                                                size_t num_bytes, uint32_t index_bytes);
// Copies the values of a set at the drawn vertices. num_floats: num_drawn * num_components.
// Returns RLPC_BAD_ARGUMENT for sets of triangles or smoothing. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_split_floats(struct rlpc_decoder* decoder, uint32_t set,
                                               float* values, size_t num_floats);

// Finds the asset of the stream: materials, textures and names as a GLB without geometry, as
// passed to the encoder (6.16), or null and 0 bytes if there is none. Valid until the handle is
// closed. Only its size is checked; its reader must check the glTF. Returns a stream error if
// it is damaged. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_asset(struct rlpc_decoder* decoder, const void** bytes,
                                        size_t* num_bytes);

#ifdef __cplusplus
}
#endif
