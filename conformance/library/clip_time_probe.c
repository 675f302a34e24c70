// Prints the frames that the library in C shows at times of clips, to compare them with
// JavaScript. C99.
//
//   clip_time_probe STREAM < times
//
// A line of input: a clip's index (-1: the whole sequence), seconds as a hexadecimal double,
// and whether the clip repeats (0 or 1). A line of output: the nearest frame, the place, and
// the first coordinates of the mix of the two frames around it.
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "decoder/c_api/rlpc_c_decoder.h"

#define SHOWN 12

static rlpc_decoder* decoder;
static rlpc_stream_info info;
static float* xyz;

// Returns 0 on success.
static int show(const rlpc_clip* clip, double seconds, uint32_t repeats) {
  uint32_t frame;
  double place;
  if (rlpc_decoder_frame_at(decoder, clip, seconds, repeats, &frame, &place) != RLPC_OK)
    return 1;
  rlpc_blend blend;
  rlpc_blend_init(&blend, sizeof blend);
  blend.first_frame = (uint32_t)place;
  blend.weight = place - blend.first_frame;
  blend.second_frame = blend.first_frame + (blend.weight > 0 ? 1 : 0);
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = 3 * sizeof *xyz * info.num_vertices;
  output.positions.format = RLPC_FORMAT_FLOAT;
  if (rlpc_decoder_blend(decoder, &blend, &output) != RLPC_OK) return 1;
  printf("%u %.17g", (unsigned)frame, place);
  for (int i = 0; i < SHOWN; ++i) printf(" %.9g", (double)xyz[i]);
  putchar('\n');
  return 0;
}

static int show_all(void) {
  long index;
  char seconds[64];
  unsigned repeats;
  while (scanf("%ld %63s %u", &index, seconds, &repeats) == 3) {
    rlpc_clip clip;
    if (index >= 0 && rlpc_decoder_clip(decoder, (uint32_t)index, &clip) != RLPC_OK) return 1;
    if (show(index < 0 ? NULL : &clip, strtod(seconds, NULL), repeats) != 0) return 1;
  }
  return 0;
}

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  int failed = rlpc_decoder_open_file(argv[1], NULL, &decoder) != RLPC_OK ||
               rlpc_decoder_info(decoder, &info, sizeof info) != RLPC_OK;
  if (!failed) {
    xyz = malloc(3 * sizeof *xyz * info.num_vertices);
    failed = xyz == NULL || 3 * info.num_vertices < SHOWN || show_all() != 0;
  }
  if (failed) fprintf(stderr, "clip_time_probe: %s\n", rlpc_decoder_error_text(decoder));
  free(xyz);
  rlpc_decoder_close(decoder);
  return failed ? 1 : 0;
}
