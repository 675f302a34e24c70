// RLPC encoder in C. C99 and C++; part of librlpc.
//
//   rlpc_frame_format format;
//   rlpc_frame_format_init(&format, sizeof format);
//   format.num_vertices = num_vertices;
//   format.num_triangles = num_triangles;
//   format.indices = indices;
//   format.num_frames = num_frames;
//   for (int axis = 0; axis < 3; ++axis) {
//     format.box_min[axis] = -10;  // contains all frames
//     format.box_max[axis] = 10;
//   }
//   rlpc_encoder* encoder;
//   rlpc_status status = rlpc_encoder_create(&format, NULL, write_bytes, file, &encoder);
//   for (uint32_t f = 0; status == RLPC_OK && f < num_frames; ++f)
//     status = rlpc_encoder_add_frame(encoder, frame(f), 3 * (size_t)num_vertices);
//   if (status == RLPC_OK) status = rlpc_encoder_finish(encoder, NULL, 0);
//   if (status != RLPC_OK) fprintf(stderr, "%s\n", rlpc_encoder_error_text(encoder));
//   rlpc_encoder_close(encoder);
//
// Frames are added one by one; memory is bounded by one group of frames (GOF) and its analysis.
// Adding the last frame of a GOF encodes the GOF and passes its bytes to the callback; this
// call takes almost all of the time. Each GOF meets the target separately, and thus the whole
// stream does (see frame_encoder.h). In the High profile, several GOFs are held and encoded
// together (max_held_frames). The same frames and options give the same bytes on every
// machine. A decoder verifies the stream while it is written: a wrong stream is a bug of the
// encoder, RLPC_INTERNAL_ERROR. No function throws or aborts. Errors name members of the
// structures in quotes: 'gof_frames'. rlpc_status.h describes versions, structures and the use
// of handles by threads.
//
// Memory: frames and reports are in buffers of the caller, and output is passed to a callback.
// Only the handle must be closed; it can be in memory of the caller (place). The analysis uses
// C++ operator new and no other allocator. If memory runs out, calls return RLPC_OUT_OF_MEMORY,
// and the handle can only be closed, which releases everything. A thread that calls these
// functions needs a stack of 256 KiB.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_clip.h"
#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Handle of an encoder.
typedef struct rlpc_encoder rlpc_encoder;

// Maximum number of temporal layers. Since 1.2.
#define RLPC_MAX_TEMPORAL_LAYERS 8

// Properties of the sequence that must be known before the first frame.
typedef struct rlpc_frame_format {
  size_t struct_size;       // rlpc_frame_format_init sets it
  uint32_t num_vertices;    // at least 1
  uint32_t num_triangles;   // 0: a point cloud
  const uint32_t* indices;  // 3 * num_triangles, each below num_vertices; copied
  uint32_t num_frames;      // exactly this many frames must follow; 0: not known (High profile)
  uint32_t frame_rate_numerator;  // frames per second; default 30 / 1
  uint32_t frame_rate_denominator;
  // Bounding box of all frames, in units, within 2^100. A box that is much too large makes the
  // grid coarser.
  float box_min[3];
  float box_max[3];
} rlpc_frame_format;

// Profile of the stream. RLPC_PROFILE_HIGH is version 1.2 of the format, which is not released:
// its streams may change. Names with RLPC_PROFILE_: since 1.2.
typedef enum rlpc_profile {
  RLPC_PROFILE_BASELINE = 0,
  RLPC_PROFILE_MAIN = 1,
  RLPC_PROFILE_HIGH = 2,
  // Names of versions before 1.2.
  RLPC_BASELINE = RLPC_PROFILE_BASELINE,
  RLPC_MAIN = RLPC_PROFILE_MAIN,
} rlpc_profile;

// Search effort; does not affect decoders. Names with RLPC_PRESET_: since 1.2.
typedef enum rlpc_preset {
  RLPC_PRESET_FAST = 0,
  RLPC_PRESET_MEDIUM = 1,
  RLPC_PRESET_SLOW = 2,
  // Names of versions before 1.2.
  RLPC_FAST = RLPC_PRESET_FAST,
  RLPC_MEDIUM = RLPC_PRESET_MEDIUM,
  RLPC_SLOW = RLPC_PRESET_SLOW,
} rlpc_preset;

// Error or rate that the encoder aims for.
typedef enum rlpc_target {
  RLPC_TARGET_KG = 1,         // KG error in per cent
  RLPC_TARGET_BPVF = 2,       // bits per vertex and frame
  RLPC_TARGET_MAX_ERROR = 3,  // maximum distance of a vertex from its original, in units
  // High profile: positions without loss on a grid of this many bits, 2 to 24, of the box.
  // Since 1.2.
  RLPC_TARGET_LOSSLESS = 4,
} rlpc_target;

// Kind of GOFs. RLPC_GOF_KIND_AUTO: for each GOF, the cheapest that the profile has;
// RLPC_GOF_KIND_SKINNED: skinned GOFs, Main and High; RLPC_GOF_KIND_INTER: inter GOFs, High.
// Since 1.2.
typedef enum rlpc_gof_kind {
  RLPC_GOF_KIND_AUTO = 0,
  RLPC_GOF_KIND_CLUSTER = 1,
  RLPC_GOF_KIND_SKINNED = 2,
  RLPC_GOF_KIND_INTER = 3,
} rlpc_gof_kind;

// Hashes of decoded positions in the stream: none, one per GOF, one per frame. Names with
// RLPC_HASH_MODE_: since 1.2.
typedef enum rlpc_hash_mode {
  RLPC_HASH_MODE_NONE = 0,
  RLPC_HASH_MODE_GOF = 1,
  RLPC_HASH_MODE_FRAME = 2,
  // Names of versions before 1.2.
  RLPC_HASH_NONE = RLPC_HASH_MODE_NONE,
  RLPC_HASH_GOF = RLPC_HASH_MODE_GOF,
  RLPC_HASH_FRAME = RLPC_HASH_MODE_FRAME,
} rlpc_hash_mode;

// Options of the encoder. rlpc_encode_options_init sets the defaults.
typedef struct rlpc_encode_options {
  size_t struct_size;  // rlpc_encode_options_init sets it
  uint32_t profile;    // default RLPC_PROFILE_MAIN
  uint32_t preset;     // default RLPC_PRESET_MEDIUM
  // rlpc_target, default RLPC_TARGET_KG; approached from below, to 0.6 % (largest error,
  // and KG error with RLPC_PRESET_FAST: 2 %) if possible.
  uint32_t target;
  double target_value;  // default 0.1; above zero and finite
  // Maximum frames per GOF; 0: 128, or 256 in the High profile; UINT32_MAX: one GOF of all.
  uint32_t gof_frames;
  // Number of components, up to 1024; Main: maximum per GOF; Baseline: average per cluster; 0:
  // chosen.
  uint32_t components;
  uint32_t keep_order;   // 1: decoders restore the vertex order of the input; 0: they do not
  uint32_t hash_mode;    // default RLPC_HASH_MODE_GOF
  uint32_t least_level;  // lowest level of Table B-1 that the stream may declare; default 1
  // JSON text for the metadata of the stream, not validated, up to 1 MiB; null: none. Copied.
  const char* metadata;
  // Memory for the handle: rlpc_encoder_bytes() bytes, aligned as by malloc, valid until the
  // handle is closed. Null: allocated by the library.
  void* place;
  size_t place_bytes;
  // Encodings estimated to need more fail with RLPC_LIMIT_EXCEEDED; default 32 GiB. Since 1.2.
  uint64_t max_memory_bytes;
  // 1 to 256, otherwise RLPC_BAD_ARGUMENT; the stream does not depend on it. Since 1.2.
  uint32_t threads;
  uint32_t reserved;  // padding, not read; since 1.2
  // High profile: temporal layers, 1 to RLPC_MAX_TEMPORAL_LAYERS; the stream can be cut to
  // fewer. Default 1. Since 1.2.
  uint32_t temporal_layers;
  // High profile: maximum number of frames that are held and encoded together, but at least one
  // GOF; 0: as many as can share a shared rig, up to 2^23 positions. Since 1.2.
  uint32_t max_held_frames;
  uint32_t gof_kind;  // default RLPC_GOF_KIND_AUTO; since 1.2
  // High profile, 1: each frame is coded when it is added, in inter GOFs; a KG error is then
  // met approximately. Default 0. Not with RLPC_TARGET_BPVF. Since 1.2.
  uint32_t low_delay;
  // Named parts of the sequence, num_clips of them, up to RLPC_MAX_CLIPS; copied. Default none.
  // Since 1.2.
  const rlpc_clip* clips;
  size_t num_clips;  // since 1.2
  // With RLPC_TARGET_KG, a second bound: of the RMS deviation of vertex normals, in degrees; 0:
  // none. Normals do not tell where a part is, so choose a target_value that does, such as 1;
  // 0.8 with a target_value of 0.2 is `rlpcenc --quality good`. Not with low_delay. Since 1.2.
  double max_normals;
} rlpc_encode_options;

// Report on a finished stream.
typedef struct rlpc_encode_report {
  size_t struct_size;  // rlpc_encoder_finish sets it
  uint64_t num_bytes;
  double bpvf;  // bits per vertex per frame, everything included
  double kg_error_percent;
  double rms_error;  // in units
  double max_error;
  uint32_t num_gofs;
  uint32_t level;
  uint32_t target_met;  // 1: met in every GOF
  // Size and KG error of the stream when cut to its first 1, 2, ... temporal layers, up to one
  // fewer than it has; further values are 0. Since 1.2.
  uint64_t temporal_cut_bytes[RLPC_MAX_TEMPORAL_LAYERS - 1];
  double temporal_cut_kg_error_percent[RLPC_MAX_TEMPORAL_LAYERS - 1];  // since 1.2
} rlpc_encode_report;

// Receives the next bytes of the stream. Returns 0 on success; other values stop the encoder
// with RLPC_IO_FAILED.
typedef int (*rlpc_write_function)(void* user, const void* bytes, size_t num_bytes);
// NOLINTEND(readability-identifier-naming)

// Sets all members to their defaults, or zero. struct_size: sizeof *format.
RLPC_API void rlpc_frame_format_init(rlpc_frame_format* format, size_t struct_size);
// Sets all members to their defaults, or zero. struct_size: sizeof *options.
RLPC_API void rlpc_encode_options_init(rlpc_encode_options* options, size_t struct_size);

// Returns the size of a handle, bytes, for rlpc_encode_options.place.
RLPC_API size_t rlpc_encoder_bytes(void);

// Begins a stream: `write` is called with `user` and the bytes. options: null for defaults.
// Returns RLPC_OK; RLPC_BAD_ARGUMENT: an argument is null or not initialised, place is too
// small or not aligned, or an option is outside its enumeration or range; RLPC_BAD_INPUT: no
// stream can represent the format, or the options contradict each other; RLPC_LIMIT_EXCEEDED:
// encoding may need more than max_memory_bytes; RLPC_OUT_OF_MEMORY; RLPC_INTERNAL_ERROR. After
// a failure, *encoder is null, or a handle that provides the error text and must be closed.
RLPC_API rlpc_status rlpc_encoder_create(const rlpc_frame_format* format,
                                         const rlpc_encode_options* options,
                                         rlpc_write_function write, void* user,
                                         rlpc_encoder** encoder);
// Releases the handle; encoder may be null. The stream is incomplete unless rlpc_encoder_finish
// has returned RLPC_OK.
RLPC_API void rlpc_encoder_close(rlpc_encoder* encoder);

// Returns the error text of the last failed call, "" if none failed; never null. Valid until
// the next call on the handle.
RLPC_API const char* rlpc_encoder_error_text(const rlpc_encoder* encoder);

// Adds the next frame: x, y and z of each vertex, in units. num_values: 3 * num_vertices.
// Returns RLPC_OK; RLPC_BAD_ARGUMENT: null, or another num_values; RLPC_BAD_INPUT: a NaN, a
// coordinate outside the box, more than num_frames frames, or frames that need a higher level;
// RLPC_IO_FAILED: the callback failed; RLPC_OUT_OF_MEMORY; RLPC_INTERNAL_ERROR. All errors but
// RLPC_BAD_ARGUMENT are sticky; with low_delay, RLPC_BAD_INPUT is not: the frame is left out,
// and the stream can be continued or finished.
RLPC_API rlpc_status rlpc_encoder_add_frame(rlpc_encoder* encoder, const float* xyz,
                                            size_t num_values);
// Ends the stream, after the last frame. report may be null; otherwise struct_size is sizeof
// *report. Returns RLPC_OK; RLPC_BAD_ARGUMENT: encoder is null; RLPC_BAD_INPUT: fewer than
// num_frames frames, or none; RLPC_IO_FAILED: the callback failed; RLPC_OUT_OF_MEMORY;
// RLPC_INTERNAL_ERROR. Errors are sticky.
RLPC_API rlpc_status rlpc_encoder_finish(rlpc_encoder* encoder, rlpc_encode_report* report,
                                         size_t struct_size);
// Copies the input index of each decoded vertex, after rlpc_encoder_finish. (With keep_order,
// decoders restore the input order.) num_values: num_vertices. Returns RLPC_OK;
// RLPC_BAD_ARGUMENT: null, another num_values, or the stream is not finished.
RLPC_API rlpc_status rlpc_encoder_vertex_order(rlpc_encoder* encoder, uint32_t* input_vertex,
                                               size_t num_values);

#ifdef __cplusplus
}
#endif
