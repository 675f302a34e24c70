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
// Frames go in one by one; memory stays within one group of frames (GOF) and its analysis. Each
// GOF is encoded, and its bytes are given to the caller, when its last frame is there; that
// call takes nearly all of the time. Each GOF meets the target by itself, and so does the whole
// stream (frame_encoder.h says how). The same frames and options give the same bytes on every
// machine. Nothing throws or ends the process. A handle is used by one thread at a time;
// different handles are independent.
//
// Memory: frames, bytes and reports are in buffers of the caller or only shown to him, who has
// nothing to free but the handle, which can stand in memory of the caller as well (place). What
// the analysis needs it takes with the allocator of C++; it cannot be given another one. If
// memory ends, calls return RLPC_OUT_OF_MEMORY, and the handle can only be closed, which gives
// all of it back.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): names as they are usual in C.
typedef struct rlpc_encoder rlpc_encoder;

// What has to be known before the first frame.
typedef struct rlpc_frame_format {
  size_t struct_size;             // rlpc_frame_format_init sets it
  uint32_t num_vertices;          // at least 1
  uint32_t num_triangles;         // 0: a point cloud
  const uint32_t* indices;        // 3 * num_triangles, each below num_vertices; copied
  uint32_t num_frames;            // at least 1; as many have to come
  uint32_t frame_rate_numerator;  // frames per second: 30 / 1 by default
  uint32_t frame_rate_denominator;
  // Within 2^100, and no coordinate of any frame is outside. A box that is far too large makes
  // the grid coarser.
  float box_min[3];
  float box_max[3];
} rlpc_frame_format;

typedef enum rlpc_profile { RLPC_BASELINE = 0, RLPC_MAIN = 1 } rlpc_profile;

typedef enum rlpc_preset { RLPC_FAST = 0, RLPC_MEDIUM = 1, RLPC_SLOW = 2 } rlpc_preset;

typedef enum rlpc_target {
  RLPC_TARGET_KG = 1,         // KG error in per cent
  RLPC_TARGET_BPVF = 2,       // bits per vertex and frame
  RLPC_TARGET_MAX_ERROR = 3,  // largest distance of a vertex from its original, in units
} rlpc_target;

typedef enum rlpc_hash_mode {
  RLPC_HASH_NONE = 0,
  RLPC_HASH_GOF = 1,
  RLPC_HASH_FRAME = 2,
} rlpc_hash_mode;

typedef struct rlpc_encode_options {
  size_t struct_size;    // rlpc_encode_options_init sets it
  uint32_t profile;      // RLPC_MAIN by default
  uint32_t preset;       // RLPC_MEDIUM
  uint32_t target;       // RLPC_TARGET_KG: reached from below, within 2 % where it can be
  double target_value;   // 0.1; above zero and finite
  uint32_t gof_frames;   // longest GOF; 0: 128. UINT32_MAX: one GOF, of all frames
  uint32_t components;   // of a GOF (Main) or cluster (Baseline), up to 1024; 0: chosen
  uint32_t keep_order;   // 1: restore the order of vertices that the frames have here; or 0
  uint32_t hash_mode;    // RLPC_HASH_GOF
  uint32_t least_level;  // 1; more where an error asks for it
  // JSON text to carry along, not checked, up to 1 MiB; null: none. Copied.
  const char* metadata;
  // Memory for the handle, of rlpc_encoder_bytes() bytes and aligned as that of malloc, which
  // must stay until the handle is closed. Null: it is allocated.
  void* place;
  size_t place_bytes;
  uint64_t max_memory_bytes;  // beyond it: RLPC_LIMIT_EXCEEDED. 32 GiB by default; estimated
} rlpc_encode_options;

typedef struct rlpc_encode_report {
  size_t struct_size;  // as given to rlpc_encoder_finish
  uint64_t num_bytes;
  double bpvf;  // bits per vertex and frame, everything counted
  double kg_error_percent;
  double rms_error;  // units
  double max_error;
  uint32_t num_gofs;
  uint32_t level;
  uint32_t target_met;  // 1: by every GOF
} rlpc_encode_report;

// Takes the next bytes of the stream. Returns 0, or another value if they could not be written.
typedef int (*rlpc_write_function)(void* user, const void* bytes, size_t num_bytes);
// NOLINTEND(readability-identifier-naming)

// Set all to the defaults, or zero. struct_size: that of the structure.
RLPC_API void rlpc_frame_format_init(rlpc_frame_format* format, size_t struct_size);
RLPC_API void rlpc_encode_options_init(rlpc_encode_options* options, size_t struct_size);

// What a handle takes in memory of the caller.
RLPC_API size_t rlpc_encoder_bytes(void);

// Begins a stream. options may be null. *encoder is a handle also if that fails, for its error
// text, and is to be closed; it is null if an argument is null or wrong, or without memory for
// a handle. RLPC_BAD_INPUT: no such stream can be; RLPC_LIMIT_EXCEEDED: encoding it may need
// more than max_memory_bytes.
RLPC_API rlpc_status rlpc_encoder_create(const rlpc_frame_format* format,
                                         const rlpc_encode_options* options,
                                         rlpc_write_function write, void* user,
                                         rlpc_encoder** encoder);
// A stream that is not finished is no whole stream. encoder may be null.
RLPC_API void rlpc_encoder_close(rlpc_encoder* encoder);

// Of the last call that failed; "" if none did. Until the next call for the handle.
RLPC_API const char* rlpc_encoder_error_text(const rlpc_encoder* encoder);

// The next frame: x, y and z of each vertex, in units. num_values: 3 * num_vertices.
// RLPC_BAD_INPUT: a coordinate outside the box, or more frames than announced; RLPC_IO_FAILED:
// the caller's function failed. These errors stand: later calls return them again.
RLPC_API rlpc_status rlpc_encoder_add_frame(rlpc_encoder* encoder, const float* xyz,
                                            size_t num_values);
// After the last frame: ends the stream. RLPC_BAD_INPUT: there are fewer frames than announced.
// report may be null, else struct_size is sizeof *report.
RLPC_API rlpc_status rlpc_encoder_finish(rlpc_encoder* encoder, rlpc_encode_report* report,
                                         size_t struct_size);
// After rlpc_encoder_finish: of each vertex as it is decoded, its index in the frames given
// here (unless keep_order was set, with which they come out in the order of these). num_values:
// num_vertices.
RLPC_API rlpc_status rlpc_encoder_vertex_order(rlpc_encoder* encoder, uint32_t* input_vertex,
                                               size_t num_values);

#ifdef __cplusplus
}
#endif
