// What a graphics interface needs of a stream: vertices with a position, a normal and texture
// coordinates each, and 16- or 32-bit indices. Writes a frame of them as OBJ.
//
//   draw knight.rlpc 12 >knight.obj
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct vertex {
  float position[3];
  float normal[3];
} vertex;

static int stop(const char* what, rlpc_decoder* decoder) {
  fprintf(stderr, "draw: %s: %s\n", what, rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  return 1;
}

int main(int argc, char** argv) {
  if (argc != 3) {
    fprintf(stderr, "usage: draw STREAM.rlpc FRAME\n");
    return 64;
  }
  rlpc_decoder* decoder = NULL;
  if (rlpc_decoder_open_file(argv[1], NULL, &decoder) != RLPC_OK) return stop(argv[1], decoder);
  rlpc_stream_info info;
  rlpc_decoder_info(decoder, &info, sizeof info);

  // Once: the vertices to draw, their triangles and their texture coordinates.
  uint32_t num_sets = 0;
  uint32_t num_drawn = 0;
  if (rlpc_decoder_attributes(decoder, &num_sets) != RLPC_OK ||
      rlpc_decoder_split(decoder, &num_drawn) != RLPC_OK) {
    return stop("attributes", decoder);
  }
  const size_t num_corners = 3 * (size_t)info.num_triangles;
  uint32_t* const indices = malloc(4 * num_corners + 4);
  float* const uv = calloc((size_t)num_drawn + 1, 2 * sizeof *uv);
  vertex* const vertices = calloc((size_t)num_drawn + 1, sizeof *vertices);
  if (indices == NULL || uv == NULL || vertices == NULL) return stop("no memory", decoder);
  if (num_corners > 0) rlpc_decoder_split_indices(decoder, indices, 4 * num_corners, 4);
  const uint32_t set = rlpc_decoder_find_attribute(decoder, "uv0");
  if (set != RLPC_ALL &&
      rlpc_decoder_split_floats(decoder, set, uv, 2 * (size_t)num_drawn) != RLPC_OK) {
    return stop("uv0", decoder);
  }

  // For each frame: positions and normals, straight into the vertices.
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.split = 1;
  output.positions.data = &vertices->position;
  output.normals.data = &vertices->normal;
  output.positions.stride = output.normals.stride = sizeof *vertices;
  output.positions.format = output.normals.format = RLPC_FORMAT_FLOAT;
  output.positions.num_bytes = sizeof *vertices * (size_t)num_drawn;
  output.normals.num_bytes = output.positions.num_bytes - offsetof(vertex, normal);
  const uint32_t frame = (uint32_t)strtoul(argv[2], NULL, 10);
  if (rlpc_decoder_frame(decoder, frame, &output) != RLPC_OK) return stop(argv[1], decoder);

  for (uint32_t v = 0; v < num_drawn; ++v) {
    const float* const p = vertices[v].position;
    const float* const n = vertices[v].normal;
    printf("v %.9g %.9g %.9g\nvn %.4f %.4f %.4f\n", (double)p[0], (double)p[1], (double)p[2],
           (double)n[0], (double)n[1], (double)n[2]);
    // glTF counts v from above, OBJ from below.
    printf("vt %.9g %.9g\n", (double)uv[2 * v], 1 - (double)uv[2 * v + 1]);
  }
  for (size_t c = 0; c < num_corners; c += 3) {
    printf("f %u/%u/%u %u/%u/%u %u/%u/%u\n", indices[c] + 1, indices[c] + 1, indices[c] + 1,
           indices[c + 1] + 1, indices[c + 1] + 1, indices[c + 1] + 1, indices[c + 2] + 1,
           indices[c + 2] + 1, indices[c + 2] + 1);
  }
  free(indices);
  free(uv);
  free(vertices);
  rlpc_decoder_close(decoder);
  return 0;
}
