// RLPC encoder in C. C99 and C++; part of librlpc.
//
//   rlpc_frame_format format;
//   rlpc_frame_format_init(&format, sizeof format);
//   format.num_vertices = ...;  // and the other members
//   rlpc_encoder* encoder;
//   rlpc_status status = rlpc_encoder_create(&format, NULL, write_bytes, file, &encoder);
//   for (uint32_t f = 0; status == RLPC_OK && f < format.num_frames; ++f)
//     status = rlpc_encoder_add_frame(encoder, frame(f), 3 * format.num_vertices);
//   if (status == RLPC_OK) status = rlpc_encoder_finish(encoder, NULL, 0);
//   if (status != RLPC_OK) fprintf(stderr, "%s\n", rlpc_encoder_error_text(encoder));
//   rlpc_encoder_close(encoder);
//
// Frames are added one by one; memory is bounded by one group of frames (GOF) and its analysis.
// Adding the last frame of a GOF encodes the GOF and passes its bytes to the callback; this
// call takes almost all of the time. Each GOF meets the target separately, and thus the whole
// stream does (see frame_encoder.h). In the High profile, several GOFs are held and encoded
// together (max_held_frames). The same frames and options give the same bytes on every
// machine. A decoder verifies what has been written as it goes: one that is wrong is a bug of
// the encoder, RLPC_INTERNAL_ERROR. No function throws or aborts. A handle may be used by one
// thread at a time; different handles are independent.
//
// Memory: frames and reports are in buffers of the caller, and output is passed to a callback.
// Only the handle must be closed; it can be placed in memory of the caller (place). The
// analysis uses C++ operator new and no other allocator. If memory runs out, calls return
// RLPC_OUT_OF_MEMORY, and the handle can only be closed, which releases everything. A thread
// that calls these functions needs a stack of 256 KiB.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_clip.h"
#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
typedef struct rlpc_encoder rlpc_encoder;

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
  // Bounding box of all frames, within 2^100. A box that is much too large makes the grid
  // coarser.
  float box_min[3];
  float box_max[3];
} rlpc_frame_format;

// RLPC_HIGH is version 1.2, which is not released: its streams may change.
typedef enum rlpc_profile { RLPC_BASELINE = 0, RLPC_MAIN = 1, RLPC_HIGH = 2 } rlpc_profile;

typedef enum rlpc_preset { RLPC_FAST = 0, RLPC_MEDIUM = 1, RLPC_SLOW = 2 } rlpc_preset;

typedef enum rlpc_target {
  RLPC_TARGET_KG = 1,         // KG error in per cent
  RLPC_TARGET_BPVF = 2,       // bits per vertex and frame
  RLPC_TARGET_MAX_ERROR = 3,  // maximum distance of a vertex from its original, in units
  // High profile: positions without loss on a grid of this many bits, 2 to 24, of the box.
  RLPC_TARGET_LOSSLESS = 4,
} rlpc_target;

// RLPC_KIND_BONES: Main and High; RLPC_KIND_FRAMES: High. RLPC_KIND_AUTO: the cheapest that the
// profile has, for each GOF.
typedef enum rlpc_gof_kind {
  RLPC_KIND_AUTO = 0,
  RLPC_KIND_CLUSTERS = 1,
  RLPC_KIND_BONES = 2,
  RLPC_KIND_FRAMES = 3,
} rlpc_gof_kind;

typedef enum rlpc_hash_mode {
  RLPC_HASH_NONE = 0,
  RLPC_HASH_GOF = 1,
  RLPC_HASH_FRAME = 2,
} rlpc_hash_mode;

typedef struct rlpc_encode_options {
  size_t struct_size;  // rlpc_encode_options_init sets it
  uint32_t profile;    // default RLPC_MAIN
  uint32_t preset;     // default RLPC_MEDIUM
  // Default RLPC_TARGET_KG; approached from below, within 2 % (High: 4 %) if possible.
  uint32_t target;
  double target_value;  // default 0.1; above zero and finite
  // Maximum frames per GOF; 0: 128, or 256 in the High profile; UINT32_MAX: one GOF of all.
  uint32_t gof_frames;
  // Main: maximum per GOF; Baseline: average per cluster; up to 1024; 0: chosen.
  uint32_t components;
  uint32_t keep_order;   // 1: decoders restore the vertex order of the input; 0: they do not
  uint32_t hash_mode;    // default RLPC_HASH_GOF
  uint32_t least_level;  // lowest level that the stream may declare, 1 to 4; default 1
  // JSON text to carry along, not validated, up to 1 MiB; null: none. Copied.
  const char* metadata;
  // Memory for the handle: rlpc_encoder_bytes() bytes, aligned as by malloc, valid until the
  // handle is closed. Null: allocated by the library.
  void* place;
  size_t place_bytes;
  // Encodings estimated to need more fail with RLPC_LIMIT_EXCEEDED; default 32 GiB.
  uint64_t max_memory_bytes;
  uint32_t threads;   // 1 to 256, otherwise RLPC_BAD_ARGUMENT; the stream does not depend on it
  uint32_t reserved;  // was padding of earlier versions; not read
  // High profile: temporal layers, 1 to RLPC_MAX_TEMPORAL_LAYERS, to which the stream can be
  // cut; default 1, with which it cannot.
  uint32_t temporal_layers;
  // High profile: most frames that are held before they are encoded together, but at least
  // those of one GOF; 0: as many as share a shared rig in memory, 2^23 positions or fewer.
  uint32_t max_held_frames;
  uint32_t gof_kind;  // default RLPC_KIND_AUTO
  // High profile, 1: each frame is coded when it is added, in inter GOFs; a KG error is
  // then met approximately. Default 0. Targets: all but RLPC_TARGET_BPVF.
  uint32_t low_delay;
  // Named parts of the sequence, num_clips of them, up to RLPC_MAX_CLIPS; copied. Default none.
  const rlpc_clip* clips;
  size_t num_clips;
} rlpc_encode_options;

typedef struct rlpc_encode_report {
  size_t struct_size;  // as passed to rlpc_encoder_finish
  uint64_t num_bytes;
  double bpvf;  // bits per vertex per frame, everything included
  double kg_error_percent;
  double rms_error;  // units, as max_error
  double max_error;
  uint32_t num_gofs;
  uint32_t level;
  uint32_t target_met;  // 1: met in every GOF
  // Of the stream when cut to its first 1, 2, ... temporal layers, one fewer than it has;
  // further values are 0.
  uint64_t temporal_cut_bytes[RLPC_MAX_TEMPORAL_LAYERS - 1];
  double temporal_cut_kg_error_percent[RLPC_MAX_TEMPORAL_LAYERS - 1];
} rlpc_encode_report;

// Receives the next bytes of the stream. Returns 0 on success.
typedef int (*rlpc_write_function)(void* user, const void* bytes, size_t num_bytes);
// NOLINTEND(readability-identifier-naming)

// Set all members to their defaults, or zero. struct_size: sizeof the structure.
RLPC_API void rlpc_frame_format_init(rlpc_frame_format* format, size_t struct_size);
RLPC_API void rlpc_encode_options_init(rlpc_encode_options* options, size_t struct_size);

// Size of a handle, for rlpc_encode_options.place.
RLPC_API size_t rlpc_encoder_bytes(void);

// Begins a stream. options may be null: defaults. On failure, *encoder is still a handle, which
// provides the error text and must be closed; it is null only if an argument is null or
// invalid, or if there is no memory for a handle. RLPC_BAD_INPUT: no stream can represent the
// format; RLPC_LIMIT_EXCEEDED: encoding may need more than max_memory_bytes.
RLPC_API rlpc_status rlpc_encoder_create(const rlpc_frame_format* format,
                                         const rlpc_encode_options* options,
                                         rlpc_write_function write, void* user,
                                         rlpc_encoder** encoder);
// Releases the handle. Without rlpc_encoder_finish before, the stream is incomplete. encoder
// may be null.
RLPC_API void rlpc_encoder_close(rlpc_encoder* encoder);

// The error of the last failed call; "" if none failed. Valid until the next call on the
// handle.
RLPC_API const char* rlpc_encoder_error_text(const rlpc_encoder* encoder);

// Adds the next frame: x, y and z of each vertex, in units. num_values: 3 * num_vertices.
// RLPC_BAD_INPUT: a coordinate outside the box, or more than num_frames frames; RLPC_IO_FAILED:
// the callback failed. These errors are sticky; but with low_delay, a frame that is refused is
// left out, and the stream can go on or be finished.
RLPC_API rlpc_status rlpc_encoder_add_frame(rlpc_encoder* encoder, const float* xyz,
                                            size_t num_values);
// Ends the stream, after the last frame. RLPC_BAD_INPUT: fewer than num_frames frames, or none.
// report may be null; otherwise struct_size is sizeof *report.
RLPC_API rlpc_status rlpc_encoder_finish(rlpc_encoder* encoder, rlpc_encode_report* report,
                                         size_t struct_size);
// After rlpc_encoder_finish: the input index of each decoded vertex. (With keep_order, decoders
// restore the input order.) num_values: num_vertices.
RLPC_API rlpc_status rlpc_encoder_vertex_order(rlpc_encoder* encoder, uint32_t* input_vertex,
                                               size_t num_values);

#ifdef __cplusplus
}
#endif
