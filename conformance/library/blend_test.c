// Tests positions, normals and bounds between two frames in the library in C against values
// computed from the frames. C99.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/testing/c_testing.h"
#include "decoder/c_api/rlpc_c_decoder.h"
#include "encoder/c_api/rlpc_c_encoder.h"

#define SIDE 9
#define VERTICES (SIDE * SIDE)
#define VALUES (3 * VERTICES)
#define TRIANGLES (2 * (SIDE - 1) * (SIDE - 1))
#define FRAMES 24

static size_t reads;  // reads of the stream by the decoder

// A sheet that waves.
static void make_frame(int frame, float* xyz) {
  for (int v = 0; v < VERTICES; ++v) {
    const double x = (double)(v % SIDE) / SIDE;
    const double y = (double)(v / SIDE) / SIDE;
    xyz[3 * v] = (float)x;
    xyz[3 * v + 1] = (float)(y + 0.02 * frame);
    xyz[3 * v + 2] = (float)(0.3 * sin(5 * x + 3 * y * y + 0.4 * frame));
  }
}

static void encode(void) {
  static uint32_t indices[3 * TRIANGLES];
  make_grid(SIDE, SIDE, 0, indices);
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = VERTICES;
  format.num_triangles = TRIANGLES;
  format.indices = indices;
  format.num_frames = FRAMES;
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.gof_frames = 8;
  options.target = RLPC_TARGET_MAX_ERROR;
  options.target_value = 1e-3;
  float xyz[VALUES];
  encode_frames(&format, &options, -1, 2, make_frame, xyz);
}

static int read_stream(void* user, uint64_t offset, void* out, size_t num_bytes) {
  (void)user;
  ++reads;
  memcpy(out, encoded + offset, num_bytes);
  return 0;
}

static rlpc_decoder* open_stream(void) {
  rlpc_source source;
  source.user = NULL;
  source.size = encoded_size;
  source.read = read_stream;
  rlpc_decoder* decoder;
  CHECK(rlpc_decoder_open_source(&source, NULL, &decoder) == RLPC_OK);
  return decoder;
}

// Positions and normals of each frame, from another handle.
static float positions[FRAMES][VALUES];
static float normals[FRAMES][VALUES];
static float mixed[VALUES];
static float mixed_normals[VALUES];

static rlpc_frame_output output_to(float* xyz, float* directions) {
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = VALUES * sizeof *xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;
  output.normals.data = directions;
  output.normals.num_bytes = VALUES * sizeof *directions;
  output.normals.format = RLPC_FORMAT_FLOAT;
  return output;
}

static void decode_all(void) {
  rlpc_decoder* decoder = open_stream();
  for (uint32_t f = 0; f < FRAMES; ++f) {
    const rlpc_frame_output output = output_to(positions[f], normals[f]);
    CHECK(rlpc_decoder_frame(decoder, f, &output) == RLPC_OK);
  }
  rlpc_decoder_close(decoder);
}

static rlpc_status blend_of(rlpc_decoder* decoder, uint32_t first, uint32_t second,
                            double weight, const rlpc_frame_output* output) {
  rlpc_blend blend;
  rlpc_blend_init(&blend, sizeof blend);
  blend.first_frame = first;
  blend.second_frame = second;
  blend.weight = weight;
  return rlpc_decoder_blend(decoder, &blend, output);
}

static void check_blend(rlpc_decoder* decoder, uint32_t first, uint32_t second, double weight) {
  const rlpc_frame_output output = output_to(mixed, mixed_normals);
  CHECK(blend_of(decoder, first, second, weight, &output) == RLPC_OK);
  float min[3], max[3];
  CHECK(rlpc_decoder_bounds(decoder, min, max) == RLPC_OK);
  float low[3] = {HUGE_VALF, HUGE_VALF, HUGE_VALF};
  float high[3] = {-HUGE_VALF, -HUGE_VALF, -HUGE_VALF};
  for (int i = 0; i < VALUES; ++i) {
    const double wanted =
        (1 - weight) * (double)positions[first][i] + weight * (double)positions[second][i];
    CHECK(fabs((double)mixed[i] - wanted) <= 4e-7);
    low[i % 3] = fminf(low[i % 3], mixed[i]);
    high[i % 3] = fmaxf(high[i % 3], mixed[i]);
  }
  CHECK(memcmp(low, min, sizeof low) == 0 && memcmp(high, max, sizeof high) == 0);
  for (int v = 0; v < VERTICES; ++v) {
    double sum[3], length = 0, apart = 0;
    for (int c = 0; c < 3; ++c) {
      sum[c] = (1 - weight) * (double)normals[first][3 * v + c] +
               weight * (double)normals[second][3 * v + c];
      length += sum[c] * sum[c];
    }
    for (int c = 0; c < 3; ++c) {
      apart += fabs((double)mixed_normals[3 * v + c] - sum[c] / sqrt(length));
    }
    CHECK(apart < 1e-5);
  }
}

static uint32_t state = 1;
static uint32_t below(uint32_t n) {
  state = state * 1664525U + 1013904223U;
  return (uint32_t)(((uint64_t)state * n) >> 32);
}

static void test_random_blends(void) {
  rlpc_decoder* decoder = open_stream();
  for (int i = 0; i < 300; ++i) {
    const uint32_t first = below(FRAMES);
    const uint32_t second = below(2) == 0 ? below(FRAMES) : (first + 1) % FRAMES;
    check_blend(decoder, first, second, (double)below(1000) / 999);
  }
  rlpc_decoder_close(decoder);
}

static void test_exact_at_frames(void) {
  rlpc_decoder* decoder = open_stream();
  const rlpc_frame_output output = output_to(mixed, mixed_normals);
  for (uint32_t f = 0; f + 1 < FRAMES; ++f) {
    CHECK(blend_of(decoder, f, f + 1, 0, &output) == RLPC_OK);
    CHECK(memcmp(mixed, positions[f], sizeof mixed) == 0);
    CHECK(memcmp(mixed_normals, normals[f], sizeof mixed_normals) == 0);
    CHECK(blend_of(decoder, f, f + 1, 1, &output) == RLPC_OK);
    CHECK(memcmp(mixed, positions[f + 1], sizeof mixed) == 0);
    CHECK(blend_of(decoder, f, f, 0.3, &output) == RLPC_OK);
    CHECK(memcmp(mixed, positions[f], sizeof mixed) == 0);
  }
  // Frames by themselves have not changed.
  CHECK(rlpc_decoder_frame(decoder, 7, &output) == RLPC_OK);
  CHECK(memcmp(mixed, positions[7], sizeof mixed) == 0);
  rlpc_decoder_close(decoder);
}

// Four pictures for each frame take no more reading than the frames do.
static void test_frames_are_decoded_once(void) {
  size_t taken[2];
  for (int pictures = 1; pictures <= 4; pictures += 3) {
    rlpc_decode_options options;
    rlpc_decode_options_init(&options, sizeof options);
    options.max_cached_bytes = 0;
    rlpc_source source;
    source.user = NULL;
    source.size = encoded_size;
    source.read = read_stream;
    rlpc_decoder* decoder;
    CHECK(rlpc_decoder_open_source(&source, &options, &decoder) == RLPC_OK);
    reads = 0;
    const rlpc_frame_output output = output_to(mixed, mixed_normals);
    for (uint32_t i = 0; i < (FRAMES - 1) * (uint32_t)pictures; ++i) {
      const uint32_t first = i / (uint32_t)pictures;
      const double weight = (double)(i % (uint32_t)pictures) / pictures;
      CHECK(blend_of(decoder, first, first + 1, weight, &output) == RLPC_OK);
    }
    taken[pictures / 4] = reads;
    rlpc_decoder_close(decoder);
  }
  CHECK(taken[0] > 0 && taken[1] <= taken[0] + 2);
}

static void test_formats(void) {
  rlpc_decoder* decoder = open_stream();
  double scale[3], offset[3];
  CHECK(rlpc_decoder_int16_scale(decoder, scale, offset) == RLPC_OK);
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  int16_t shorts[VALUES];
  signed char bytes[VALUES];
  output.positions.data = shorts;
  output.positions.num_bytes = sizeof shorts;
  output.positions.format = RLPC_FORMAT_INT16;
  output.normals.data = bytes;
  output.normals.num_bytes = sizeof bytes;
  output.normals.format = RLPC_FORMAT_INT8;
  CHECK(blend_of(decoder, 3, 4, 0.25, &output) == RLPC_OK);
  for (int i = 0; i < VALUES; ++i) {
    const double wanted = 0.75 * (double)positions[3][i] + 0.25 * (double)positions[4][i];
    CHECK(fabs(shorts[i] * scale[i % 3] + offset[i % 3] - wanted) <= 0.51 * scale[i % 3]);
  }
  for (int v = 0; v < VERTICES; ++v) {
    double sum[3], squares = 0;
    for (int c = 0; c < 3; ++c) {
      const int i = 3 * v + c;
      sum[c] = 0.75 * (double)normals[3][i] + 0.25 * (double)normals[4][i];
      squares += sum[c] * sum[c];
    }
    for (int c = 0; c < 3; ++c) {
      CHECK(fabs(bytes[3 * v + c] - 127 * sum[c] / sqrt(squares)) < 0.51);
    }
  }
  output.positions.format = RLPC_FORMAT_HALF;
  CHECK(blend_of(decoder, 3, 4, 0.25, &output) == RLPC_OK);
  output.positions.format = RLPC_FORMAT_INT32;
  output.positions.num_bytes = SIZE_MAX;
  CHECK(blend_of(decoder, 3, 4, 0.25, &output) == RLPC_BAD_ARGUMENT);
  CHECK(strstr(rlpc_decoder_error_text(decoder), "no integers") != NULL);
  rlpc_decoder_close(decoder);
}

static void test_refusals(void) {
  rlpc_decoder* decoder = open_stream();
  const rlpc_frame_output output = output_to(mixed, mixed_normals);
  CHECK(blend_of(decoder, 0, FRAMES, 0.5, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(decoder, FRAMES, 0, 0.5, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(decoder, 0, 1, 1.0001, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(decoder, 0, 1, -0.1, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(decoder, 0, 1, NAN, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(decoder, 0, 1, 0.5, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_blend(decoder, NULL, &output) == RLPC_BAD_ARGUMENT);
  CHECK(blend_of(NULL, 0, 1, 0.5, &output) == RLPC_BAD_ARGUMENT);
  rlpc_blend later[2];
  rlpc_blend_init(later, sizeof later);
  CHECK(rlpc_decoder_blend(decoder, later, &output) == RLPC_OK);
  later[1].weight = 0.5;  // a member that this version does not know
  CHECK(rlpc_decoder_blend(decoder, later, &output) == RLPC_BAD_ARGUMENT);
  rlpc_decoder_close(decoder);
}

int main(void) {
  encode();
  decode_all();
  test_random_blends();
  test_exact_at_frames();
  test_frames_are_decoded_once();
  test_formats();
  test_refusals();
  if (failures == 0) puts("between frames, there is their mix");
  return failures == 0 ? 0 : 1;
}
