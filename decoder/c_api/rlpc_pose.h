// RLPC decoder in C: what is between two frames, and the bones that move a frame. C99 and C++.
//
// Screens show more pictures a second than an animation has frames. rlpc_decoder_blend gives
// the linear mix of two frames: neighbours, or frames of two clips in a crossfade.
//
//   rlpc_blend blend;
//   rlpc_blend_init(&blend, sizeof blend);
//   blend.first_frame = (uint32_t)place;             // place: seconds times frames per second
//   blend.second_frame = blend.first_frame + 1;      // within the clip
//   blend.weight = place - blend.first_frame;
//   rlpc_decoder_blend(decoder, &blend, &output);    // output: as for rlpc_decoder_frame
//
// Where frames are moved by bones (most in the Main and High profiles), graphics cards can do
// it: per frame, they need the matrices of the bones alone. What bones leave, which the decoder
// adds, is then missing.
//
//   rlpc_decoder_frame(decoder, first_of_gof, &output);
//   rlpc_pose pose;
//   rlpc_decoder_pose(decoder, &pose, sizeof pose);   // pose.num_bones: 0 if there are none
//   rlpc_decoder_influences(decoder, 4, bones, weights, 4 * num_vertices);
//   rlpc_decoder_rest_floats(decoder, 4, rest, 3 * num_vertices);
//   rlpc_decoder_bone_matrices(decoder, matrices, 16 * pose.num_bones);   // of each frame
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"
#include "decoder/c_api/rlpc_frame_output.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
typedef struct rlpc_blend {
  size_t struct_size;     // rlpc_blend_init sets it
  uint32_t first_frame;   // both: below num_frames
  uint32_t second_frame;  // may be the same, or before the first
  double weight;          // of the second frame, 0 to 1; that of the first is 1 - weight
} rlpc_blend;

typedef struct rlpc_pose {
  size_t struct_size;  // as passed to rlpc_decoder_pose
  uint32_t num_bones;  // 0: no bones move this frame
  // The largest number of bones that move one vertex.
  uint32_t max_influences;
  // Counts skeletons from 1: equal to that of the pose before if bones, influences and bind
  // places are the same. 0 without bones.
  uint32_t skeleton;
} rlpc_pose;

typedef struct rlpc_bone {
  size_t struct_size;  // as passed to rlpc_decoder_bone
  int32_t parent;      // index of an earlier bone; -1: none
  float bind[16];      // where the bone is in the rest shape: a matrix, column after column
} rlpc_bone;
// NOLINTEND(readability-identifier-naming)

struct rlpc_decoder;

// Sets all members to their defaults: frame 0 alone. struct_size: sizeof *blend.
RLPC_API void rlpc_blend_init(rlpc_blend* blend, size_t struct_size);

// Decodes two frames, and gives their mix. Positions: computed in double precision and rounded
// once; RLPC_FLOAT, _HALF or _INT16. With a weight of 0 or 1, those of a frame alone, exactly;
// the other is not decoded. Normals: of both frames, mixed, of length 1. RLPC_BAD_ARGUMENT:
// frames that do not exist, a weight that is not from 0 to 1, RLPC_INT32.
//
// rlpc_decoder_bounds then gives the box of the mix. The next frame (rlpc_decoder_next) is not
// defined afterwards, before rlpc_decoder_frame or _seek. Time: that of the frames which the
// call before has not used; going on slowly decodes each frame once. Memory: two frames, with
// normals also 48 bytes for each of their normals, until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_blend(struct rlpc_decoder* decoder, const rlpc_blend* blend,
                                        const rlpc_frame_output* output);

// The bones of the frame that rlpc_decoder_frame, _next or _next_floats has decoded last; the
// functions below are about the pose that was asked for last. RLPC_BAD_ARGUMENT: no frame has
// been decoded, or another call has moved on since (a seek, a blend). struct_size: sizeof
// *pose. Time and memory: in a GOF for the first time, in proportion to the vertices; otherwise
// to the bones.
RLPC_API rlpc_status rlpc_decoder_pose(struct rlpc_decoder* decoder, rlpc_pose* pose,
                                       size_t struct_size);
// A bone of the rest shape. bone: below num_bones. struct_size: sizeof *info.
RLPC_API rlpc_status rlpc_decoder_bone(struct rlpc_decoder* decoder, uint32_t bone,
                                       rlpc_bone* info, size_t struct_size);
// For each bone a matrix of 4 by 4 floats, column after column, which maps points of the rest
// shape to the frame, both in the units of the encoder's input. num_floats: 16 * num_bones.
RLPC_API rlpc_status rlpc_decoder_bone_matrices(struct rlpc_decoder* decoder, float* matrices,
                                                size_t num_floats);
// The bones that move each vertex, and their weights, which add up to 1: `slots` of each, the
// strongest first; places that are not needed have bone 0 and weight 0. With fewer slots than
// max_influences, the weakest are left out, and the others get their share. slots: 1 to 65536;
// num_values: slots * num_vertices.
RLPC_API rlpc_status rlpc_decoder_influences(struct rlpc_decoder* decoder, uint32_t slots,
                                             uint16_t* bones, float* weights,
                                             size_t num_values);
// The rest shape with which so many influences per vertex give the frame of the pose: exact
// there, up to rounding, but where bones squeeze a vertex flat. In other frames, what bones
// leave is missing. num_floats: 3 * num_vertices.
RLPC_API rlpc_status rlpc_decoder_rest_floats(struct rlpc_decoder* decoder, uint32_t slots,
                                              float* xyz, size_t num_floats);

#ifdef __cplusplus
}
#endif
