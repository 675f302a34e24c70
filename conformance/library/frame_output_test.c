// Tests all output formats of frames of the library in C. C99.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/testing/c_testing.h"
#include "decoder/c_api/rlpc_c_decoder.h"
#include "encoder/c_api/rlpc_c_encoder.h"

// Two triangles, a quarter turn apart, of different sizes; they share an edge.
#define VERTICES 4
#define TRIANGLES 2
#define FRAMES 6
#define STRIDE 29

// x along the edge; the small triangle goes up y, the large one up z.
static void make_frame(int frame, float* xyz) {
  const float f = (float)frame;
  const float values[3 * VERTICES] = {f, 0, 0, 2.0F + f, 0, 0, f, 1, 0, f, 0, 4};
  memcpy(xyz, values, sizeof values);
}

static void encode(void) {
  static const uint32_t indices[3 * TRIANGLES] = {0, 1, 2, 0, 3, 1};
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = VERTICES;
  format.num_triangles = TRIANGLES;
  format.indices = indices;
  format.num_frames = FRAMES;
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.keep_order = 1;
  options.gof_frames = 2;
  options.target = RLPC_TARGET_MAX_ERROR;
  options.target_value = 1e-4;
  float xyz[3 * VERTICES];
  encode_frames(&format, &options, -1, 10, make_frame, xyz);
}

static rlpc_decoder* decoder;
static rlpc_frame_output output;
static unsigned char buffer[VERTICES * STRIDE];

static rlpc_status give(rlpc_channel* channel, uint32_t format, size_t stride) {
  rlpc_frame_output_init(&output, sizeof output);
  memset(buffer, 0xAB, sizeof buffer);
  channel->data = buffer;
  channel->num_bytes = sizeof buffer;
  channel->stride = stride;
  channel->format = format;
  return rlpc_decoder_frame(decoder, 3, &output);
}

static double half(uint16_t bits) {
  const int exponent = (bits >> 10) & 31;
  const int fraction = bits & 1023;
  const double size =
      exponent == 0 ? ldexp(fraction, -24) : ldexp(1024 + fraction, exponent - 25);
  return bits >> 15 ? -size : size;
}

// Returns value c of vertex v in the buffer, in a format.
static double value(uint32_t format, size_t stride, int v, int c) {
  const size_t bytes = format == RLPC_FORMAT_INT8                                  ? 1
                       : format == RLPC_FORMAT_INT16 || format == RLPC_FORMAT_HALF ? 2
                                                                                   : 4;
  const unsigned char* at =
      buffer + (size_t)v * (stride == 0 ? 3 * bytes : stride) + (size_t)c * bytes;
  int32_t wide;
  int16_t narrow;
  float real;
  switch (format) {
    case RLPC_FORMAT_INT32:
      memcpy(&wide, at, sizeof wide);
      return wide;
    case RLPC_FORMAT_FLOAT:
      memcpy(&real, at, sizeof real);
      return (double)real;
    case RLPC_FORMAT_HALF:
      memcpy(&narrow, at, sizeof narrow);
      return half((uint16_t)narrow);
    case RLPC_FORMAT_INT16:
      memcpy(&narrow, at, sizeof narrow);
      return narrow;
    default:
      return (signed char)*at;
  }
}

static void test_positions(void) {
  static const double expected[VERTICES][3] = {{3, 0, 0}, {5, 0, 0}, {3, 1, 0}, {3, 0, 4}};
  rlpc_stream_info info;
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  double scale[3], offset[3];
  CHECK(rlpc_decoder_int16_scale(decoder, scale, offset) == RLPC_OK);
  static const uint32_t formats[] = {RLPC_FORMAT_INT32, RLPC_FORMAT_FLOAT, RLPC_FORMAT_HALF,
                                     RLPC_FORMAT_INT16};
  for (int i = 0; i < 8; ++i) {
    const uint32_t format = formats[i / 2];
    const size_t stride = i % 2 == 0 ? 0 : STRIDE;
    CHECK(give(&output.positions, format, stride) == RLPC_OK);
    for (int v = 0; v < VERTICES; ++v) {
      for (int c = 0; c < 3; ++c) {
        double x = value(format, stride, v, c);
        double max = 1.1e-4;
        if (format == RLPC_FORMAT_INT32)
          x = ldexp(x + info.grid_origin[c], info.grid_log2_step);
        if (format == RLPC_FORMAT_INT16) x = x * scale[c] + offset[c];
        if (format == RLPC_FORMAT_INT16) max += scale[c] / 2;
        if (format == RLPC_FORMAT_HALF) max += 5.0 / 2048;
        CHECK(fabs(x - expected[v][c]) <= max);
      }
    }
    // Bytes between vertices are not changed.
    if (stride != 0) CHECK(buffer[12] == 0xAB && buffer[STRIDE - 1] == 0xAB);
  }
  // Scales given by the caller; values beyond them are clamped.
  rlpc_frame_output_init(&output, sizeof output);
  int16_t small[3 * VERTICES];
  output.positions.data = small;
  output.positions.num_bytes = sizeof small;
  output.positions.format = RLPC_FORMAT_INT16;
  for (int c = 0; c < 3; ++c) output.int16_scale[c] = 0.5;
  output.int16_offset[0] = 1;
  output.int16_scale[2] = 1e-9;
  CHECK(rlpc_decoder_frame(decoder, 3, &output) == RLPC_OK);
  CHECK(small[0] == 4 && small[3] == 8 && small[7] == 2 && small[11] == 32767);
  output.int16_offset[0] = NAN;
  CHECK(rlpc_decoder_frame(decoder, 3, &output) == RLPC_BAD_ARGUMENT);
  output.int16_offset[0] = 0;
  output.int16_scale[1] = INFINITY;
  CHECK(rlpc_decoder_frame(decoder, 3, &output) == RLPC_BAD_ARGUMENT);
}

static void test_normals(void) {
  // At vertex 2 the normal of the small triangle, at 3 of the large one; at 0 their sum, by
  // area (2 to 8) or by angle (equal there); at 1 by angles of atan(1/2) and atan(2).
  static const uint32_t formats[] = {RLPC_FORMAT_FLOAT, RLPC_FORMAT_HALF, RLPC_FORMAT_INT16,
                                     RLPC_FORMAT_INT8};
  static const double units[] = {1, 1, 32767, 127};
  for (int i = 0; i < 8; ++i) {
    const uint32_t format = formats[i / 2];
    const int by_angle = i % 2;
    rlpc_frame_output_init(&output, sizeof output);
    memset(buffer, 0xAB, sizeof buffer);
    output.normals.data = buffer;
    output.normals.num_bytes = sizeof buffer;
    output.normals.stride = STRIDE;
    output.normals.format = format;
    output.normal_weight = by_angle ? RLPC_NORMAL_WEIGHT_ANGLE : RLPC_NORMAL_WEIGHT_AREA;
    CHECK(rlpc_decoder_frame(decoder, 3, &output) == RLPC_OK);
    const double small_weights[VERTICES] = {by_angle ? 1 : 2, by_angle ? atan(0.5) : 2, 1, 0};
    const double large_weights[VERTICES] = {by_angle ? 1 : 8, by_angle ? atan(2) : 8, 0, 1};
    for (int v = 0; v < VERTICES; ++v) {
      const double length = hypot(small_weights[v], large_weights[v]);
      const double normal[3] = {0, large_weights[v] / length, small_weights[v] / length};
      for (int c = 0; c < 3; ++c) {
        const double x = value(format, STRIDE, v, c) / units[i / 2];
        CHECK(fabs(x - normal[c]) <=
              0.002 + 0.5 / units[i / 2] * (format >= RLPC_FORMAT_INT16));
      }
    }
  }
}

static void test_refusals(void) {
  CHECK(give(&output.positions, RLPC_FORMAT_INT8, 0) == RLPC_BAD_ARGUMENT);
  CHECK(strstr(rlpc_decoder_error_text(decoder), "positions: unsupported format 5") != NULL);
  CHECK(give(&output.normals, RLPC_FORMAT_INT32, 0) == RLPC_BAD_ARGUMENT);
  CHECK(give(&output.positions, 0, 0) == RLPC_BAD_ARGUMENT);
  CHECK(give(&output.positions, RLPC_FORMAT_FLOAT, 11) == RLPC_BAD_ARGUMENT);
  CHECK(strstr(rlpc_decoder_error_text(decoder), "a stride of 11 bytes") != NULL);
  CHECK(give(&output.positions, RLPC_FORMAT_FLOAT, STRIDE + 1) == RLPC_OK);
  CHECK(give(&output.positions, RLPC_FORMAT_FLOAT, STRIDE + 6) == RLPC_BAD_ARGUMENT);
  CHECK(strstr(rlpc_decoder_error_text(decoder), "has 116 bytes, not 117") != NULL);
  CHECK(give(&output.positions, RLPC_FORMAT_FLOAT, SIZE_MAX / 2) == RLPC_BAD_ARGUMENT);
  output.struct_size = 0;
  CHECK(rlpc_decoder_frame(decoder, 0, &output) == RLPC_BAD_ARGUMENT);
  rlpc_frame_output_init(&output, sizeof output);
  output.normal_weight = 2;
  CHECK(rlpc_decoder_frame(decoder, 0, &output) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_frame(decoder, 0, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next(decoder, NULL) == RLPC_BAD_ARGUMENT);
  rlpc_frame_output_init(&output, sizeof output);
  CHECK(rlpc_decoder_frame(decoder, FRAMES, &output) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_prefetch(decoder, FRAMES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_frame(NULL, 0, &output) == RLPC_BAD_ARGUMENT);
}

static void test_indices(void) {
  uint32_t wide[3 * TRIANGLES];
  uint16_t narrow[3 * TRIANGLES];
  CHECK(rlpc_decoder_indices(decoder, wide, sizeof wide, 4) == RLPC_OK);
  CHECK(rlpc_decoder_indices(decoder, narrow, sizeof narrow, 2) == RLPC_OK);
  uint32_t same[3 * TRIANGLES];
  CHECK(rlpc_decoder_triangles(decoder, same, 3 * TRIANGLES) == RLPC_OK);
  for (int i = 0; i < 3 * TRIANGLES; ++i) CHECK(wide[i] == narrow[i] && wide[i] == same[i]);
  CHECK(rlpc_decoder_indices(decoder, narrow, sizeof narrow, 4) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_indices(decoder, narrow, sizeof narrow, 3) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_indices(decoder, NULL, sizeof narrow, 2) == RLPC_BAD_ARGUMENT);
}

static void test_descriptions(void) {
  rlpc_stream_info info;
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  CHECK(fabs(info.duration_seconds - (FRAMES - 1) / 30.0) < 1e-9);
  for (int c = 0; c < 3; ++c) CHECK(info.range_min[c] <= -1 && info.range_max[c] >= 10);

  float min[3], max[3];
  rlpc_frame_output_init(&output, sizeof output);
  CHECK(rlpc_decoder_frame(decoder, 5, &output) == RLPC_OK);
  CHECK(rlpc_decoder_bounds(decoder, min, max) == RLPC_OK);
  const float expected[6] = {5, 0, 0, 7, 1, 4};
  for (int c = 0; c < 3; ++c) {
    CHECK(fabsf(min[c] - expected[c]) < 2e-4F && fabsf(max[c] - expected[3 + c]) < 2e-4F);
  }
  CHECK(rlpc_decoder_next(decoder, &output) == RLPC_END);
  CHECK(rlpc_decoder_bounds(decoder, min, max) == RLPC_OK);
  for (int c = 0; c < 3; ++c) CHECK(fabsf(min[c] - expected[c]) < 2e-4F);

  rlpc_gof gofs[FRAMES];
  uint32_t num_gofs = 0;
  CHECK(rlpc_decoder_gofs(decoder, NULL, 0, &num_gofs) == RLPC_OK && num_gofs == 3);
  CHECK(rlpc_decoder_gofs(decoder, gofs, FRAMES, &num_gofs) == RLPC_OK);
  for (uint32_t i = 0; i < 3; ++i)
    CHECK(gofs[i].first_frame == 2 * i && gofs[i].num_frames == 2);
  CHECK(rlpc_decoder_gof_of(decoder, 3, gofs) == RLPC_OK && gofs[0].first_frame == 2);
  CHECK(rlpc_decoder_gofs(decoder, NULL, 1, &num_gofs) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_gofs(decoder, gofs, 1, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_gof_of(decoder, FRAMES, gofs) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_gof_of(decoder, 0, NULL) == RLPC_BAD_ARGUMENT);

  rlpc_memory memory;
  CHECK(rlpc_decoder_frame(decoder, 0, &output) == RLPC_OK);
  CHECK(rlpc_decoder_memory(decoder, &memory, sizeof memory) == RLPC_OK);
  CHECK(memory.stream_bytes > 0 && memory.gof_bytes > 0 && memory.cached_bytes > 0);
  CHECK(rlpc_decoder_memory(decoder, NULL, sizeof memory) == RLPC_BAD_ARGUMENT);
}

// One vertex, whose stride leads far out of the buffer: no place behind it may be computed.
static void test_one_vertex(void) {
  static const unsigned char one_vertex[] = {
      0x89, 0x52, 0x4c, 0x50, 0x43, 0x0d, 0x0a, 0x1a, 0x01, 0x01, 0x01, 0x00, 0x00, 0x00, 0x05,
      0x01, 0x01, 0xe1, 0xef, 0xc0, 0x33, 0xfb, 0x4b, 0x2a, 0x02, 0x00, 0x00, 0x00, 0x02, 0xa8,
      0x00, 0x6f, 0xa9, 0x2c, 0xd8, 0x04, 0x00, 0x00, 0x00, 0x6e, 0xe2, 0x40, 0x70, 0x80, 0x00,
      0x03, 0xff, 0x00, 0x20, 0x00, 0x00, 0x38, 0x52, 0x2b, 0x6a, 0xaf, 0x40, 0xe7, 0x41, 0x2b,
      0x7a, 0x09, 0x5b, 0xc8, 0x0d, 0x7e, 0x5c, 0xbb, 0xb9, 0x0c, 0xb1, 0x75, 0xeb, 0xab, 0xaf,
      0x5c, 0xaf, 0xcb, 0x42, 0xca, 0x1c, 0x9c, 0x5a, 0x49, 0x0f, 0xb2, 0x48, 0x7d, 0x3d, 0x6f,
      0x2c, 0x3a, 0xe3, 0x2e, 0xb8, 0xe0, 0xe7, 0xb7, 0x07, 0x39, 0x4d, 0x2c, 0xcc, 0x98, 0x8b,
      0x6e, 0xc9, 0x3b, 0x8e, 0x49, 0xdb, 0xdd, 0x9e, 0xfd, 0x0e, 0xa9, 0x11, 0xd0, 0xdf, 0x16,
      0x86, 0xf8, 0xaf, 0xbe, 0x5f, 0xa5, 0x89, 0x62, 0x1a, 0x18, 0x53, 0xa7, 0xda, 0x9d, 0x3c,
      0x88, 0xb0, 0xa5, 0x6a, 0xa9, 0xfa, 0xc1, 0x22, 0xce, 0x09, 0x16, 0x6c, 0x1f, 0xeb, 0x5a,
      0xd2, 0xa8, 0x79, 0x80, 0x06, 0x00, 0x00, 0x00, 0x09, 0xc0, 0x42, 0x00, 0x3f, 0xff, 0x6c,
      0x00, 0x07, 0x84, 0xed, 0x3f, 0x34, 0xd2, 0x05, 0x00, 0x00, 0x00, 0x04, 0x00, 0xe2, 0x00,
      0x00, 0xf3, 0x78, 0xf3, 0xef};
  rlpc_decoder* one;
  CHECK(rlpc_decoder_open_memory(one_vertex, sizeof one_vertex, NULL, &one) == RLPC_OK);
  const size_t strides[] = {12, SIZE_MAX / 2, SIZE_MAX - 12};
  for (size_t i = 0; i < sizeof strides / sizeof *strides; ++i) {
    float xyz[4] = {0, 0, 0, 77};
    rlpc_frame_output wanted;
    rlpc_frame_output_init(&wanted, sizeof wanted);
    wanted.positions.data = xyz;
    wanted.positions.num_bytes = 12;
    wanted.positions.stride = strides[i];
    wanted.positions.format = RLPC_FORMAT_FLOAT;
    CHECK(rlpc_decoder_frame(one, 0, &wanted) == RLPC_OK);
    CHECK(xyz[3] == 77);
  }
  rlpc_decoder_close(one);
}

int main(void) {
  encode();
  CHECK(rlpc_decoder_open_memory(encoded, encoded_size, NULL, &decoder) == RLPC_OK);
  float min[3], max[3];
  CHECK(rlpc_decoder_bounds(decoder, min, max) == RLPC_BAD_ARGUMENT);
  test_positions();
  test_normals();
  test_refusals();
  test_indices();
  CHECK(rlpc_decoder_prefetch(decoder, 0) == RLPC_OK);
  test_descriptions();
  test_one_vertex();
  rlpc_decoder_close(decoder);
  if (failures == 0) puts("frames have the forms that are asked for");
  return failures == 0 ? 0 : 1;
}
