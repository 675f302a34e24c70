// Tests bones of frames in C: with them, their weights and the rest shape, a program can
// compute the frames of the decoder. C99.
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "conformance/testing/c_testing.h"
#include "decoder/c_api/rlpc_c_decoder.h"
#include "encoder/c_api/rlpc_c_encoder.h"

#define RINGS 40
#define AROUND 12
#define VERTICES (RINGS * AROUND)
#define VALUES (3 * VERTICES)
#define TRIANGLES (2 * (RINGS - 1) * AROUND)
#define FRAMES 40
#define MAX_BONES 256
#define MAX_SLOTS 16

// A tube of two bones, which blend in its middle. It turns and moves along.
static void make_frame(int frame, float* xyz) {
  const double turn = 0.05 * frame, bend = 0.9 * sin(0.25 * frame);
  for (int v = 0; v < VERTICES; ++v) {
    const double angle = 6.283185307 * (v % AROUND) / AROUND;
    const double along = 4.0 * (v / AROUND) / RINGS - 2;
    const double weight = fmin(fmax(along / 1.6 + 0.5, 0), 1);
    const double x = 0.4 * cos(angle), up = 0.4 * sin(angle);
    const double y = (1 - weight) * up + weight * (up * cos(bend) + along * sin(bend));
    const double z = (1 - weight) * along + weight * (along * cos(bend) - up * sin(bend));
    xyz[3 * v] = (float)(x * cos(turn) - y * sin(turn) + 0.05 * frame);
    xyz[3 * v + 1] = (float)(x * sin(turn) + y * cos(turn));
    xyz[3 * v + 2] = (float)z;
  }
}

static void encode(uint32_t profile) {
  static uint32_t indices[3 * TRIANGLES];
  make_grid(RINGS, AROUND, 1, indices);
  rlpc_frame_format format;
  rlpc_frame_format_init(&format, sizeof format);
  format.num_vertices = VERTICES;
  format.num_triangles = TRIANGLES;
  format.indices = indices;
  format.num_frames = FRAMES;
  rlpc_encode_options options;
  rlpc_encode_options_init(&options, sizeof options);
  options.profile = profile;
  options.gof_frames = FRAMES;
  options.target = RLPC_TARGET_MAX_ERROR;
  options.target_value = 0.01;
  static float xyz[VALUES];
  encode_frames(&format, &options, -4, 6, make_frame, xyz);
}

static rlpc_decoder* decoder;
static float frame_xyz[VALUES];
static float rest[VALUES];
static float matrices[16 * MAX_BONES];
static uint16_t bones[MAX_SLOTS * VERTICES];
static float weights[MAX_SLOTS * VERTICES];

static void decode(uint32_t frame) {
  rlpc_frame_output output;
  rlpc_frame_output_init(&output, sizeof output);
  output.positions.data = frame_xyz;
  output.positions.num_bytes = sizeof frame_xyz;
  output.positions.format = RLPC_FORMAT_FLOAT;
  CHECK(rlpc_decoder_frame(decoder, frame, &output) == RLPC_OK);
}

static size_t vertices = VERTICES;

// Skins as a graphics card does. Returns the largest distance from the frame; mean: average.
static double skin_error(uint32_t slots, double* mean) {
  double max = 0, sum = 0;
  for (size_t v = 0; v < vertices; ++v) {
    double at[3] = {0, 0, 0}, squares = 0;
    for (size_t k = 0; k < slots; ++k) {
      const float* m = matrices + 16 * (size_t)bones[slots * v + k];
      const double weight = (double)weights[slots * v + k];
      for (size_t c = 0; c < 3; ++c) {
        double image = (double)m[12 + c];
        for (size_t i = 0; i < 3; ++i) image += (double)m[4 * i + c] * (double)rest[3 * v + i];
        at[c] += weight * image;
      }
    }
    for (size_t c = 0; c < 3; ++c) {
      const double apart = at[c] - (double)frame_xyz[3 * v + c];
      squares += apart * apart;
    }
    max = fmax(max, sqrt(squares));
    sum += sqrt(squares);
  }
  *mean = sum / (double)vertices;
  return max;
}

static void check_influences(uint32_t slots, uint32_t num_bones) {
  for (size_t v = 0; v < vertices; ++v) {
    double sum = 0;
    for (size_t k = 0; k < slots; ++k) {
      const float weight = weights[slots * v + k];
      CHECK(bones[slots * v + k] < num_bones && weight >= 0);
      CHECK(k == 0 || weight <= weights[slots * v + k - 1]);
      sum += (double)weight;
    }
    CHECK(fabs(sum - 1) < 1e-5);
  }
}

static void check_bones(const rlpc_pose* pose) {
  for (uint32_t b = 0; b < pose->num_bones; ++b) {
    rlpc_bone bone;
    CHECK(rlpc_decoder_bone(decoder, b, &bone, sizeof bone) == RLPC_OK);
    CHECK(bone.parent >= -1 && bone.parent < (int32_t)b);
    for (int c = 0; c < 3; ++c) {
      double length = 0;
      for (int i = 0; i < 3; ++i)
        length += (double)bone.bind[4 * c + i] * (double)bone.bind[4 * c + i];
      CHECK(fabs(length - 1) < 1e-5);
    }
    CHECK(bone.bind[3] == 0 && bone.bind[15] == 1);
  }
}

// Tests the bones of a GOF with the rest shape of its first frame.
static void test_skinning(uint32_t first, uint32_t count, double max_error, double mean_error) {
  decode(first);
  rlpc_pose pose;
  CHECK(rlpc_decoder_pose(decoder, &pose, sizeof pose) == RLPC_OK);
  CHECK(pose.num_bones > 0 && pose.num_bones <= MAX_BONES && pose.skeleton > 0);
  CHECK(pose.max_influences >= 2 && pose.max_influences <= MAX_SLOTS);
  if (failures > 0) return;
  check_bones(&pose);
  const uint32_t slots = pose.max_influences;
  CHECK(rlpc_decoder_influences(decoder, slots, bones, weights, slots * vertices) == RLPC_OK);
  check_influences(slots, pose.num_bones);
  CHECK(rlpc_decoder_rest_floats(decoder, slots, rest, 3 * vertices) == RLPC_OK);
  for (uint32_t f = first; f < first + count; ++f) {
    decode(f);
    rlpc_pose now;
    CHECK(rlpc_decoder_pose(decoder, &now, sizeof now) == RLPC_OK);
    CHECK(now.skeleton == pose.skeleton && now.num_bones == pose.num_bones);
    CHECK(rlpc_decoder_bone_matrices(decoder, matrices, 16 * now.num_bones) == RLPC_OK);
    double mean;
    const double max = skin_error(slots, &mean);
    if (f == first) CHECK(max < 1e-4);  // exact except for rounding
    CHECK(max < max_error && mean < mean_error);
  }
}

static void test_fewer_influences(void) {
  decode(20);
  rlpc_pose pose;
  CHECK(rlpc_decoder_pose(decoder, &pose, sizeof pose) == RLPC_OK);
  CHECK(rlpc_decoder_bone_matrices(decoder, matrices, 16 * pose.num_bones) == RLPC_OK);
  for (uint32_t slots = 1; slots <= 4; ++slots) {
    CHECK(rlpc_decoder_influences(decoder, slots, bones, weights, slots * VERTICES) == RLPC_OK);
    check_influences(slots, pose.num_bones);
    CHECK(rlpc_decoder_rest_floats(decoder, slots, rest, VALUES) == RLPC_OK);
    double mean;
    CHECK(skin_error(slots, &mean) < 1e-3);
  }
}

static void test_refusals(void) {
  rlpc_pose pose;
  rlpc_bone bone;
  decode(3);
  CHECK(rlpc_decoder_pose(decoder, NULL, sizeof pose) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_pose(NULL, &pose, sizeof pose) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_pose(decoder, &pose, sizeof pose) == RLPC_OK);
  CHECK(rlpc_decoder_bone(decoder, pose.num_bones, &bone, sizeof bone) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_bone(decoder, 0, NULL, sizeof bone) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_bone_matrices(decoder, matrices, 1) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_bone_matrices(decoder, NULL, 16 * pose.num_bones) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_influences(decoder, 0, bones, weights, 0) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_influences(decoder, 2, bones, weights, VERTICES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_rest_floats(decoder, 2, rest, VERTICES) == RLPC_BAD_ARGUMENT);
  // The rest shape is that of the frame of the pose.
  decode(5);
  CHECK(rlpc_decoder_rest_floats(decoder, 2, rest, VALUES) == RLPC_BAD_ARGUMENT);
  CHECK(rlpc_decoder_seek(decoder, FRAMES - 2) == RLPC_OK);
  CHECK(rlpc_decoder_pose(decoder, &pose, sizeof pose) == RLPC_BAD_ARGUMENT);
  CHECK(strstr(rlpc_decoder_error_text(decoder), "decode a frame first") != NULL);
  // An older program knows fewer members.
  struct {
    size_t struct_size;
    uint32_t num_bones;
    uint32_t guard;
  } older = {0, 0, 99};
  decode(6);
  CHECK(rlpc_decoder_pose(decoder, (rlpc_pose*)(void*)&older,
                          offsetof(rlpc_pose, max_influences)) == RLPC_OK);
  CHECK(older.num_bones > 0 && older.guard == 99);
}

static void open_stream(void) {
  CHECK(rlpc_decoder_open_memory(encoded, encoded_size, NULL, &decoder) == RLPC_OK);
}

// Bones alone move the first frames of these streams; some stretch. Positions are rounded to
// integers, which shows magnified where bones have shrunk in the first frame.
static void test_stretched(const char* path) {
  rlpc_stream_info info;
  CHECK(rlpc_decoder_open_file(path, NULL, &decoder) == RLPC_OK);
  CHECK(rlpc_decoder_info(decoder, &info, sizeof info) == RLPC_OK);
  vertices = info.num_vertices;
  test_skinning(0, 4, 2, 1);
  rlpc_decoder_close(decoder);
}

int main(int argc, char** argv) {
  encode(RLPC_PROFILE_MAIN);
  open_stream();
  rlpc_pose pose;
  CHECK(rlpc_decoder_pose(decoder, &pose, sizeof pose) == RLPC_BAD_ARGUMENT);  // no frame yet
  CHECK(rlpc_decoder_bone_matrices(decoder, matrices, 16) == RLPC_BAD_ARGUMENT);
  test_skinning(0, FRAMES, 1e-3, 1e-4);  // the tube is 4 long, and bones leave nothing
  test_fewer_influences();
  test_refusals();
  rlpc_decoder_close(decoder);
  CHECK(argc > 1);
  for (int i = 1; i < argc; ++i) test_stretched(argv[i]);
  if (failures == 0) puts("bones move the rest shape as the decoder does");
  return failures == 0 ? 0 : 1;
}
