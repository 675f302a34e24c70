// Fills buffers as a renderer wants them, with positions as 16-bit integers and normals as
// bytes, interleaved:  vertices walk.rlpc frame.bin To frame.bin go the triangles, as 16-bit
// indices, and the vertices of the frame in the middle.
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct vertex {
  int16_t position[3];
  int8_t normal[3];
  uint8_t unused;
} vertex;

static rlpc_decoder* decoder;

static int decode(FILE* out) {
  rlpc_stream_info info;
  rlpc_decoder_info(decoder, &info, sizeof info);
  const size_t index_bytes = 3 * (size_t)info.num_triangles * sizeof(uint16_t);
  const size_t vertex_bytes = (size_t)info.num_vertices * sizeof(vertex);
  uint16_t* indices = malloc(index_bytes);
  vertex* vertices = calloc(1, vertex_bytes);

  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = vertices->position;
  output.positions.num_bytes = vertex_bytes;
  output.positions.stride = sizeof(vertex);
  output.positions.format = RLPC_FORMAT_INT16;
  output.normals.data = vertices->normal;
  output.normals.num_bytes = vertex_bytes - offsetof(vertex, normal);
  output.normals.stride = sizeof(vertex);
  output.normals.format = RLPC_FORMAT_INT8;
  output.normal_weight = RLPC_NORMAL_WEIGHT_ANGLE;

  double scale[3], offset[3];  // for the vertex shader: coordinate = value * scale + offset
  float min[3], max[3];
  const int ok =
      rlpc_decoder_int16_scale(decoder, scale, offset) == RLPC_OK &&
      rlpc_decoder_indices(decoder, indices, index_bytes, sizeof *indices) == RLPC_OK &&
      rlpc_decoder_frame(decoder, info.num_frames / 2, &output) == RLPC_OK &&
      rlpc_decoder_bounds(decoder, min, max) == RLPC_OK &&
      fwrite(indices, 1, index_bytes, out) == index_bytes &&
      fwrite(vertices, 1, vertex_bytes, out) == vertex_bytes;
  if (ok) {
    printf("%.2f s; x %g to %g = %g * value + %g\n", info.duration_seconds, min[0], max[0],
           scale[0], offset[0]);
  }
  free(vertices);
  free(indices);
  return ok;
}

int main(int argc, char** argv) {
  FILE* out = argc == 3 ? fopen(argv[2], "wb") : NULL;
  if (out == NULL) return 64;
  const int ok = rlpc_decoder_open_file(argv[1], NULL, &decoder) == RLPC_OK && decode(out);
  if (!ok) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  return fclose(out) == 0 && ok ? 0 : 1;
}
