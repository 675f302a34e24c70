// Tests the library as programs in C use it: every function, and its errors. C99.
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/testing/c_testing.h"
#include "decoder/c_api/rlpc_c_decoder.h"
#include "encoder/c_api/rlpc_c_encoder.h"

#define VERTICES 12
#define VALUES (3 * VERTICES)
#define TRIANGLES 10
#define FRAMES 20

#define CHECK_TEXT(text, part)                                                     \
  do {                                                                             \
    if (strstr(text, part) == NULL) {                                              \
      fprintf(stderr, "%s:%d: no `%s` in `%s`\n", __FILE__, __LINE__, part, text); \
      ++failures;                                                                  \
    }                                                                              \
  } while (0)

typedef struct buffer {
  unsigned char bytes[1 << 16];
  size_t size;
  size_t allowed;  // number of writes; 0: all
  size_t writes;
} buffer;

static int append(void* user, const void* bytes, size_t num_bytes) {
  buffer* to = user;
  if (++to->writes == to->allowed || num_bytes > sizeof to->bytes - to->size) return 1;
  memcpy(to->bytes + to->size, bytes, num_bytes);
  to->size += num_bytes;
  return 0;
}

// A strip that waves.
static void make_frame(unsigned frame, float* xyz) {
  for (unsigned v = 0; v < VERTICES; ++v) {
    const double x = 0.1 * (v / 2);
    xyz[3 * v] = (float)x;
    xyz[3 * v + 1] = (float)(0.3 * (v % 2));
    xyz[3 * v + 2] = (float)(0.2 * sin(0.4 * frame + 5.0 * x));
  }
}

static const uint32_t* strip(void) {
  static uint32_t indices[3 * TRIANGLES];
  for (uint32_t t = 0; t < TRIANGLES; ++t) {
    indices[3 * t] = t;
    indices[3 * t + 1] = t + 1 + t % 2;
    indices[3 * t + 2] = t + 2 - t % 2;
  }
  return indices;
}

static rlpc_frame_format strip_format(void) {
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = VERTICES;
  format.num_triangles = TRIANGLES;
  format.indices = strip();
  format.num_frames = FRAMES;
  format.box_max[0] = format.box_max[1] = 0.6F;
  format.box_min[2] = -0.25F;
  format.box_max[2] = 0.25F;
  return format;
}

static rlpc_encode_options small_gofs(void) {
  static const rlpc_clip clips[2] = {{"wave", 0, 8}, {"rest", 4, FRAMES - 4}};
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.target = RLPC_TARGET_MAX_ERROR;
  options.target_value = 0.002;
  options.gof_frames = 8;
  options.keep_order = 1;
  options.metadata = "{\"title\":\"strip\"}";
  options.clips = clips;
  options.num_clips = 2;
  return options;
}

static rlpc_status add_frames(rlpc_encoder* encoder) {
  rlpc_status status = RLPC_OK;
  float xyz[VALUES];
  for (unsigned f = 0; status == RLPC_OK && f < FRAMES; ++f) {
    make_frame(f, xyz);
    status = rlpc_encoder_add_frame(encoder, xyz, VALUES);
  }
  return status;
}

static void encode_strip(buffer* stream) {
  const rlpc_frame_format format = strip_format();
  const rlpc_encode_options options = small_gofs();
  rlpc_encoder* encoder;
  memset(stream, 0, sizeof *stream);
  CHECK(rlpc_encoder_create(&format, &options, append, stream, &encoder) == RLPC_OK);
  uint32_t order[VERTICES];
  CHECK(rlpc_encoder_vertex_order(encoder, order, VERTICES) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "not finished");
  CHECK(add_frames(encoder) == RLPC_OK);
  rlpc_encode_report report;
  CHECK(rlpc_encoder_finish(encoder, &report, sizeof report) == RLPC_OK);
  CHECK(report.struct_size == sizeof report);
  CHECK(report.num_bytes == stream->size);
  CHECK(fabs(report.bpvf - 8.0 * (double)stream->size / (VERTICES * FRAMES)) < 1e-9);
  CHECK(report.num_gofs == 3 && report.level == 1 && report.target_met == 1);
  CHECK(report.max_error <= 0.002 && report.rms_error > 0 && report.kg_error_percent > 0);

  CHECK(rlpc_encoder_vertex_order(encoder, order, VERTICES) == RLPC_OK);
  unsigned seen = 0;
  for (unsigned v = 0; v < VERTICES; ++v) seen |= 1U << order[v];
  CHECK(seen == (1U << VERTICES) - 1);
  CHECK(rlpc_encoder_vertex_order(encoder, order, VERTICES - 1) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_encoder_vertex_order(encoder, NULL, VERTICES) == RLPC_BAD_ARGUMENT);
  rlpc_encoder_close(encoder);
}

// Frames are 1/30 s apart; "wave" has frames 0 to 7, "rest" those from 4 on. Both ends are
// frames.
static void test_clip_times(rlpc_decoder* decoder) {
  rlpc_clip rest;
  CHECK(rlpc_decoder_find_clip(decoder, "rest", &rest) == RLPC_OK);
  CHECK(strcmp(rest.name, "rest") == 0 && rest.first_frame == 4);
  CHECK(rlpc_decoder_find_clip(decoder, "res", &rest) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "no clip has this name");
  CHECK(rlpc_decoder_find_clip(decoder, NULL, &rest) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_find_clip(decoder, "rest", NULL) == RLPC_BAD_ARGUMENT);

  double seconds = 0.0;
  CHECK(rlpc_decoder_duration(decoder, NULL, &seconds) == RLPC_OK);
  CHECK(fabs(seconds - (FRAMES - 1) / 30.0) < 1e-12);
  CHECK(rlpc_decoder_duration(decoder, &rest, &seconds) == RLPC_OK);
  CHECK(fabs(seconds - (FRAMES - 5) / 30.0) < 1e-12);
  const rlpc_clip beyond = {"", FRAMES - 2, 100};  // a stream of unknown length may claim this
  CHECK(rlpc_decoder_duration(decoder, &beyond, &seconds) == RLPC_OK);
  CHECK(fabs(seconds - 1 / 30.0) < 1e-12);
  const rlpc_clip wrong[2] = {{"", FRAMES, 1}, {"", 0, 0}};
  for (int i = 0; i < 2; ++i) {
    CHECK(rlpc_decoder_duration(decoder, &wrong[i], &seconds) == RLPC_BAD_ARGUMENT);
  }
  CHECK(rlpc_decoder_duration(decoder, NULL, NULL) == RLPC_BAD_ARGUMENT);

  // Each turn of "wave" takes 7 intervals.
  const rlpc_clip wave = {"wave", 0, 8};
  uint32_t frame = 99;
  double place = 0.0;
  for (int k = 0; k < 100; ++k) {
    CHECK(rlpc_decoder_frame_at(decoder, &wave, (k + 0.25) / 30.0, 1, &frame, &place) ==
          RLPC_OK);
    CHECK(frame == (uint32_t)(k % 7) && fabs(place - (k % 7 + 0.25)) < 1e-9);
    CHECK(rlpc_decoder_frame_at(decoder, &rest, (k + 0.75) / 30.0, 0, &frame, NULL) == RLPC_OK);
    CHECK(frame == (uint32_t)(k + 5 < FRAMES - 1 ? k + 5 : FRAMES - 1));
  }
  CHECK(rlpc_decoder_frame_at(decoder, &wave, 7 / 30.0, 0, &frame, &place) == RLPC_OK);
  CHECK(frame == 7 && place == 7.0);
  CHECK(rlpc_decoder_frame_at(decoder, &rest, -1.0, 1, &frame, &place) == RLPC_OK);
  CHECK(frame == 4 && place == 4.0);
  CHECK(rlpc_decoder_frame_at(decoder, NULL, 0.0, 2, &frame, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_frame_at(decoder, NULL, NAN, 0, &frame, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_frame_at(decoder, NULL, 0.0, 0, NULL, NULL) == RLPC_BAD_ARGUMENT);
}

static void check_info(rlpc_decoder* decoder) {
  rlpc_stream_info info;
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  CHECK(info.struct_size == sizeof info && info.profile == RLPC_PROFILE_MAIN &&
        info.level == 1);
  CHECK(info.num_vertices == VERTICES && info.num_triangles == TRIANGLES);
  CHECK(info.num_frames == FRAMES && info.has_vertex_order == 1);
  CHECK(info.frame_rate_numerator == 30 && info.frame_rate_denominator == 1);
  CHECK(info.position_bits >= 20 && info.position_bits <= 24);
  // A caller with an older, shorter structure gets the members it knows.
  struct {
    size_t struct_size;
    uint32_t profile;
    uint32_t guard;
  } older = {0, 99, 99};
  CHECK(rlpc_decoder_info(decoder, (rlpc_stream_info*)(void*)&older,
                          offsetof(rlpc_stream_info, level)) == RLPC_OK);
  CHECK(older.profile == RLPC_PROFILE_MAIN && older.guard == 99);
  CHECK(rlpc_decoder_info(decoder, NULL, sizeof info) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_info(decoder, &info, 0) == RLPC_BAD_ARGUMENT);

  uint32_t indices[3 * TRIANGLES];
  CHECK(rlpc_decoder_triangles(decoder, indices, 3 * TRIANGLES) == RLPC_OK);
  for (unsigned i = 0; i < 3 * TRIANGLES; ++i) CHECK(indices[i] < VERTICES);
  CHECK(rlpc_decoder_triangles(decoder, indices, TRIANGLES) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "10 values, not 30");
  CHECK(rlpc_decoder_triangles(decoder, NULL, 3 * TRIANGLES) == RLPC_BAD_ARGUMENT);
  CHECK(strcmp(rlpc_decoder_metadata(decoder), "{\"title\":\"strip\"}") == 0);

  CHECK(rlpc_decoder_num_clips(decoder) == 2);
  rlpc_clip clip;
  CHECK(rlpc_decoder_clip(decoder, 1, &clip) == RLPC_OK);
  CHECK(strcmp(clip.name, "rest") == 0);
  CHECK(clip.first_frame == 4 && clip.num_frames == FRAMES - 4);
  CHECK(rlpc_decoder_clip(decoder, 2, &clip) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "expected a clip below 2, got 2");
  CHECK(rlpc_decoder_clip(decoder, 0, NULL) == RLPC_BAD_ARGUMENT);
  test_clip_times(decoder);
}

// Frames as floats in order, then as positions from the last to the first.
static void check_frames(rlpc_decoder* decoder) {
  float xyz[VALUES];
  float original[VALUES];
  static int32_t positions[VALUES];
  rlpc_stream_info info;
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  for (unsigned f = 0; f < FRAMES; ++f) {
    CHECK(rlpc_decoder_position(decoder) == f);
    CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_OK);
    make_frame(f, original);
    for (unsigned i = 0; i < VALUES; ++i) CHECK(fabs(xyz[i] - original[i]) <= 0.002);
  }
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_END);
  CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES) == RLPC_END);
  CHECK(rlpc_decoder_position(decoder) == FRAMES);
  for (unsigned f = FRAMES; f-- > 0;) {
    CHECK(rlpc_decoder_seek(decoder, f) == RLPC_OK);
    CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES) == RLPC_OK);
    make_frame(f, original);
    for (unsigned i = 0; i < VALUES; ++i) {
      const double value =
          ldexp(positions[i] + (double)info.grid_origin[i % 3], info.grid_log2_step);
      CHECK(fabs(value - original[i]) <= 0.0021);
    }
  }
  CHECK(rlpc_decoder_seek(decoder, FRAMES) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "no frame 20 of 20");
  CHECK(rlpc_decoder_next_positions(decoder, NULL, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES - 1) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next_floats(decoder, NULL, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES + 3) == RLPC_BAD_ARGUMENT);
  // None of these calls has moved the decoder.
  CHECK(rlpc_decoder_position(decoder) == 1);
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_OK);
  CHECK(rlpc_decoder_error_text(decoder)[0] == '\0');
}

typedef struct read_state {
  const buffer* stream;
  int fails;
} read_state;

static int read_buffer(void* user, uint64_t offset, void* out, size_t num_bytes) {
  const read_state* state = user;
  if (state->fails) return -1;
  if (offset + num_bytes > state->stream->size)
    abort();  // the decoder promises never to ask for this
  memcpy(out, state->stream->bytes + offset, num_bytes);
  return 0;
}

static void test_sources(const buffer* stream) {
  rlpc_decoder* decoder;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, NULL, &decoder) == RLPC_OK);
  CHECK(rlpc_decoder_error_text(decoder)[0] == '\0');
  check_info(decoder);
  check_frames(decoder);
  rlpc_decoder_close(decoder);

  read_state state = {stream, 0};
  const rlpc_source source = {&state, stream->size, read_buffer};
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.max_cached_bytes = 0;  // else GOFs are read once
  CHECK(rlpc_decoder_open_source(&source, &options, &decoder) == RLPC_OK);
  check_frames(decoder);
  // A callback that fails, then works again.
  float xyz[VALUES];
  state.fails = 1;
  CHECK(rlpc_decoder_seek(decoder, 19) == RLPC_IO_FAILED);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "cannot read");
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_IO_FAILED);
  state.fails = 0;
  CHECK(rlpc_decoder_seek(decoder, 19) == RLPC_OK);
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_OK);
  rlpc_decoder_close(decoder);

  const char* path = "c_api_test.rlpc";
  FILE* file = fopen(path, "wb");
  CHECK(file != NULL && fwrite(stream->bytes, 1, stream->size, file) == stream->size);
  CHECK(file != NULL && fclose(file) == 0);
  CHECK(rlpc_decoder_open_file(path, NULL, &decoder) == RLPC_OK);
  check_frames(decoder);
  rlpc_decoder_close(decoder);
  remove(path);
}

static void test_options(const buffer* stream) {
  rlpc_decode_options options;
  rlpc_decoder* decoder;
  rlpc_decode_options_init(&options, sizeof options);
  CHECK(options.struct_size == sizeof options && options.threads == 1);
  CHECK(options.verify_hashes == 1 && options.max_components == RLPC_ALL);
  CHECK(options.max_layers == RLPC_ALL && options.max_temporal_layers == RLPC_ALL);

  options.threads = 3;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) == RLPC_OK);
  check_frames(decoder);
  rlpc_decoder_close(decoder);
  options.threads = 256;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) == RLPC_OK);
  rlpc_decoder_close(decoder);
  for (uint32_t threads = 0; threads <= 257; threads += 257) {
    options.threads = threads;
    CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) ==
          RLPC_BAD_ARGUMENT);
    CHECK_TEXT(rlpc_decoder_error_text(decoder), "is not in the range of 1 to 256");
    rlpc_decoder_close(decoder);
  }
  options.threads = 1;

  options.max_vertices = VERTICES - 1;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) ==
        RLPC_LIMIT_EXCEEDED);
  CHECK_TEXT(rlpc_decoder_error_text(decoder),
             "num_vertices_minus1: more vertices than the limit");
  rlpc_decoder_close(decoder);
  options.max_vertices = VERTICES;

  // An endless device, whose first bytes show that it is not a stream.
  CHECK(rlpc_decoder_open_file("/dev/zero", &options, &decoder) == RLPC_BAD_STREAM);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "R-STR-01");
  rlpc_decoder_close(decoder);

  // The handle is in the caller's buffer, if that is large enough.
  void* place = malloc(rlpc_decoder_bytes());
  options.place = place;
  options.place_bytes = rlpc_decoder_bytes() - 1;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) ==
        RLPC_BAD_ARGUMENT);
  CHECK(decoder == NULL);
  options.place_bytes = rlpc_decoder_bytes();
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) == RLPC_OK);
  CHECK((void*)decoder == place);
  check_frames(decoder);
  rlpc_decoder_close(decoder);
  free(place);

  // Options that are not initialised, or of a newer version with its new members unset and set.
  struct {
    rlpc_decode_options options;
    uint64_t future;
  } newer;
  memset(&newer, 0, sizeof newer);
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &newer.options, &decoder) ==
        RLPC_BAD_ARGUMENT);
  rlpc_decode_options_init(&newer.options, sizeof newer);
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &newer.options, &decoder) ==
        RLPC_OK);
  rlpc_decoder_close(decoder);
  newer.future = 1;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &newer.options, &decoder) ==
        RLPC_BAD_ARGUMENT);
}

// A stream cut off anywhere, or with any byte changed, gives an error and does no harm.
static void test_damage(const buffer* stream) {
  static buffer damaged;
  int32_t positions[VALUES];
  for (size_t size = 0; size < stream->size; size += 1 + size / 16) {
    rlpc_decoder* decoder;
    rlpc_status status = rlpc_decoder_open_memory(stream->bytes, size, NULL, &decoder);
    while (status == RLPC_OK) {
      status = rlpc_decoder_next_positions(decoder, positions, VALUES);
    }
    CHECK(status == RLPC_BAD_STREAM);
    CHECK_TEXT(rlpc_decoder_error_text(decoder), "bit ");
    rlpc_decoder_close(decoder);
  }
  for (size_t at = 10; at < stream->size; at += 7) {
    rlpc_decoder* decoder;
    damaged = *stream;
    damaged.bytes[at] ^= 0x20;
    rlpc_status status = rlpc_decoder_open_memory(damaged.bytes, damaged.size, NULL, &decoder);
    while (status == RLPC_OK) {
      status = rlpc_decoder_next_positions(decoder, positions, VALUES);
    }
    CHECK(status == RLPC_BAD_STREAM || status == RLPC_UNSUPPORTED);
    // A stream that could not be opened stays closed.
    if (rlpc_decoder_position(decoder) == 0) {
      CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES) == status);
    }
    rlpc_decoder_close(decoder);
  }
}

static void test_null_decoders(const buffer* stream) {
  rlpc_decoder* decoder = NULL;
  const rlpc_source no_read = {NULL, 1, NULL};
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, NULL, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_memory(NULL, 1, NULL, &decoder) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_file(NULL, NULL, &decoder) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_file("x", NULL, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_source(NULL, NULL, &decoder) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_source(&no_read, NULL, &decoder) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_open_source(&no_read, NULL, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(decoder == NULL);
  CHECK(rlpc_decoder_open_file("no/such/file", NULL, &decoder) == RLPC_IO_FAILED);
  CHECK_TEXT(rlpc_decoder_error_text(decoder), "no such file");
  CHECK(rlpc_decoder_seek(decoder, 0) == RLPC_IO_FAILED);
  CHECK(rlpc_decoder_position(decoder) == 0 && rlpc_decoder_metadata(decoder)[0] == '\0');
  rlpc_decoder_close(decoder);

  rlpc_stream_info info;
  float xyz[VALUES];
  int32_t positions[VALUES];
  uint32_t indices[3 * TRIANGLES];
  CHECK(rlpc_decoder_info(NULL, &info, sizeof info) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_triangles(NULL, indices, 3 * TRIANGLES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next_floats(NULL, xyz, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_next_positions(NULL, positions, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_seek(NULL, 0) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_position(NULL) == 0 && rlpc_decoder_metadata(NULL)[0] == '\0');
  CHECK_TEXT(rlpc_decoder_error_text(NULL), "no decoder");
  rlpc_decode_options_init(NULL, 100);
  rlpc_decoder_close(NULL);
}

static rlpc_status create_with(const rlpc_frame_format* format,
                               const rlpc_encode_options* options, char* text) {
  static buffer ignored;
  rlpc_encoder* encoder = NULL;
  const rlpc_status status = rlpc_encoder_create(format, options, append, &ignored, &encoder);
  snprintf(text, 256, "%s", rlpc_encoder_error_text(encoder));
  if (encoder != NULL && status != RLPC_OK) {
    float xyz[VALUES] = {0};
    CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == status);
    CHECK(rlpc_encoder_finish(encoder, NULL, 0) == status);
  }
  rlpc_encoder_close(encoder);
  return status;
}

static void test_encoder_arguments(void) {
  char text[256];
  rlpc_frame_format format = strip_format();
  rlpc_encode_options options = small_gofs();
  CHECK(create_with(NULL, NULL, text) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(text, "no encoder");
  CHECK(create_with(&format, NULL, text) == RLPC_OK);
  CHECK(rlpc_encoder_create(&format, NULL, append, NULL, NULL) == RLPC_BAD_ARGUMENT);
  rlpc_encoder* encoder;
  CHECK(rlpc_encoder_create(&format, NULL, NULL, NULL, &encoder) == RLPC_BAD_ARGUMENT);

  format.indices = NULL;
  CHECK(create_with(&format, NULL, text) == RLPC_BAD_ARGUMENT);
  format = strip_format();
  format.num_vertices = VERTICES - 1;
  CHECK(create_with(&format, NULL, text) == RLPC_BAD_INPUT);
  CHECK_TEXT(text, "vertex 11 of 11");
  format = strip_format();
  format.struct_size = 0;
  CHECK(create_with(&format, NULL, text) == RLPC_BAD_ARGUMENT);
  format = strip_format();

  options.target_value = -1;
  CHECK(create_with(&format, &options, text) == RLPC_BAD_INPUT);
  CHECK_TEXT(text, "above zero");
  options = small_gofs();
  options.max_normals = 1;
  CHECK(create_with(&format, &options, text) == RLPC_BAD_INPUT);
  CHECK_TEXT(text, "vertex normals are bounded only with 'target = kg'");
  for (int i = 0; i < 6; ++i) {
    options = small_gofs();
    uint32_t* const choices[6] = {&options.profile,   &options.preset,   &options.target,
                                  &options.hash_mode, &options.gof_kind, &options.low_delay};
    *choices[i] = 5;
    CHECK(create_with(&format, &options, text) == RLPC_BAD_ARGUMENT);
    CHECK_TEXT(text, "unknown value");
  }
  options = small_gofs();
  options.max_memory_bytes = 1 << 20;
  CHECK(create_with(&format, &options, text) == RLPC_LIMIT_EXCEEDED);
  CHECK_TEXT(text, "the limit is 1 MiB");
  for (uint32_t threads = 0; threads <= 257; threads += 257) {
    options = small_gofs();
    options.threads = threads;
    CHECK(create_with(&format, &options, text) == RLPC_BAD_ARGUMENT);
    CHECK_TEXT(text, "is not in the range of 1 to 256");
  }
  options = small_gofs();
  options.profile = RLPC_PROFILE_BASELINE;
  options.preset = RLPC_PRESET_FAST;
  options.target = RLPC_TARGET_BPVF;
  options.hash_mode = RLPC_HASH_MODE_NONE;
  CHECK(create_with(&format, &options, text) == RLPC_OK);

  uint32_t order[VERTICES];
  float xyz[VALUES] = {0};
  CHECK(rlpc_encoder_add_frame(NULL, xyz, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_encoder_finish(NULL, NULL, 0) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_encoder_vertex_order(NULL, order, VERTICES) == RLPC_BAD_ARGUMENT);
  rlpc_encode_options_init(NULL, 100);
  rlpc_frame_format_init(NULL, 100);
  rlpc_encoder_close(NULL);
}

static void test_encoder_frames(void) {
  static buffer stream;
  const rlpc_frame_format format = strip_format();
  rlpc_encode_options options = small_gofs();
  void* place = malloc(rlpc_encoder_bytes());
  options.place = place;
  options.place_bytes = rlpc_encoder_bytes();
  rlpc_encoder* encoder;
  float xyz[VALUES];
  make_frame(0, xyz);

  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_OK);
  CHECK((void*)encoder == place);
  CHECK(rlpc_encoder_add_frame(encoder, NULL, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_encoder_add_frame(encoder, xyz, VERTICES) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "12 values, not 36");
  CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_OK);
  CHECK(rlpc_encoder_finish(encoder, NULL, 0) == RLPC_BAD_INPUT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "after 1 of 20 frames");
  rlpc_encoder_close(encoder);

  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_OK);
  xyz[4] = 7;
  CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_BAD_INPUT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "frame 0 (from 0), vertex 1: y is 7");
  xyz[4] = 0;
  CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_BAD_INPUT);
  rlpc_encoder_close(encoder);
  free(place);

  memset(&stream, 0, sizeof stream);
  stream.allowed = 3;
  CHECK(rlpc_encoder_create(&format, NULL, append, &stream, &encoder) == RLPC_OK);
  CHECK(add_frames(encoder) == RLPC_IO_FAILED);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "could not be written");
  CHECK(rlpc_encoder_finish(encoder, NULL, 0) == RLPC_IO_FAILED);
  CHECK(stream.writes == 3);
  rlpc_encoder_close(encoder);
}

// Temporal layers: the report of a cut, and a decoder that makes it.
static void test_temporal_layers(void) {
  static buffer stream;
  const rlpc_frame_format format = strip_format();
  rlpc_encode_options options = small_gofs();
  CHECK(options.temporal_layers == 1);
  options.profile = RLPC_PROFILE_HIGH;
  options.temporal_layers = 3;
  rlpc_encoder* encoder;
  memset(&stream, 0, sizeof stream);
  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_OK);
  CHECK(add_frames(encoder) == RLPC_OK);
  rlpc_encode_report report;
  CHECK(rlpc_encoder_finish(encoder, &report, sizeof report) == RLPC_OK);
  rlpc_encoder_close(encoder);
  CHECK(report.temporal_cut_bytes[0] > 0);
  CHECK(report.temporal_cut_bytes[0] < report.temporal_cut_bytes[1]);
  CHECK(report.temporal_cut_bytes[1] < report.num_bytes && report.temporal_cut_bytes[2] == 0);
  CHECK(report.temporal_cut_kg_error_percent[0] >= report.temporal_cut_kg_error_percent[1]);
  CHECK(report.temporal_cut_kg_error_percent[1] >= report.kg_error_percent);

  rlpc_decode_options decoding;
  rlpc_decode_options_init(&decoding, sizeof decoding);
  decoding.max_temporal_layers = 1;
  rlpc_decoder* decoder;
  CHECK(rlpc_decoder_open_memory(stream.bytes, stream.size, &decoding, &decoder) == RLPC_OK);
  int32_t positions[VALUES];
  for (unsigned f = 0; f < FRAMES; ++f) {
    CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES) == RLPC_OK);
  }
  CHECK(rlpc_decoder_next_positions(decoder, positions, VALUES) == RLPC_END);
  rlpc_decoder_close(decoder);

  options.temporal_layers = RLPC_MAX_TEMPORAL_LAYERS + 1;
  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_BAD_INPUT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "temporal layers");
  rlpc_encoder_close(encoder);
}

// With a bound of vertex normals, the KG error follows from it.
static void test_normals(void) {
  static buffer stream;
  const rlpc_frame_format format = strip_format();
  double kg_before = 100;
  for (int i = 0; i < 2; ++i) {
    rlpc_encode_options options = small_gofs();
    options.target = RLPC_TARGET_KG;
    options.target_value = 100;
    options.max_normals = i == 0 ? 4 : 0.25;
    rlpc_encoder* encoder;
    memset(&stream, 0, sizeof stream);
    CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_OK);
    float xyz[VALUES];
    for (unsigned f = 0; f < FRAMES; ++f) {
      make_frame(f, xyz);
      CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_OK);
    }
    rlpc_encode_report report;
    CHECK(rlpc_encoder_finish(encoder, &report, sizeof report) == RLPC_OK);
    CHECK(report.target_met == 1);
    CHECK(report.kg_error_percent < kg_before / 4);
    kg_before = report.kg_error_percent;
    rlpc_encoder_close(encoder);
  }
}

// A frame is in the stream as soon as it has been added, and the number of frames at its end.
static void test_low_delay(void) {
  static buffer stream;
  rlpc_frame_format format = strip_format();
  format.num_frames = 0;
  rlpc_encode_options options = small_gofs();
  options.low_delay = 1;
  rlpc_encoder* encoder;
  memset(&stream, 0, sizeof stream);
  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_BAD_INPUT);
  CHECK_TEXT(rlpc_encoder_error_text(encoder), "needs 'profile = high'");
  rlpc_encoder_close(encoder);
  options.profile = RLPC_PROFILE_HIGH;
  options.gof_kind = RLPC_GOF_KIND_INTER;
  options.target = RLPC_TARGET_LOSSLESS;
  options.target_value = 12;
  CHECK(rlpc_encoder_create(&format, &options, append, &stream, &encoder) == RLPC_OK);
  float xyz[VALUES];
  size_t before = 0;
  for (unsigned f = 0; f < FRAMES; ++f) {
    make_frame(f, xyz);
    CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_OK);
    CHECK(stream.size > before);
    before = stream.size;
    xyz[4] = 7;
    CHECK(rlpc_encoder_add_frame(encoder, xyz, VALUES) == RLPC_BAD_INPUT);  // left out
    CHECK_TEXT(rlpc_encoder_error_text(encoder), "vertex 1: y is 7");
    CHECK(stream.size == before);
  }
  rlpc_encode_report report;
  CHECK(rlpc_encoder_finish(encoder, &report, sizeof report) == RLPC_OK);
  CHECK(report.num_gofs == (FRAMES + 7) / 8 && report.target_met == 1);
  rlpc_encoder_close(encoder);

  rlpc_decoder* decoder;
  CHECK(rlpc_decoder_open_memory(stream.bytes, stream.size, NULL, &decoder) == RLPC_OK);
  rlpc_stream_info info;
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  CHECK(info.num_frames == FRAMES);
  float decoded[VALUES];
  for (unsigned f = 0; f < FRAMES; ++f) {
    CHECK(rlpc_decoder_next_floats(decoder, decoded, VALUES) == RLPC_OK);
    make_frame(f, xyz);
    for (int i = 0; i < VALUES; ++i) CHECK(fabsf(decoded[i] - xyz[i]) <= 0.6F / 4095);
  }
  CHECK(rlpc_decoder_next_floats(decoder, decoded, VALUES) == RLPC_END);
  CHECK(rlpc_decoder_seek(decoder, FRAMES - 1) == RLPC_OK);
  CHECK(rlpc_decoder_next_floats(decoder, xyz, VALUES) == RLPC_OK);
  CHECK(memcmp(xyz, decoded, sizeof xyz) == 0);
  CHECK(rlpc_decoder_seek(decoder, FRAMES) == RLPC_BAD_ARGUMENT);
  rlpc_decoder_close(decoder);
}

static rlpc_decoder* open_coarse(const buffer* stream, uint32_t layers) {
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  CHECK(options.coarse_layers == RLPC_ALL);
  options.coarse_layers = layers;
  rlpc_decoder* decoder;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &decoder) == RLPC_OK);
  return decoder;
}

// The frames of a coarse mesh are those of the whole mesh at its vertices.
static void check_coarse_frames(const buffer* stream, rlpc_decoder* coarse,
                                const uint32_t* vertices, size_t num_vertices) {
  rlpc_decoder* whole = open_coarse(stream, RLPC_ALL);
  int32_t positions[VALUES];
  int32_t all[VALUES];
  CHECK(rlpc_decoder_next_positions(coarse, positions, 3 * num_vertices - 1) ==
        RLPC_BAD_ARGUMENT);
  for (unsigned f = 0; f < FRAMES; ++f) {
    CHECK(rlpc_decoder_next_positions(whole, all, VALUES) == RLPC_OK);
    CHECK(rlpc_decoder_next_positions(coarse, positions, 3 * num_vertices) == RLPC_OK);
    for (size_t i = 0; i < 3 * num_vertices; ++i) {
      CHECK(positions[i] == all[3 * vertices[i / 3] + i % 3]);
    }
  }
  CHECK(rlpc_decoder_next_positions(coarse, positions, 3 * num_vertices) == RLPC_END);
  CHECK(rlpc_decoder_seek(coarse, 0) == RLPC_OK);
  float xyz[VALUES];
  CHECK(rlpc_decoder_next_floats(coarse, xyz, 3 * num_vertices) == RLPC_OK);
  rlpc_decoder_close(whole);
}

static void test_coarse_meshes(const buffer* stream) {
  uint32_t vertices[VERTICES];
  uint32_t indices[3 * TRIANGLES];
  rlpc_stream_info info;
  uint32_t num_layers = 2;
  uint32_t before = 0;
  for (uint32_t layers = 1; layers <= num_layers; ++layers) {
    rlpc_decoder* decoder = open_coarse(stream, layers);
    CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
    num_layers = info.num_layers;
    CHECK(num_layers > 2 && info.num_vertices > before && info.num_vertices <= VERTICES);
    before = info.num_vertices;
    CHECK(rlpc_decoder_triangles(decoder, indices, 3 * info.num_triangles) == RLPC_OK);
    for (uint32_t i = 0; i < 3 * info.num_triangles; ++i) {
      CHECK(indices[i] < info.num_vertices);
    }
    CHECK(rlpc_decoder_coarse_vertices(decoder, vertices, info.num_vertices) == RLPC_OK);
    for (uint32_t v = 1; v < info.num_vertices; ++v) CHECK(vertices[v - 1] < vertices[v]);
    CHECK(rlpc_decoder_coarse_vertices(decoder, vertices, VERTICES + 1) == RLPC_BAD_ARGUMENT);
    check_coarse_frames(stream, decoder, vertices, info.num_vertices);
    rlpc_decoder_close(decoder);
  }
  CHECK(before == VERTICES && info.num_triangles == TRIANGLES);

  rlpc_decoder* whole = open_coarse(stream, RLPC_ALL);
  CHECK(rlpc_decoder_info(whole, &info, sizeof info) == RLPC_OK);
  CHECK(info.num_layers == num_layers && info.num_vertices == VERTICES);
  CHECK(rlpc_decoder_coarse_vertices(whole, vertices, VERTICES) == RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(whole), "coarse_layers is RLPC_ALL");
  rlpc_decoder_close(whole);
  CHECK(rlpc_decoder_coarse_vertices(NULL, vertices, VERTICES) == RLPC_BAD_ARGUMENT);

  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.coarse_layers = 0;
  rlpc_decoder* none;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &none) ==
        RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(none), "coarse_layers: 0 is not in the range");
  rlpc_decoder_close(none);
  options.coarse_layers = 1;
  options.max_temporal_layers = 0;
  CHECK(rlpc_decoder_open_memory(stream->bytes, stream->size, &options, &none) ==
        RLPC_BAD_ARGUMENT);
  CHECK_TEXT(rlpc_decoder_error_text(none), "max_temporal_layers: 0 is not in the range");
  rlpc_decoder_close(none);
}

static void test_texts(void) {
  for (int i = RLPC_OK; i <= RLPC_INTERNAL_ERROR; ++i) {
    CHECK(strcmp(rlpc_status_text(i), "unknown status") != 0);
  }
  CHECK(strcmp(rlpc_status_text(1000), "unknown status") == 0);
  CHECK(rlpc_version()[0] == '1' && rlpc_version()[1] == '.');
}

int main(void) {
  static buffer stream;
  encode_strip(&stream);
  test_sources(&stream);
  test_options(&stream);
  test_damage(&stream);
  test_null_decoders(&stream);
  test_encoder_arguments();
  test_encoder_frames();
  test_temporal_layers();
  test_normals();
  test_low_delay();
  test_coarse_meshes(&stream);
  test_texts();
  if (failures == 0) puts("the library does what its headers say");
  return failures == 0 ? 0 : 1;
}
