// Examples in the comments of the public headers in C, between marks that check_api.py compares
// with the headers. Run in a folder with dance.rlpc, a stream with bones and texture
// coordinates:
//   examples dance2.rlpc
// writes another stream.
#include <rlpc.h>
#include <stdio.h>
#include <stdlib.h>

static rlpc_decoder* decoder;
static rlpc_frame_output output;
static rlpc_stream_info info;
static unsigned num_used;

static void use(const float* xyz) {
  if (xyz != NULL) ++num_used;
}

static int expect(int is_right, const char* what) {
  if (!is_right) fprintf(stderr, "examples: %s\n", what);
  return is_right ? 0 : 1;
}

static int decode(void) {
  // Example of decoder/c_api/rlpc_c_decoder.h
  rlpc_decoder* decoder;
  rlpc_status status = rlpc_decoder_open_file("dance.rlpc", NULL, &decoder);
  if (status == RLPC_OK) {
    rlpc_stream_info info;
    rlpc_decoder_info(decoder, &info, sizeof info);
    const size_t length = 3 * (size_t)info.num_vertices;
    float* xyz = malloc(length * sizeof *xyz);
    while ((status = rlpc_decoder_next_floats(decoder, xyz, length)) == RLPC_OK) use(xyz);
    free(xyz);
  }
  if (status != RLPC_END) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  // End of the example
  return expect(status == RLPC_END && num_used == info.num_frames, "frames were not decoded");
}

typedef struct vertex {
  float position[3];
  int8_t normal[4];
} vertex;

static int fill_vertices(void) {
  const size_t vertices_bytes = info.num_vertices * sizeof(vertex);
  vertex* vertices = calloc(info.num_vertices, sizeof(vertex));
  if (vertices == NULL) return 1;
  // Example of decoder/c_api/rlpc_frame_output.h
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = &vertices->position;  // of the first vertex
  output.positions.format = RLPC_FORMAT_FLOAT;
  output.positions.num_bytes = vertices_bytes - offsetof(vertex, position);
  output.normals.data = &vertices->normal;
  output.normals.format = RLPC_FORMAT_INT8;
  output.normals.num_bytes = vertices_bytes - offsetof(vertex, normal);
  output.positions.stride = output.normals.stride = sizeof(vertex);
  rlpc_decoder_frame(decoder, 17, &output);
  // End of the example
  const int8_t* const n = vertices->normal;
  const int length = n[0] * n[0] + n[1] * n[1] + n[2] * n[2];
  free(vertices);
  return expect(rlpc_decoder_error_text(decoder)[0] == '\0' && length > 120 * 120,
                "a frame lacks normals");
}

static int split(void) {
  const uint32_t num_triangles = info.num_triangles;
  const size_t num_corners = 3 * (size_t)num_triangles;
  uint32_t* indices = malloc(num_corners * sizeof *indices);
  float* coordinates = malloc(num_corners * 2 * sizeof *coordinates);
  float* xyz = malloc(num_corners * 3 * sizeof *xyz);
  if (indices == NULL || coordinates == NULL || xyz == NULL) return 1;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = num_corners * 3 * sizeof *xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;
  // Example of decoder/c_api/rlpc_attributes.h
  uint32_t num_sets, num_drawn;
  rlpc_decoder_attributes(decoder, &num_sets);  // decodes them
  rlpc_decoder_split(decoder, &num_drawn);
  rlpc_decoder_split_indices(decoder, indices, 12 * (size_t)num_triangles, 4);
  uint32_t uv = rlpc_decoder_find_attribute(decoder, "uv0");
  if (uv != RLPC_ALL)
    rlpc_decoder_split_floats(decoder, uv, coordinates, 2 * (size_t)num_drawn);
  output.split = 1;  // positions and normals of drawn vertices
  rlpc_decoder_frame(decoder, 17, &output);
  // End of the example
  output.split = 0;
  const int is_right = rlpc_decoder_error_text(decoder)[0] == '\0' && indices[0] < num_drawn;
  free(indices);
  free(coordinates);
  free(xyz);
  return expect(is_right, "vertices were not split");
}

static int blend(double place) {
  // Example of decoder/c_api/rlpc_pose.h
  rlpc_blend blend;
  rlpc_blend_init(&blend, sizeof blend);
  blend.first_frame = (uint32_t)place;         // place: seconds times frames per second
  blend.second_frame = blend.first_frame + 1;  // within the clip
  blend.weight = place - blend.first_frame;
  rlpc_decoder_blend(decoder, &blend, &output);  // output: as for rlpc_decoder_frame
  // End of the example
  return expect(rlpc_decoder_error_text(decoder)[0] == '\0', "frames were not blended");
}

static int pose(uint32_t first_of_gof) {
  const uint32_t num_vertices = info.num_vertices;
  uint16_t* bones = malloc(4 * num_vertices * sizeof *bones);
  float* weights = malloc(4 * num_vertices * sizeof *weights);
  float* rest = malloc(3 * num_vertices * sizeof *rest);
  float* matrices = malloc(16 * 1024 * sizeof *matrices);
  if (bones == NULL || weights == NULL || rest == NULL || matrices == NULL) return 1;
  // Example of decoder/c_api/rlpc_pose.h
  rlpc_decoder_frame(decoder, first_of_gof, &output);
  rlpc_pose pose;
  rlpc_decoder_pose(decoder, &pose, sizeof pose);
  if (pose.num_bones > 0) {
    rlpc_decoder_influences(decoder, 4, bones, weights, 4 * (size_t)num_vertices);
    rlpc_decoder_rest_floats(decoder, 4, rest, 3 * (size_t)num_vertices);
    rlpc_decoder_bone_matrices(decoder, matrices, 16 * (size_t)pose.num_bones);  // per frame
  }
  // End of the example
  free(bones);
  free(weights);
  free(rest);
  free(matrices);
  return expect(rlpc_decoder_error_text(decoder)[0] == '\0', "a pose was not found");
}

static int write_bytes(void* file, const void* bytes, size_t num_bytes) {
  return fwrite(bytes, 1, num_bytes, file) == num_bytes ? 0 : 1;
}

static const float* frame(uint32_t f) {
  static float xyz[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  xyz[0] = (float)f / 8;
  return xyz;
}

static int encode(const char* path) {
  static const uint32_t indices[] = {0, 1, 2};
  const uint32_t num_vertices = 3;
  const uint32_t num_triangles = 1;
  const uint32_t num_frames = 4;
  FILE* file = fopen(path, "wb");
  if (file == NULL) return 1;
  // Example of encoder/c_api/rlpc_c_encoder.h
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = num_vertices;
  format.num_triangles = num_triangles;
  format.indices = indices;
  format.num_frames = num_frames;
  for (int axis = 0; axis < 3; ++axis) {
    format.box_min[axis] = -10;  // contains all frames
    format.box_max[axis] = 10;
  }
  rlpc_encoder* encoder;
  rlpc_status status = rlpc_encoder_create(&format, NULL, write_bytes, file, &encoder);
  for (uint32_t f = 0; status == RLPC_OK && f < num_frames; ++f)
    status = rlpc_encoder_add_frame(encoder, frame(f), 3 * (size_t)num_vertices);
  if (status == RLPC_OK) status = rlpc_encoder_finish(encoder, NULL, 0);
  if (status != RLPC_OK) fprintf(stderr, "%s\n", rlpc_encoder_error_text(encoder));
  rlpc_encoder_close(encoder);
  // End of the example
  return fclose(file) == 0 ? expect(status == RLPC_OK, "no stream was written") : 1;
}

static int run_decoder(void) {
  const size_t num_values = 3 * (size_t)info.num_vertices;
  float* xyz = malloc(num_values * sizeof *xyz);
  if (xyz == NULL) return 1;
  int failed = decode() + fill_vertices() + split();
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = num_values * sizeof *xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;
  failed += blend(2.5) + pose(0);
  free(xyz);
  return failed;
}

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  int failed = rlpc_decoder_open_file("dance.rlpc", NULL, &decoder) != RLPC_OK;
  if (!failed) {
    rlpc_decoder_info(decoder, &info, sizeof info);
    failed = run_decoder();
  }
  rlpc_decoder_close(decoder);
  failed += encode(argv[1]);
  printf("%d examples failed\n", failed);
  return failed == 0 ? 0 : 1;
}
