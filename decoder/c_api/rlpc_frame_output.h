// RLPC decoder in C: the form in which rlpc_decoder_frame, _next and _blend write a frame. C99
// and C++.
//
//   rlpc_frame_output output;
//   rlpc_frame_output_init(&output, sizeof output);
//   output.positions.data = &vertices->position;  // of the first vertex
//   output.positions.format = RLPC_FORMAT_FLOAT;
//   output.positions.num_bytes = vertices_bytes - offsetof(vertex, position);
//   output.normals.data = &vertices->normal;
//   output.normals.format = RLPC_FORMAT_INT8;
//   output.normals.num_bytes = vertices_bytes - offsetof(vertex, normal);
//   output.positions.stride = output.normals.stride = sizeof(vertex);
//   rlpc_decoder_frame(decoder, 17, &output);
//
// Versions and structures: rlpc_status.h. Everything in this header is there since 1.2.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Formats of values. Since 1.2.
typedef enum rlpc_format {
  RLPC_FORMAT_INT32 = 1,  // positions: grid units, exact
  RLPC_FORMAT_FLOAT = 2,  // 32 bits, in the units of the encoder's input
  RLPC_FORMAT_HALF = 3,   // IEEE 754 binary16, rounded to nearest; infinity from 65520 on
  RLPC_FORMAT_INT16 = 4,  // positions: see int16_scale; normals: 32767 times the vector
  RLPC_FORMAT_INT8 = 5,   // normals: 127 times the vector
} rlpc_format;

// Weights of the triangles around a vertex in its normal. Since 1.2.
typedef enum rlpc_normal_weight {
  RLPC_NORMAL_WEIGHT_AREA = 0,   // the area of the triangle
  RLPC_NORMAL_WEIGHT_ANGLE = 1,  // its angle at the vertex; independent of triangulation
} rlpc_normal_weight;

// Buffer of the caller for three values per vertex, one vertex every stride bytes; bytes in
// between are not written. Since 1.2.
typedef struct rlpc_channel {
  void* data;        // null: no output; values need no alignment
  size_t num_bytes;  // buffer size from data on, at least up to the last value
  size_t stride;     // bytes from vertex to vertex; 0: no gaps
  uint32_t format;   // rlpc_format
} rlpc_channel;

// Form of a frame. rlpc_frame_output_init sets the defaults. Since 1.2.
typedef struct rlpc_frame_output {
  size_t struct_size;      // set by rlpc_frame_output_init
  rlpc_channel positions;  // RLPC_FORMAT_INT32, _FLOAT, _HALF or _INT16
  // Unit vectors computed from the geometry of the frame, RLPC_FORMAT_FLOAT, _HALF, _INT16 or
  // _INT8; 0, 0, 1 where the triangles around a vertex have no area. Time: one pass over all
  // triangles.
  rlpc_channel normals;
  uint32_t normal_weight;  // rlpc_normal_weight
  // Scale and offset of RLPC_FORMAT_INT16 positions: coordinate = value * scale + offset for
  // each axis, rounded to the nearest value and clipped to 16 bits. A scale of 0, the default:
  // covers range_min to range_max of rlpc_stream_info (rlpc_decoder_int16_scale).
  double int16_scale[3];
  double int16_offset[3];
  // 1: writes a value per drawn vertex (rlpc_attributes.h). If the stream has a set `normal`,
  // normals then come from it, with its smoothing and weights instead of normal_weight; stored
  // normals turn with the edges around their vertex, which takes several times as long. 0:
  // writes a value per vertex of the stream.
  uint32_t split;
} rlpc_frame_output;
// NOLINTEND(readability-identifier-naming)

// Sets all members to their defaults: no output. struct_size: sizeof *output. Since 1.2.
RLPC_API void rlpc_frame_output_init(rlpc_frame_output* output, size_t struct_size);

struct rlpc_decoder;
// Computes the scales and offsets with which 16 bits cover every position of the grid, for x, y
// and z, in units. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_int16_scale(struct rlpc_decoder* decoder, double scale[3],
                                              double offset[3]);

#ifdef __cplusplus
}
#endif
