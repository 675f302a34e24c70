// RLPC decoder in C. C99 and C++; part of librlpc.
//
//   rlpc_decoder* decoder;
//   rlpc_status status = rlpc_decoder_open_file("dance.rlpc", NULL, &decoder);
//   if (status == RLPC_OK) {
//     rlpc_stream_info info;
//     rlpc_decoder_info(decoder, &info, sizeof info);
//     float* xyz = malloc(3 * (size_t)info.num_vertices * sizeof *xyz);
//     while ((status = rlpc_decoder_next_floats(decoder, xyz, 3 * info.num_vertices)) ==
//     RLPC_OK)
//       use(xyz);
//     free(xyz);
//   }
//   if (status != RLPC_END) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
//   rlpc_decoder_close(decoder);
//
// Frames come out one by one; memory stays within one group of frames (GOF) and four frames,
// whatever the length of the stream, and below max_memory_bytes whatever it claims. Nothing
// throws or ends the process. A handle is used by one thread at a time; different handles are
// independent.
//
// Memory: everything that comes out goes into buffers of the caller, who has nothing to free
// but the handle, which can stand in memory of the caller as well (place). What the decoder
// keeps it takes with the allocator of C++, and it cannot be given another: when it opens a
// stream, for each GOF, and for the first frame. Within a GOF, frames take nothing but, every
// fourth, one buffer for the moment; more with several threads, or after a seek. If memory
// ends, calls return RLPC_OUT_OF_MEMORY, and the handle can only be closed, which gives all of
// it back.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): names as they are usual in C.
typedef struct rlpc_decoder rlpc_decoder;

#define RLPC_ALL UINT32_MAX

typedef struct rlpc_decode_options {
  size_t struct_size;     // rlpc_decode_options_init sets it
  uint32_t max_vertices;  // beyond these: RLPC_LIMIT_EXCEEDED
  uint32_t max_triangles;
  uint32_t max_frames;
  uint32_t verify_hashes;  // 1: compare decoded positions with the hashes of the stream; or 0
  uint64_t max_memory_bytes;  // 4 GiB by default; with what is kept of a pipe or a device
  uint32_t threads;           // 1 to 256, else RLPC_BAD_ARGUMENT; positions are the same
  // Less detail in less time (Main profile): as many groups of trajectories, and of vertex
  // layers, as have no more than these together. RLPC_ALL: all.
  uint32_t max_components;
  uint32_t max_layers;
  // Memory for the handle, of rlpc_decoder_bytes() bytes and aligned as that of malloc, which
  // must stay until the handle is closed. Null: it is allocated.
  void* place;
  size_t place_bytes;
} rlpc_decode_options;

typedef struct rlpc_stream_info {
  size_t struct_size;  // as given to rlpc_decoder_info
  uint32_t profile;    // 0: Baseline, 1: Main
  uint32_t level;
  uint32_t num_vertices;
  uint32_t num_triangles;
  uint32_t num_frames;
  uint32_t frame_rate_numerator;  // frames per second
  uint32_t frame_rate_denominator;
  // coordinate = (position + grid_origin) * 2^grid_log2_step, positions of position_bits with
  // sign
  int32_t grid_log2_step;
  int32_t grid_origin[3];
  uint32_t position_bits;
  uint32_t has_vertex_order;  // 1: vertices are in the order of the encoder's input
} rlpc_stream_info;

// Where a stream is read from. read: fills `out` with num_bytes bytes from `offset`, which are
// always within `size`; returns 0, or another value if it fails.
typedef struct rlpc_source {
  void* user;
  uint64_t size;  // bytes
  int (*read)(void* user, uint64_t offset, void* out, size_t num_bytes);
} rlpc_source;
// NOLINTEND(readability-identifier-naming)

// Sets all to the defaults. struct_size: sizeof *options.
RLPC_API void rlpc_decode_options_init(rlpc_decode_options* options, size_t struct_size);

// What a handle takes in memory of the caller.
RLPC_API size_t rlpc_decoder_bytes(void);

// Opens a stream, and reads up to its first GOF. options may be null. *decoder is a handle also
// if that fails, for its error text, and is to be closed; it is null if an argument is null or
// wrong, or without memory for a handle.
//
// _memory: the bytes must stay as they are until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_open_memory(const void* bytes, size_t num_bytes,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
RLPC_API rlpc_status rlpc_decoder_open_file(const char* path,
                                            const rlpc_decode_options* options,
                                            rlpc_decoder** decoder);
// *source is copied; its user must stay until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_open_source(const rlpc_source* source,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
RLPC_API void rlpc_decoder_close(rlpc_decoder* decoder);  // may be null

// Of the last call that failed; "" if none did. Until the next call for the handle.
RLPC_API const char* rlpc_decoder_error_text(const rlpc_decoder* decoder);

// struct_size: sizeof *info.
RLPC_API rlpc_status rlpc_decoder_info(rlpc_decoder* decoder, rlpc_stream_info* info,
                                       size_t struct_size);
// Vertex indices, three a triangle. num_values: 3 * num_triangles.
RLPC_API rlpc_status rlpc_decoder_triangles(rlpc_decoder* decoder, uint32_t* indices,
                                            size_t num_values);
// The last metadata so far, JSON text; "" if there was none. Until the next call for the
// handle.
RLPC_API const char* rlpc_decoder_metadata(const rlpc_decoder* decoder);

// The next frame: x, y and z of each vertex. num_values: 3 * num_vertices. RLPC_END after the
// last frame, once the rest of the stream has been checked. An error of the stream comes again
// until rlpc_decoder_seek succeeds.
//
// _positions: exact, in grid units; what every decoder gives.
// _floats: in the units of the encoder's input.
RLPC_API rlpc_status rlpc_decoder_next_positions(rlpc_decoder* decoder, int32_t* positions,
                                                 size_t num_values);
RLPC_API rlpc_status rlpc_decoder_next_floats(rlpc_decoder* decoder, float* xyz,
                                              size_t num_values);
// Makes `frame`, from 0 and below num_frames, the next one. GOFs in between are not decoded.
RLPC_API rlpc_status rlpc_decoder_seek(rlpc_decoder* decoder, uint32_t frame);
// The frame that comes next, from 0; num_frames after the last one. 0 without a stream.
RLPC_API uint32_t rlpc_decoder_position(const rlpc_decoder* decoder);

#ifdef __cplusplus
}
#endif
