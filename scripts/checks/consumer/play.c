// Plays a stream forward, backward and back and forth between two GOFs:  play walk.rlpc
// Prints, for each, how long the frames took.
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

static rlpc_decoder* decoder;
static rlpc_frame_output output;
static float slowest;  // milliseconds

static int show(uint32_t frame) {
  struct timespec before, after;
  timespec_get(&before, TIME_UTC);
  const rlpc_status status = rlpc_decoder_frame(decoder, frame, &output);
  timespec_get(&after, TIME_UTC);
  const float ms = (float)(after.tv_sec - before.tv_sec) * 1e3F +
                   (float)(after.tv_nsec - before.tv_nsec) * 1e-6F;
  if (ms > slowest) slowest = ms;
  if (status != RLPC_OK) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
  return status == RLPC_OK;
}

static void report(const char* what) {
  printf("%s: largest %.2f ms\n", what, slowest);
  slowest = 0;
}

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.threads = 2;                  // one of them prepares the GOFs that come next
  options.max_cached_bytes = 64 << 20;  // of those that were left
  rlpc_stream_info info;
  if (rlpc_decoder_open_file(argv[1], &options, &decoder) != RLPC_OK ||
      rlpc_decoder_info(decoder, &info, sizeof info) != RLPC_OK) {
    fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
    rlpc_decoder_close(decoder);
    return 1;
  }
  float* xyz = malloc(info.num_vertices * 3 * sizeof *xyz);
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = info.num_vertices * 3 * sizeof *xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;

  int ok = xyz != NULL;
  for (uint32_t f = 0; ok && f < info.num_frames; ++f) ok = show(f);
  report("forward");
  for (uint32_t f = info.num_frames; ok && f-- > 0;) ok = show(f);
  report("backward");

  rlpc_gof last = {0, 0};
  if (ok) ok = rlpc_decoder_gof_of(decoder, info.num_frames - 1, &last) == RLPC_OK;
  if (ok) ok = rlpc_decoder_prefetch(decoder, last.first_frame) == RLPC_OK;
  for (uint32_t i = 0; ok && i < 8; ++i) ok = show(i % 2 == 0 ? 0 : last.first_frame);
  report("back and forth");
  rlpc_decoder_close(decoder);
  free(xyz);
  return ok ? 0 : 1;
}
