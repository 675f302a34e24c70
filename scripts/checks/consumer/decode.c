// Decodes a stream, frame by frame:  decode walk.rlpc frames.f32
// To frames.f32 go x, y and z of each vertex as floats, one frame after another.
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

int main(int argc, char** argv) {
  FILE* out = argc == 3 ? fopen(argv[2], "wb") : NULL;
  if (out == NULL) return 64;

  rlpc_decoder* decoder;
  rlpc_status status = rlpc_decoder_open_file(argv[1], NULL, &decoder);
  if (status == RLPC_OK) {
    rlpc_stream_info info;
    rlpc_decoder_info(decoder, &info, sizeof info);
    const size_t num_values = 3 * (size_t)info.num_vertices;
    float* xyz = malloc(num_values * sizeof *xyz);
    if (xyz == NULL) status = RLPC_OUT_OF_MEMORY;
    while (status == RLPC_OK) {
      status = rlpc_decoder_next_floats(decoder, xyz, num_values);
      if (status == RLPC_OK && fwrite(xyz, sizeof *xyz, num_values, out) != num_values) break;
    }
    free(xyz);
    printf("%u frames of %u vertices\n", rlpc_decoder_position(decoder), info.num_vertices);
  }
  if (status != RLPC_END) {
    fprintf(stderr, "%s: %s\n", rlpc_status_text(status), rlpc_decoder_error_text(decoder));
  }
  rlpc_decoder_close(decoder);
  return fclose(out) == 0 && status == RLPC_END ? 0 : 1;
}
