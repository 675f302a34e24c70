// Decodes a stream with memory of its own and says how much that took:  memory walk.rlpc
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct heap {
  size_t now, peak, blocks;
} heap;

// An engine has its own functions here. malloc aligns as far as the decoder asks for.
static void* allocate(void* user, size_t size, size_t alignment) {
  heap* from = user;
  void* place = alignment <= 16 ? malloc(size) : NULL;
  if (place == NULL) return NULL;
  ++from->blocks;
  from->now += size;
  if (from->now > from->peak) from->peak = from->now;
  return place;
}

static void give_back(void* user, void* place, size_t size, size_t alignment) {
  (void)alignment;
  ((heap*)user)->now -= size;
  free(place);
}

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  heap from = {0, 0, 0};
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.allocator.user = &from;
  options.allocator.allocate = allocate;
  options.allocator.release = give_back;
  options.max_cached_bytes = 0;

  rlpc_decoder* decoder;
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  rlpc_status status = rlpc_decoder_open_file(argv[1], &options, &decoder);
  while (status == RLPC_OK) status = rlpc_decoder_next(decoder, &output);
  if (status != RLPC_END) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  printf("%zu blocks, at most %zu kB; %zu bytes left\n", from.blocks, from.peak / 1000,
         from.now);
  return status == RLPC_END && from.now == 0 ? 0 : 1;
}
