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
// Frames are decoded one by one. Memory is bounded by one group of frames (GOF), the skinned
// models that it could use and one that is being replaced, plus four frames, whatever the
// length of the stream, and by max_memory_bytes, whatever the stream claims. No function throws
// or aborts. A handle may be used by one thread at a time; different handles are independent.
//
// Memory: all output goes into the caller's buffers; the handle is the only thing to free, and
// it can live in the caller's memory as well (place). Internally the decoder allocates with C++
// operator new, without a hook for other allocators: when it opens a stream, for each GOF and
// skinned model, and for the first frame. Within a GOF, every fourth frame allocates one
// temporary buffer, the others nothing; more with several threads, or after a seek. If memory
// runs out, calls return RLPC_OUT_OF_MEMORY, and the handle can only be closed, which releases
// everything.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_clip.h"
#include "common/c_api/rlpc_status.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
typedef struct rlpc_decoder rlpc_decoder;

#define RLPC_ALL UINT32_MAX

typedef struct rlpc_decode_options {
  size_t struct_size;     // rlpc_decode_options_init sets it
  uint32_t max_vertices;  // exceeding one of these: RLPC_LIMIT_EXCEEDED
  uint32_t max_triangles;
  uint32_t max_frames;
  uint32_t verify_hashes;  // 1: verify the hashes of the stream; 0: do not
  uint64_t
      max_memory_bytes;  // default 4 GiB; includes the buffered contents of a pipe or device
  uint32_t threads;      // 1 to 256, otherwise RLPC_BAD_ARGUMENT; positions do not depend on it
  // Less detail in less time (Main profile): only the leading groups of trajectories, and of
  // vertex layers, whose sizes add up to at most these. RLPC_ALL: all.
  uint32_t max_components;
  uint32_t max_layers;
  // Memory for the handle: rlpc_decoder_bytes() bytes, aligned as by malloc, valid until the
  // handle is closed. Null: allocated by the library.
  void* place;
  size_t place_bytes;
  // High profile: only the first temporal layers, 1 or more; all frames are there. RLPC_ALL:
  // all.
  uint32_t max_temporal_layers;
  // A coarse mesh of this many vertex layers, 1 or more: num_vertices and num_triangles of
  // rlpc_stream_info, triangles and frames are its own. RLPC_ALL: the whole mesh. Layer groups
  // that it does not need are dropped.
  uint32_t coarse_layers;
} rlpc_decode_options;

typedef struct rlpc_stream_info {
  size_t struct_size;  // as passed to rlpc_decoder_info
  uint32_t profile;    // 0: Baseline, 1: Main, 2: High
  uint32_t level;
  uint32_t num_vertices;
  uint32_t num_triangles;
  // Of an open-ended stream, that at its end; 0: not known, as the stream has been cut off.
  uint32_t num_frames;
  uint32_t frame_rate_numerator;  // frames per second
  uint32_t frame_rate_denominator;
  // coordinate = (position + grid_origin) * 2^grid_log2_step, positions of position_bits with
  // sign
  int32_t grid_log2_step;
  int32_t grid_origin[3];
  uint32_t position_bits;
  uint32_t has_vertex_order;  // 1: vertices are in the order of the encoder's input
  // Vertex layers of the whole mesh, of which coarse_layers can select fewer; 0 in the Baseline
  // profile unless coarse_layers is set.
  uint32_t num_layers;
} rlpc_stream_info;

// Where a stream is read from. read: fills `out` with num_bytes bytes from `offset`, always
// within `size`; returns 0 on success.
typedef struct rlpc_source {
  void* user;
  uint64_t size;  // bytes
  int (*read)(void* user, uint64_t offset, void* out, size_t num_bytes);
} rlpc_source;
// NOLINTEND(readability-identifier-naming)

// Sets all members to their defaults. struct_size: sizeof *options.
RLPC_API void rlpc_decode_options_init(rlpc_decode_options* options, size_t struct_size);

// Size of a handle, for rlpc_decode_options.place.
RLPC_API size_t rlpc_decoder_bytes(void);

// Opens a stream and reads up to its first GOF. options may be null. On failure, *decoder is
// still a handle, for its error text, and must be closed; it is null only if an argument is
// null or invalid, or if there is no memory for a handle.
//
// _memory: the bytes must stay valid and unchanged until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_open_memory(const void* bytes, size_t num_bytes,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
RLPC_API rlpc_status rlpc_decoder_open_file(const char* path,
                                            const rlpc_decode_options* options,
                                            rlpc_decoder** decoder);
// *source is copied; its `user` must stay valid until the handle is closed.
RLPC_API rlpc_status rlpc_decoder_open_source(const rlpc_source* source,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
RLPC_API void rlpc_decoder_close(rlpc_decoder* decoder);  // may be null

// The error of the last failed call; "" if none failed. Valid until the next call on the
// handle.
RLPC_API const char* rlpc_decoder_error_text(const rlpc_decoder* decoder);

// struct_size: sizeof *info.
RLPC_API rlpc_status rlpc_decoder_info(rlpc_decoder* decoder, rlpc_stream_info* info,
                                       size_t struct_size);
// Copies the vertex indices, three per triangle. num_values: 3 * num_triangles.
RLPC_API rlpc_status rlpc_decoder_triangles(rlpc_decoder* decoder, uint32_t* indices,
                                            size_t num_values);
// Of a coarse mesh: copies the index of each vertex in the whole mesh, ascending. num_values:
// num_vertices. RLPC_BAD_ARGUMENT without coarse_layers.
RLPC_API rlpc_status rlpc_decoder_coarse_vertices(rlpc_decoder* decoder, uint32_t* indices,
                                                  size_t num_values);
// The latest metadata so far, JSON text; "" if there was none. Valid until the next call on the
// handle.
RLPC_API const char* rlpc_decoder_metadata(const rlpc_decoder* decoder);
// The clips of the latest clip table so far: their number, and one of them. The name is valid
// until the next call that decodes or seeks, and ends at a zero byte, if it has one. index:
// below the number, otherwise RLPC_BAD_ARGUMENT.
RLPC_API uint32_t rlpc_decoder_num_clips(const rlpc_decoder* decoder);
RLPC_API rlpc_status rlpc_decoder_clip(rlpc_decoder* decoder, uint32_t index, rlpc_clip* clip);

// Decodes the next frame: x, y and z of each vertex. num_values: 3 * num_vertices. RLPC_END
// after the last frame, once the rest of the stream has been checked. Stream errors are sticky
// until rlpc_decoder_seek succeeds.
//
// _positions: exact, in grid units, the same from every decoder. _floats: in the units of the
// encoder's input.
RLPC_API rlpc_status rlpc_decoder_next_positions(rlpc_decoder* decoder, int32_t* positions,
                                                 size_t num_values);
RLPC_API rlpc_status rlpc_decoder_next_floats(rlpc_decoder* decoder, float* xyz,
                                              size_t num_values);
// Makes `frame` (0 to num_frames - 1) the next one. GOFs in between are not decoded.
RLPC_API rlpc_status rlpc_decoder_seek(rlpc_decoder* decoder, uint32_t frame);
// Index of the next frame, from 0; num_frames after the last one. 0 without a stream.
RLPC_API uint32_t rlpc_decoder_position(const rlpc_decoder* decoder);

#ifdef __cplusplus
}
#endif
