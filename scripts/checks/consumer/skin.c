// Between frames, and bones for skinning on a graphics card:  skin walk.rlpc
// Prints how far skinning alone is from the frames that the decoder gives.
#include <rlpcdec.h>
#include <stdio.h>
#include <stdlib.h>

enum { kSlots = 4 };  // influences of a vertex, as shaders usually have them

typedef struct skin {
  rlpc_pose pose;
  float* matrices;  // [num_bones][16]
  uint16_t* bones;  // [num_vertices][kSlots]
  float* weights;   // the same
  float* rest;      // [num_vertices][3]
} skin;

// Does what a vertex shader does; returns how far a coordinate is from a position at most.
static double distance_to(const skin* s, const float* xyz, size_t v) {
  double max = 0;
  for (size_t c = 0; c < 3; ++c) {
    double at = 0;
    for (size_t k = kSlots * v; k < kSlots * (v + 1); ++k) {
      const float* m = s->matrices + 16 * (size_t)s->bones[k];
      const float* p = s->rest + 3 * v;
      at += (double)(s->weights[k] *
                     (m[c] * p[0] + m[4 + c] * p[1] + m[8 + c] * p[2] + m[12 + c]));
    }
    const double off = at - (double)xyz[3 * v + c];
    if (off > max) max = off;
    if (-off > max) max = -off;
  }
  return max;
}

// Takes bones, weights and rest shape from the frame that has been decoded last.
static rlpc_status make_skin(rlpc_decoder* decoder, size_t num_vertices, skin* s) {
  s->matrices = realloc(s->matrices, 16 * (size_t)s->pose.num_bones * sizeof *s->matrices);
  if (s->matrices == NULL) return RLPC_OUT_OF_MEMORY;
  const rlpc_status status =
      rlpc_decoder_influences(decoder, kSlots, s->bones, s->weights, kSlots * num_vertices);
  if (status != RLPC_OK) return status;
  return rlpc_decoder_rest_floats(decoder, kSlots, s->rest, 3 * num_vertices);
}

static rlpc_status show(rlpc_decoder* decoder, uint32_t frame, const rlpc_frame_output* output,
                        size_t num_vertices, skin* s) {
  const uint32_t before = s->pose.skeleton;
  rlpc_status status = rlpc_decoder_frame(decoder, frame, output);
  if (status == RLPC_OK) status = rlpc_decoder_pose(decoder, &s->pose, sizeof s->pose);
  if (status != RLPC_OK || s->pose.num_bones == 0) return status;
  if (s->pose.skeleton != before) status = make_skin(decoder, num_vertices, s);
  if (status != RLPC_OK) return status;
  status = rlpc_decoder_bone_matrices(decoder, s->matrices, 16 * (size_t)s->pose.num_bones);
  double max = 0;
  for (size_t v = 0; status == RLPC_OK && v < num_vertices; ++v) {
    const double off = distance_to(s, output->positions.data, v);
    if (off > max) max = off;
  }
  printf("frame %u: %u bones, skinning is off by up to %g\n", frame, s->pose.num_bones, max);
  return status;
}

// A picture between two frames, as screens with more pictures a second need.
static rlpc_status show_between(rlpc_decoder* decoder, const rlpc_frame_output* output) {
  rlpc_blend blend;
  rlpc_blend_init(&blend, sizeof blend);
  blend.second_frame = 1;
  blend.weight = 0.25;
  float min[3], max[3];
  rlpc_status status = rlpc_decoder_blend(decoder, &blend, output);
  if (status == RLPC_OK) status = rlpc_decoder_bounds(decoder, min, max);
  if (status == RLPC_OK) {
    printf("a quarter after frame 0: from %g %g %g to %g %g %g\n", (double)min[0],
           (double)min[1], (double)min[2], (double)max[0], (double)max[1], (double)max[2]);
  }
  return status;
}

int main(int argc, char** argv) {
  if (argc != 2) return 64;
  rlpc_decoder* decoder;
  rlpc_stream_info info;
  rlpc_status status = rlpc_decoder_open_file(argv[1], NULL, &decoder);
  if (status == RLPC_OK) status = rlpc_decoder_info(decoder, &info, sizeof info);
  if (status != RLPC_OK) {
    fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
    rlpc_decoder_close(decoder);
    return 1;
  }
  const size_t n = info.num_vertices;
  float* xyz = malloc(3 * n * sizeof *xyz);
  skin s = {{0},
            NULL,
            malloc(kSlots * n * sizeof *s.bones),
            malloc(kSlots * n * sizeof *s.weights),
            malloc(3 * n * sizeof *s.rest)};
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = xyz;
  output.positions.num_bytes = 3 * n * sizeof *xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;
  if (xyz == NULL || s.bones == NULL || s.weights == NULL || s.rest == NULL)
    status = RLPC_OUT_OF_MEMORY;
  if (status == RLPC_OK && info.num_frames > 1) status = show_between(decoder, &output);
  for (uint32_t f = 0; status == RLPC_OK && f < info.num_frames; ++f) {
    status = show(decoder, f, &output, n, &s);
  }
  if (status != RLPC_OK) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
  rlpc_decoder_close(decoder);
  free(xyz);
  free(s.matrices);
  free(s.bones);
  free(s.weights);
  free(s.rest);
  return status == RLPC_OK ? 0 : 1;
}
