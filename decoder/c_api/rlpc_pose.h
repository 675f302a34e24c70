// RLPC decoder in C: blends of two frames, and the bones that move a frame. C99 and C++.
//
// Displays refresh more often than animations change frames. rlpc_decoder_blend interpolates
// linearly between two frames: neighbours, or frames of two clips in a crossfade.
//
//   rlpc_blend blend;
//   rlpc_blend_init(&blend, sizeof blend);
//   blend.first_frame = (uint32_t)place;         // place: seconds times frames per second
//   blend.second_frame = blend.first_frame + 1;  // within the clip
//   blend.weight = place - blend.first_frame;
//   rlpc_decoder_blend(decoder, &blend, &output);  // output: as for rlpc_decoder_frame
//
// Where bones move the frames (usual in the Main and High profiles), a graphics card can skin
// them: per frame, it needs only the matrices of the bones. The residual of the bones, which
// the decoder adds, is then missing.
//
//   rlpc_decoder_frame(decoder, first_of_gof, &output);
//   rlpc_pose pose;
//   rlpc_decoder_pose(decoder, &pose, sizeof pose);
//   if (pose.num_bones > 0) {
//     rlpc_decoder_influences(decoder, 4, bones, weights, 4 * (size_t)num_vertices);
//     rlpc_decoder_rest_floats(decoder, 4, rest, 3 * (size_t)num_vertices);
//     rlpc_decoder_bone_matrices(decoder, matrices, 16 * (size_t)pose.num_bones);  // per frame
//   }
//
// Versions and structures: rlpc_status.h. Everything in this header is there since 1.2.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"
#include "decoder/c_api/rlpc_frame_output.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Two frames and their weights. rlpc_blend_init sets the defaults. Since 1.2.
typedef struct rlpc_blend {
  size_t struct_size;     // set by rlpc_blend_init
  uint32_t first_frame;   // below num_frames
  uint32_t second_frame;  // below num_frames; may precede or equal first_frame
  double weight;          // weight of the second frame, 0 to 1; the first has 1 - weight
} rlpc_blend;

// Bones of a frame. Since 1.2.
typedef struct rlpc_pose {
  size_t struct_size;       // size passed to rlpc_decoder_pose
  uint32_t num_bones;       // 0: no bones move this frame
  uint32_t max_influences;  // largest number of bones that move one vertex
  // Number of the skeleton, from 1: that of the previous pose if bones, influences and bind
  // places are the same. 0 without bones.
  uint32_t skeleton;
} rlpc_pose;

// Bone of the rest shape. Since 1.2.
typedef struct rlpc_bone {
  size_t struct_size;  // size passed to rlpc_decoder_bone
  int32_t parent;      // index of an earlier bone; -1: none
  float bind[16];      // place of the bone in the rest shape: a matrix in column-major order
} rlpc_bone;
// NOLINTEND(readability-identifier-naming)

struct rlpc_decoder;

// Sets all members to their defaults: frame 0 alone. struct_size: sizeof *blend. Since 1.2.
RLPC_API void rlpc_blend_init(rlpc_blend* blend, size_t struct_size);

// Decodes two frames and writes their blend. Positions: computed in double precision and
// rounded once; RLPC_FORMAT_FLOAT, _HALF or _INT16. A weight of 0 or 1 yields one frame
// exactly; the other is not decoded. Normals: interpolated, then normalised. Returns
// RLPC_BAD_ARGUMENT for frames that do not exist, a weight outside 0 to 1, or
// RLPC_FORMAT_INT32; otherwise a stream error if a frame cannot be decoded.
//
// rlpc_decoder_bounds then returns the box of the blend. The next frame (rlpc_decoder_next) is
// undefined until rlpc_decoder_frame or _seek. Time: decodes the frames that the previous call
// did not use; slow playback decodes each frame once. Memory: two frames, and 48 bytes per
// normal, until the handle is closed. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_blend(struct rlpc_decoder* decoder, const rlpc_blend* blend,
                                        const rlpc_frame_output* output);

// Finds the bones of the frame that rlpc_decoder_frame, _next or _next_floats decoded last. The
// functions below refer to the pose of the last call; without bones, they return
// RLPC_BAD_ARGUMENT. struct_size: sizeof *pose. Returns RLPC_BAD_ARGUMENT if no frame has been
// decoded, or another call (a seek, a blend) has moved on since. Time and memory: proportional
// to the vertices for the first pose of a GOF, otherwise to the bones. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_pose(struct rlpc_decoder* decoder, rlpc_pose* pose,
                                       size_t struct_size);
// Describes a bone of the rest shape. bone: below num_bones, otherwise RLPC_BAD_ARGUMENT.
// struct_size: sizeof *info. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_bone(struct rlpc_decoder* decoder, uint32_t bone,
                                       rlpc_bone* info, size_t struct_size);
// Copies a matrix of 4 by 4 floats per bone, in column-major order, which maps points of the
// rest shape to the frame, both in the units of the encoder's input. num_floats: 16 *
// num_bones. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_bone_matrices(struct rlpc_decoder* decoder, float* matrices,
                                                size_t num_floats);
// Copies the bones that move each vertex and their weights, which add up to 1: `slots` of each
// per vertex, the strongest first; unused slots have bone 0 and weight 0. With fewer slots than
// max_influences, the weakest are dropped and the others rescaled. slots: 1 to 65536, otherwise
// RLPC_BAD_ARGUMENT. num_values: slots * num_vertices. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_influences(struct rlpc_decoder* decoder, uint32_t slots,
                                             uint16_t* bones, float* weights,
                                             size_t num_values);
// Computes the rest shape from which `slots` influences per vertex reproduce the frame of the
// pose: exactly, up to rounding, except where the blended matrix of a vertex is singular. Other
// frames lack the residual of the bones. num_floats: 3 * num_vertices. Returns
// RLPC_BAD_ARGUMENT if another frame has been decoded since rlpc_decoder_pose. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_rest_floats(struct rlpc_decoder* decoder, uint32_t slots,
                                              float* xyz, size_t num_floats);

#ifdef __cplusplus
}
#endif
