// Encodes frames one by one:  encode NUM_VERTICES NUM_FRAMES triangles.u32 frames.f32 walk.rlpc
// In triangles.u32 are three vertex indices for each triangle; in frames.f32 x, y and z of each
// vertex as floats, one frame after another. No more than one frame is held here.
#include <rlpc.h>
#include <stdio.h>
#include <stdlib.h>

static int write_bytes(void* file, const void* bytes, size_t num_bytes) {
  return fwrite(bytes, 1, num_bytes, file) == num_bytes ? 0 : 1;
}

int main(int argc, char** argv) {
  static uint32_t indices[1 << 20];
  FILE* mesh = argc == 6 ? fopen(argv[3], "rb") : NULL;
  FILE* in = argc == 6 ? fopen(argv[4], "rb") : NULL;
  FILE* out = argc == 6 ? fopen(argv[5], "wb") : NULL;
  if (mesh == NULL || in == NULL || out == NULL) return 64;

  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = (uint32_t)atoi(argv[1]);
  format.num_frames = (uint32_t)atoi(argv[2]);
  format.num_triangles = (uint32_t)(fread(indices, sizeof *indices, 1 << 20, mesh) / 3);
  format.indices = indices;
  for (int axis = 0; axis < 3; ++axis) {  // within which all of the animation is known to be
    format.box_min[axis] = -10;
    format.box_max[axis] = 10;
  }
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.preset = RLPC_PRESET_FAST;
  options.target_value = 0.2;  // KG error in per cent
  options.gof_frames = 32;

  rlpc_encoder* encoder;
  rlpc_status status = rlpc_encoder_create(&format, &options, write_bytes, out, &encoder);
  const size_t num_values = 3 * (size_t)format.num_vertices;
  float* xyz = malloc(num_values * sizeof *xyz);
  while (status == RLPC_OK && xyz != NULL &&
         fread(xyz, sizeof *xyz, num_values, in) == num_values) {
    status = rlpc_encoder_add_frame(encoder, xyz, num_values);
  }
  if (status == RLPC_OK) status = rlpc_encoder_finish(encoder, NULL, 0);
  if (status != RLPC_OK) {
    fprintf(stderr, "%s: %s\n", rlpc_status_text(status), rlpc_encoder_error_text(encoder));
  }
  rlpc_encoder_close(encoder);
  free(xyz);
  return fclose(out) == 0 && status == RLPC_OK ? 0 : 1;
}
