// What a stream says about itself, read through callbacks: clips, GOFs, attributes, memory.
// Writes the asset, materials and textures, as a GLB.
//
//   inspect knight.rlpc asset.glb
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

// The place of each byte that is wanted, as an archive or a network would find it.
static int read_file(void* user, uint64_t offset, void* out, size_t num_bytes) {
  FILE* const file = user;
  return fseek(file, (long)offset, SEEK_SET) != 0 ||
         fread(out, 1, num_bytes, file) != num_bytes;
}

static void print_sequence(rlpc_decoder* decoder) {
  rlpc_stream_info info;
  rlpc_decoder_info(decoder, &info, sizeof info);
  printf("%u vertices, %u triangles, %u frames, %.2f s, metadata %s\n", info.num_vertices,
         info.num_triangles, info.num_frames, info.duration_seconds,
         rlpc_decoder_metadata(decoder));
  for (uint32_t i = 0; i < rlpc_decoder_num_clips(decoder); ++i) {
    rlpc_clip clip;
    if (rlpc_decoder_clip(decoder, i, &clip) != RLPC_OK) continue;
    printf("clip %s: %u frames from %u on\n", clip.name, clip.num_frames, clip.first_frame);
  }
  rlpc_gof gofs[8];
  uint32_t num_gofs = 0;
  if (rlpc_decoder_gofs(decoder, gofs, 8, &num_gofs) == RLPC_OK) {
    printf("%u GOFs, the first with %u frames\n", num_gofs, gofs[0].num_frames);
  }
  rlpc_memory memory;
  if (rlpc_decoder_memory(decoder, &memory, sizeof memory) == RLPC_OK) {
    printf("memory: %llu bytes for the stream, %llu for the GOF in use\n",
           (unsigned long long)memory.stream_bytes, (unsigned long long)memory.gof_bytes);
  }
}

static int print_attributes(rlpc_decoder* decoder) {
  static const char* const kinds[] = {"integers", "unit vectors", "floats", "smoothing"};
  uint32_t num_sets = 0;
  if (rlpc_decoder_attributes(decoder, &num_sets) != RLPC_OK) return 1;
  for (uint32_t set = 0; set < num_sets; ++set) {
    rlpc_attribute attribute;
    if (rlpc_decoder_attribute(decoder, set, &attribute, sizeof attribute) != RLPC_OK) return 1;
    printf("%s: %u values of %u %s\n", attribute.name, attribute.num_values,
           attribute.num_components, attribute.kind < 4 ? kinds[attribute.kind] : "others");
  }
  return 0;
}

static int write_asset(rlpc_decoder* decoder, const char* path) {
  const void* bytes = NULL;
  size_t num_bytes = 0;
  if (rlpc_decoder_asset(decoder, &bytes, &num_bytes) != RLPC_OK) return 1;
  FILE* const file = fopen(path, "wb");
  if (file == NULL) return 1;
  const size_t written = fwrite(bytes, 1, num_bytes, file);
  return fclose(file) != 0 || written != num_bytes;
}

int main(int argc, char** argv) {
  FILE* const file = argc == 3 ? fopen(argv[1], "rb") : NULL;
  if (file == NULL || fseek(file, 0, SEEK_END) != 0) {
    fprintf(stderr, "usage: inspect STREAM.rlpc ASSET.glb\n");
    return 64;
  }
  const rlpc_source source = {file, (uint64_t)ftell(file), read_file};
  rlpc_decode_options options;
  rlpc_decode_options_init(&options, sizeof options);
  options.skip_damaged_units = 1;  // frames matter more than, say, a texture
  options.place_bytes = rlpc_decoder_bytes();
  options.place = malloc(options.place_bytes);  // of the handle
  rlpc_decoder* decoder = NULL;
  int failed = rlpc_decoder_open_source(&source, &options, &decoder) != RLPC_OK;
  if (!failed) {
    print_sequence(decoder);
    failed = print_attributes(decoder) != 0 || write_asset(decoder, argv[2]) != 0;
    if (rlpc_decoder_num_damaged_units(decoder) > 0) printf("a damaged unit was left out\n");
  }
  if (failed) fprintf(stderr, "inspect: %s\n", rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  free(options.place);
  fclose(file);
  return failed;
}
