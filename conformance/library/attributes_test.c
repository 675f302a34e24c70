// Tests attributes and drawn vertices of the library in C. C99.
//
//   attributes_test STREAM...   streams with attributes; the first is ATT-0001a
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "decoder/c_api/rlpc_c_decoder.h"

static int failures = 0;
static const char* path = "";

#define CHECK(condition)                                                                \
  do {                                                                                  \
    if (!(condition)) {                                                                 \
      fprintf(stderr, "%s:%d: %s: failed: %s\n", __FILE__, __LINE__, path, #condition); \
      ++failures;                                                                       \
    }                                                                                   \
  } while (0)

static void* numbers(size_t count) {
  void* place = calloc(count + 1, 4);
  if (place == NULL) abort();
  return place;
}

static rlpc_decoder* opened(void) {
  rlpc_decoder* decoder = NULL;
  CHECK(rlpc_decoder_open_file(path, NULL, &decoder) == RLPC_OK);
  return decoder;
}

// Vertices drawn at each corner of the triangles of a stream.
typedef struct drawing {
  rlpc_stream_info info;
  size_t num_corners;
  uint32_t num_sets;
  uint32_t num_drawn;
  uint32_t* triangles;
  uint32_t* drawn;   // [corner]
  uint32_t* vertex;  // [drawn vertex]
} drawing;

static drawing draw(rlpc_decoder* decoder) {
  drawing d;
  memset(&d, 0, sizeof d);
  CHECK(rlpc_decoder_info(decoder, &d.info, sizeof d.info) == RLPC_OK);
  CHECK(rlpc_decoder_attributes(decoder, &d.num_sets) == RLPC_OK);
  CHECK(rlpc_decoder_split(decoder, &d.num_drawn) == RLPC_OK);
  d.num_corners = 3 * (size_t)d.info.num_triangles;
  d.triangles = numbers(d.num_corners);
  d.drawn = numbers(d.num_corners);
  d.vertex = numbers(d.num_drawn);
  CHECK(rlpc_decoder_triangles(decoder, d.triangles, d.num_corners) == RLPC_OK);
  CHECK(rlpc_decoder_split_indices(decoder, d.drawn, 4 * d.num_corners, 4) == RLPC_OK);
  CHECK(rlpc_decoder_split_vertices(decoder, d.vertex, d.num_drawn) == RLPC_OK);
  return d;
}

static void release(drawing* d) {
  free(d->triangles);
  free(d->drawn);
  free(d->vertex);
}

// Each corner has the vertex that it has in the stream; the drawn vertices are in their order.
static void check_vertices(const drawing* d) {
  CHECK(d->num_drawn >= d->info.num_vertices);
  for (size_t c = 0; c < d->num_corners; ++c) {
    CHECK(d->drawn[c] < d->num_drawn);
    CHECK(d->vertex[d->drawn[c]] == d->triangles[c]);
  }
  for (uint32_t v = 0; v < d->num_drawn; ++v) {
    CHECK(v == 0 ? d->vertex[v] == 0 : d->vertex[v] - d->vertex[v - 1] <= 1);
  }
}

// At each corner, the drawn vertex has the value that the set has there.
static void check_set(rlpc_decoder* decoder, const drawing* d, uint32_t s) {
  rlpc_attribute set;
  CHECK(rlpc_decoder_attribute(decoder, s, &set, sizeof set) == RLPC_OK);
  CHECK(rlpc_decoder_find_attribute(decoder, set.name) == s);
  const size_t n = set.num_components;
  const size_t count = n * set.num_values;
  CHECK((set.kind == RLPC_VALUE_KIND_SMOOTHING) == (n == 0));
  float* values = numbers(count);
  float* drawn = numbers(n * d->num_drawn);
  uint32_t* value_of_corner = numbers(d->num_corners);
  CHECK(rlpc_decoder_attribute_floats(decoder, s, values, count) == RLPC_OK);
  CHECK(rlpc_decoder_attribute_of_corners(decoder, s, value_of_corner, d->num_corners) ==
        RLPC_OK);
  const rlpc_status status = rlpc_decoder_split_floats(decoder, s, drawn, n * d->num_drawn);
  const int has_drawn = n > 0 && (set.domain == RLPC_DOMAIN_VERTICES ||
                                  (set.domain == RLPC_DOMAIN_CORNERS && d->num_corners > 0));
  CHECK(status == (has_drawn ? RLPC_OK : RLPC_BAD_ARGUMENT));
  for (size_t c = 0; c < d->num_corners && n > 0; ++c) {
    CHECK(value_of_corner[c] < set.num_values);
    if (!has_drawn) continue;
    CHECK(memcmp(drawn + n * d->drawn[c], values + n * value_of_corner[c], 4 * n) == 0);
  }
  free(values);
  free(drawn);
  free(value_of_corner);
}

// Drawn vertices are where their vertices are; their normals are unit vectors, and the same at
// the corners that share one.
static void check_frame(rlpc_decoder* decoder, const drawing* d) {
  const size_t n = d->num_drawn;
  int32_t* positions = numbers(3 * (size_t)d->info.num_vertices);
  int32_t* drawn = numbers(3 * n);
  float* normals = numbers(3 * n);
  uint32_t* value_of_corner = numbers(d->num_corners);
  const uint32_t last = d->info.num_frames - 1;
  CHECK(rlpc_decoder_seek(decoder, last) == RLPC_OK);
  CHECK(rlpc_decoder_next_positions(decoder, positions, 3 * (size_t)d->info.num_vertices) ==
        RLPC_OK);
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.split = 1;
  output.positions.data = drawn;
  output.positions.num_bytes = 12 * n;
  output.positions.format = RLPC_FORMAT_INT32;
  output.normals.data = normals;
  output.normals.num_bytes = 12 * n - 1;
  output.normals.format = RLPC_FORMAT_FLOAT;
  CHECK(rlpc_decoder_frame(decoder, last, &output) == RLPC_BAD_ARGUMENT);
  output.normals.num_bytes = 12 * n;
  CHECK(rlpc_decoder_frame(decoder, last, &output) == RLPC_OK);
  for (size_t v = 0; v < n; ++v) {
    CHECK(memcmp(drawn + 3 * v, positions + 3 * (size_t)d->vertex[v], 12) == 0);
    const float* m = normals + 3 * v;
    CHECK(fabs((double)(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]) - 1) < 1e-5);
  }
  const uint32_t set = rlpc_decoder_find_attribute(decoder, "normal");
  rlpc_attribute normal;
  memset(&normal, 0, sizeof normal);
  if (set != RLPC_ALL) {
    CHECK(rlpc_decoder_attribute(decoder, set, &normal, sizeof normal) == RLPC_OK);
  }
  if (normal.kind == RLPC_VALUE_KIND_SMOOTHING && normal.domain == RLPC_DOMAIN_CORNERS) {
    CHECK(rlpc_decoder_attribute_of_corners(decoder, set, value_of_corner, d->num_corners) ==
          RLPC_OK);
    for (size_t c = 1; c < d->num_corners; ++c) {
      if (value_of_corner[c] != value_of_corner[c - 1]) continue;
      CHECK(memcmp(normals + 3 * (size_t)d->drawn[c], normals + 3 * (size_t)d->drawn[c - 1],
                   12) == 0);
    }
  }
  free(positions);
  free(drawn);
  free(normals);
  free(value_of_corner);
}

static void check_stream(void) {
  rlpc_decoder* decoder = opened();
  drawing d = draw(decoder);
  CHECK(d.num_sets > 0);
  check_vertices(&d);
  for (uint32_t s = 0; s < d.num_sets; ++s) check_set(decoder, &d, s);
  check_frame(decoder, &d);
  release(&d);
  rlpc_decoder_close(decoder);
}

// uv0, normal, colour0 and material of 20 vertices and 24 triangles.
static void check_sets(void) {
  static const char* const kNames[] = {"uv0", "normal", "colour0", "material"};
  static const uint32_t kDomains[] = {RLPC_DOMAIN_CORNERS, RLPC_DOMAIN_CORNERS,
                                      RLPC_DOMAIN_VERTICES, RLPC_DOMAIN_TRIANGLES};
  static const uint32_t kKinds[] = {RLPC_VALUE_KIND_INTEGERS, RLPC_VALUE_KIND_UNIT_VECTORS,
                                    RLPC_VALUE_KIND_INTEGERS, RLPC_VALUE_KIND_INTEGERS};
  static const uint32_t kComponents[] = {2, 3, 3, 1};
  rlpc_decoder* decoder = opened();
  uint32_t num_sets = 0;
  CHECK(rlpc_decoder_attributes(decoder, &num_sets) == RLPC_OK && num_sets == 4);
  for (uint32_t s = 0; s < num_sets; ++s) {
    rlpc_attribute set;
    CHECK(rlpc_decoder_attribute(decoder, s, &set, sizeof set) == RLPC_OK);
    CHECK(strcmp(set.name, kNames[s]) == 0);
    CHECK(set.domain == kDomains[s] && set.kind == kKinds[s]);
    CHECK(set.num_components == kComponents[s]);
  }
  CHECK(rlpc_decoder_find_attribute(decoder, "uv1") == RLPC_ALL);
  float colours[60];
  uint32_t integers[60];
  CHECK(rlpc_decoder_attribute_floats(decoder, 2, colours, 60) == RLPC_OK);
  CHECK(rlpc_decoder_attribute_integers(decoder, 2, integers, 60) == RLPC_OK);
  for (int i = 0; i < 60; ++i) CHECK(colours[i] == (float)(integers[i] / 255.0));
  rlpc_decoder_close(decoder);
}

// Tests mistakes of a caller.
static void check_arguments(void) {
  rlpc_decoder* decoder = opened();
  rlpc_attribute set;
  uint32_t number = 7;
  uint32_t values[72];
  float floats[72];
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.split = 1;
  CHECK(rlpc_decoder_find_attribute(decoder, "uv0") == RLPC_ALL);  // not decoded yet
  CHECK(rlpc_decoder_attribute(decoder, 0, &set, sizeof set) == RLPC_BAD_ARGUMENT);
  CHECK(strcmp(rlpc_decoder_error_text(decoder), "call rlpc_decoder_attributes first") == 0);
  CHECK(rlpc_decoder_split_vertices(decoder, values, 20) == RLPC_BAD_ARGUMENT);
  CHECK(strcmp(rlpc_decoder_error_text(decoder), "call rlpc_decoder_split first") == 0);
  CHECK(rlpc_decoder_frame(decoder, 0, &output) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_attributes(decoder, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_attributes(decoder, &number) == RLPC_OK && number == 4);
  CHECK(rlpc_decoder_attribute(decoder, 4, &set, sizeof set) == RLPC_BAD_ARGUMENT);
  CHECK(strcmp(rlpc_decoder_error_text(decoder), "expected a set below 4, got 4") == 0);
  CHECK(rlpc_decoder_attribute_floats(decoder, 2, floats, 59) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_attribute_floats(decoder, 2, NULL, 60) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_attribute_integers(decoder, 1, values, 72) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_attribute_of_corners(decoder, 0, values, 71) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_split(decoder, &number) == RLPC_OK && number > 20);
  CHECK(rlpc_decoder_split_indices(decoder, values, 72, 1) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_split_indices(decoder, values, 144, 2) == RLPC_OK);
  const void* asset = values;
  size_t num_bytes = 1;
  CHECK(rlpc_decoder_asset(decoder, &asset, NULL) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_asset(decoder, &asset, &num_bytes) == RLPC_OK);
  CHECK(asset == NULL && num_bytes == 0);
  rlpc_decoder_close(decoder);
  CHECK(rlpc_decoder_attributes(NULL, &number) == RLPC_BAD_ARGUMENT);
}

// A stream with a changed byte in its attribute unit.
static void check_damage(void) {
  static unsigned char bytes[1 << 14];
  FILE* const file = fopen(path, "rb");
  CHECK(file != NULL);
  if (file == NULL) return;
  const size_t size = fread(bytes, 1, sizeof bytes, file);
  fclose(file);
  size_t at = 0;  // place of the attribute unit: ancillary_flag, unit_type, 32 bits of size
  while (at + 4 < size && !(bytes[at] == 0x88 && bytes[at + 1] == 0 && bytes[at + 2] == 0))
    ++at;
  CHECK(at + 12 < size);
  bytes[at + 12] ^= 1;
  rlpc_decoder* decoder = NULL;
  CHECK(rlpc_decoder_open_memory(bytes, size, NULL, &decoder) == RLPC_BAD_STREAM);
  rlpc_decoder_close(decoder);
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.skip_damaged_units = 1;
  CHECK(rlpc_decoder_open_memory(bytes, size, &options, &decoder) == RLPC_OK);
  CHECK(rlpc_decoder_num_damaged_units(decoder) == 1);
  uint32_t number = 7;
  float xyz[60];
  CHECK(rlpc_decoder_attributes(decoder, &number) == RLPC_OK && number == 0);
  while (rlpc_decoder_position(decoder) < 2) {
    CHECK(rlpc_decoder_next_floats(decoder, xyz, 60) == RLPC_OK);
  }
  CHECK(rlpc_decoder_next_floats(decoder, xyz, 60) == RLPC_END);
  rlpc_decoder_close(decoder);
}

int main(int argc, char** argv) {
  if (argc < 2) {
    fprintf(stderr, "usage: attributes_test STREAM...\n");
    return 64;
  }
  path = argv[1];
  check_sets();
  check_arguments();
  check_damage();
  for (int i = 1; i < argc; ++i) {
    path = argv[i];
    check_stream();
  }
  printf("%d streams, %d failures\n", argc - 1, failures);
  return failures == 0 ? 0 : 1;
}
