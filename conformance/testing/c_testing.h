// Shared code of the tests in C: checks, and streams of small animations. C99; included once by
// each program.
#pragma once

#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include "encoder/c_api/rlpc_c_encoder.h"

static int failures = 0;

// Counts a failure, with its place, and goes on.
#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      fprintf(stderr, "%s:%d: failed: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                             \
    }                                                                         \
  } while (0)

// The stream that was encoded last.
static unsigned char encoded[1 << 20];
static size_t encoded_size;

static inline int append_encoded(void* user, const void* bytes, size_t num_bytes) {
  (void)user;
  if (num_bytes > sizeof encoded - encoded_size) return 1;
  memcpy(encoded + encoded_size, bytes, num_bytes);
  encoded_size += num_bytes;
  return 0;
}

// Two triangles for each field of a grid of vertices, row after row: 6 * (rows - 1) * fields
// indices. A closed grid has a field behind its last column.
static inline void make_grid(uint32_t rows, uint32_t columns, int is_closed,
                             uint32_t* indices) {
  const uint32_t fields = is_closed ? columns : columns - 1;
  for (uint32_t row = 0; row + 1 < rows; ++row) {
    for (uint32_t field = 0; field < fields; ++field) {
      const uint32_t a = row * columns + field, b = row * columns + (field + 1) % columns;
      const uint32_t quad[6] = {a, b, a + columns, a + columns, b, b + columns};
      memcpy(indices, quad, sizeof quad);
      indices += 6;
    }
  }
}

// Encodes num_frames frames of 3 * num_vertices floats from make_frame. The box has three equal
// sides. xyz: memory for a frame.
static inline void encode_frames(rlpc_frame_format* format, const rlpc_encode_options* options,
                                 float box_min, float box_max,
                                 void (*make_frame)(int frame, float* xyz), float* xyz) {
  for (int c = 0; c < 3; ++c) {
    format->box_min[c] = box_min;
    format->box_max[c] = box_max;
  }
  encoded_size = 0;
  rlpc_encoder* encoder;
  CHECK(rlpc_encoder_create(format, options, append_encoded, NULL, &encoder) == RLPC_OK);
  for (uint32_t f = 0; f < format->num_frames; ++f) {
    make_frame((int)f, xyz);
    CHECK(rlpc_encoder_add_frame(encoder, xyz, 3 * (size_t)format->num_vertices) == RLPC_OK);
  }
  CHECK(rlpc_encoder_finish(encoder, NULL, 0) == RLPC_OK);
  rlpc_encoder_close(encoder);
}
