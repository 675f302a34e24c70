// RLPC decoder in C. C99 and C++; part of librlpc.
//
//   rlpc_decoder* decoder;
//   rlpc_status status = rlpc_decoder_open_file("dance.rlpc", NULL, &decoder);
//   if (status == RLPC_OK) {
//     rlpc_stream_info info;
//     rlpc_decoder_info(decoder, &info, sizeof info);
//     const size_t length = 3 * (size_t)info.num_vertices;
//     float* xyz = malloc(length * sizeof *xyz);
//     while ((status = rlpc_decoder_next_floats(decoder, xyz, length)) == RLPC_OK) use(xyz);
//     free(xyz);
//   }
//   if (status != RLPC_END) fprintf(stderr, "%s\n", rlpc_decoder_error_text(decoder));
//   rlpc_decoder_close(decoder);
//
// Frames are decoded one by one, in any order. Memory is bounded by one group of frames (GOF),
// the shared rigs that it could use and one that is being replaced, plus four frames and
// max_cached_bytes, whatever the length of the stream, and by max_memory_bytes, whatever the
// stream claims. No function throws or aborts. A handle may be used by one thread at a time;
// different handles are independent.
//
// Memory: all output goes into the caller's buffers; the handle is the only thing to free, and
// it can live in the caller's memory as well (place). The decoder allocates when it opens a
// stream, for each GOF and shared rig, and for the first frame. Within a GOF, every fourth
// frame allocates temporary buffers, the others nothing; more with several threads, or after a
// seek. It comes from the callbacks of rlpc_decode_options.allocator, or from C++ operator new;
// whatever the callbacks are, the C and C++ runtimes allocate what they need for files, for
// starting threads, and for the text of an error, and zlib for metadata and assets. If memory
// runs out, calls return RLPC_OUT_OF_MEMORY, and the handle can only be closed, which releases
// everything. A thread that calls these functions needs a stack of 64 KiB.
#pragma once

#include <stddef.h>
#include <stdint.h>

#include "common/c_api/rlpc_clip.h"
#include "common/c_api/rlpc_status.h"
#include "decoder/c_api/rlpc_attributes.h"
#include "decoder/c_api/rlpc_frame_output.h"
#include "decoder/c_api/rlpc_pose.h"

#ifdef __cplusplus
extern "C" {
#endif

// NOLINTBEGIN(readability-identifier-naming): C naming.
typedef struct rlpc_decoder rlpc_decoder;

#define RLPC_ALL UINT32_MAX

// Where the memory of a decoder comes from. alignment: a power of two. allocate: null if there
// is none. release: with the size and alignment that the block was allocated with. With several
// threads, they are called by all of them at the same time.
typedef struct rlpc_allocator {
  void* user;
  void* (*allocate)(void* user, size_t size, size_t alignment);
  void (*release)(void* user, void* place, size_t size, size_t alignment);
} rlpc_allocator;

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
  // Memory for GOFs that have been left, and, within half of it, for decoded frames of inter
  // GOFs (High profile): going back to them takes no decoding. Estimated; part of
  // max_memory_bytes, and dropped where that is short. Default 64 MiB; 0: none.
  uint64_t max_cached_bytes;
  // Of all memory of this decoder, its handle included, unless that has a place. Both functions
  // null, the default: C++ operator new. In librlpcdec alone; librlpc: RLPC_UNSUPPORTED.
  rlpc_allocator allocator;
  // 1: ancillary units (attributes, the asset, clips, metadata) whose CRC or contents are wrong
  // count as absent; 0, the default: they are errors.
  uint32_t skip_damaged_units;
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
  double duration_seconds;  // from the first frame to the last; 0 if num_frames is
  // The coordinates that the grid has. Those of every frame are within; how much smaller the
  // animation is, only its frames tell.
  float range_min[3];
  float range_max[3];
} rlpc_stream_info;

// The frames of a GOF, which are decoded together.
typedef struct rlpc_gof {
  uint32_t first_frame;
  uint32_t num_frames;
} rlpc_gof;

// Estimated memory, as compared with max_memory_bytes; upper bounds of what is allocated.
typedef struct rlpc_memory {
  size_t struct_size;     // as passed to rlpc_decoder_memory
  uint64_t stream_bytes;  // always: connectivity, what follows from it, four frames per thread,
                          // metadata and clips
  uint64_t gof_bytes;     // of the GOF in use, without shared rigs that it shares
  uint64_t cached_bytes;  // of those kept, with their shared rigs
} rlpc_memory;

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

// Opens a stream and reads up to its first GOF, the asset included, for its CRC. options may be
// null. On failure, *decoder is still a handle, for its error text, and must be closed; it is
// null only if an argument is null or invalid, or if there is no memory for a handle.
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

// The error of the last failed call; "" if none failed, or a call that decodes or seeks has
// succeeded since. Valid until the next call on the handle.
RLPC_API const char* rlpc_decoder_error_text(const rlpc_decoder* decoder);

// struct_size: sizeof *info.
RLPC_API rlpc_status rlpc_decoder_info(rlpc_decoder* decoder, rlpc_stream_info* info,
                                       size_t struct_size);
// Copies the vertex indices, three per triangle. num_values: 3 * num_triangles.
RLPC_API rlpc_status rlpc_decoder_triangles(rlpc_decoder* decoder, uint32_t* indices,
                                            size_t num_values);
// The same as 16-bit or 32-bit integers: index_bytes is 2 or 4, num_bytes 3 * num_triangles *
// index_bytes. RLPC_BAD_ARGUMENT if 16 bits cannot hold the indices of more than 65536
// vertices.
RLPC_API rlpc_status rlpc_decoder_indices(rlpc_decoder* decoder, void* indices,
                                          size_t num_bytes, uint32_t index_bytes);
// Of a coarse mesh: copies the index of each vertex in the whole mesh, ascending. num_values:
// num_vertices. RLPC_BAD_ARGUMENT without coarse_layers.
RLPC_API rlpc_status rlpc_decoder_coarse_vertices(rlpc_decoder* decoder, uint32_t* indices,
                                                  size_t num_values);
// The latest metadata so far, JSON text; "" if there was none. Valid until the next call on the
// handle.
RLPC_API const char* rlpc_decoder_metadata(const rlpc_decoder* decoder);
// How many ancillary units have counted as absent so far (skip_damaged_units).
RLPC_API uint32_t rlpc_decoder_num_damaged_units(const rlpc_decoder* decoder);
// The clips of the latest clip table so far: their number, and one of them, as the table has
// it: in a stream of unknown length it may end after the last frame. The name is valid until
// the next call that decodes or seeks, and ends at a zero byte, if it has one. index: below the
// number, otherwise RLPC_BAD_ARGUMENT.
RLPC_API uint32_t rlpc_decoder_num_clips(const rlpc_decoder* decoder);
RLPC_API rlpc_status rlpc_decoder_clip(rlpc_decoder* decoder, uint32_t index, rlpc_clip* clip);
// Looks up a clip by its name, which several clips may have: the first of them.
// RLPC_BAD_ARGUMENT if there is none. The name in `clip` is valid as that of rlpc_decoder_clip.
RLPC_API rlpc_status rlpc_decoder_find_clip(rlpc_decoder* decoder, const char* name,
                                            rlpc_clip* clip);

// Time. Frame k of a clip is its pose k intervals after its start; an interval is the
// reciprocal of the frame rate. n frames thus take n - 1 intervals, and where a clip repeats,
// its end is the start of the next turn: a loop whose last pose is its first does not halt.
//   clip     as rlpc_decoder_clip returns it, or any other with a first_frame below num_frames
//            (otherwise RLPC_BAD_ARGUMENT); null: the whole sequence. Frames that the stream
//            does not have do not count.
//
// Computes the seconds from the first frame of a clip to its last.
RLPC_API rlpc_status rlpc_decoder_duration(rlpc_decoder* decoder, const rlpc_clip* clip,
                                           double* seconds);
// Computes which frame of the sequence is nearest to a time of a clip.
//   seconds  since the start of the clip; below 0 is 0, a NaN is RLPC_BAD_ARGUMENT
//   repeats  1: the clip starts again at its end; 0: its last pose is held
//   place    null, or receives the frame with a fraction, to interpolate: 12.25 is a quarter of
//            the way from frame 12 to frame 13
RLPC_API rlpc_status rlpc_decoder_frame_at(rlpc_decoder* decoder, const rlpc_clip* clip,
                                           double seconds, uint32_t repeats, uint32_t* frame,
                                           double* place);

// GOFs: the one of a frame below num_frames; all, into up to max_gofs places, and their number
// (gofs may be null if max_gofs is 0). They read the headers of units, from the GOF index on if
// the stream has one, and decode nothing.
RLPC_API rlpc_status rlpc_decoder_gof_of(rlpc_decoder* decoder, uint32_t frame, rlpc_gof* gof);
RLPC_API rlpc_status rlpc_decoder_gofs(rlpc_decoder* decoder, rlpc_gof* gofs, size_t max_gofs,
                                       uint32_t* num_gofs);

// Decodes a frame below num_frames, whatever came before, in the form that `output` describes
// (rlpc_frame_output.h); the frame after it is then the next.
//
// Time: per vertex, what the profile takes, in bands of four frames per thread where calls
// follow each other in either direction. The first frame of a GOF that is neither kept
// (max_cached_bytes) nor prefetched takes parsing and preparing that GOF as well. In an inter
// GOF (High profile), a frame that is not kept takes decoding all that it is predicted from:
// going on, one or a few frames; elsewhere, up to the whole GOF. Memory: one frame, a further
// one with normals, once; that of GOFs when one is entered.
RLPC_API rlpc_status rlpc_decoder_frame(rlpc_decoder* decoder, uint32_t frame,
                                        const rlpc_frame_output* output);
// The same for the next frame. RLPC_END after the last one, once the rest of the stream has
// been checked.
RLPC_API rlpc_status rlpc_decoder_next(rlpc_decoder* decoder, const rlpc_frame_output* output);
// Prepares the GOF of a frame. With several threads, it reads the units of the GOF, and
// returns; playing forward or backward prefetches by itself. With one thread, it takes the time
// that the first frame would, and does nothing if the GOF may not be kept (max_cached_bytes).
// An error of the GOF is reported when its frames are asked for.
RLPC_API rlpc_status rlpc_decoder_prefetch(rlpc_decoder* decoder, uint32_t frame);
// The box of the last frame that _frame, _next or _next_floats decoded, in the units of the
// encoder's input. Reads all vertices; allocates nothing. RLPC_BAD_ARGUMENT if there is none.
RLPC_API rlpc_status rlpc_decoder_bounds(rlpc_decoder* decoder, float least[3], float most[3]);
// The memory that decoding frames needs now, estimated for the worst contents: usually several
// times what is allocated. Without attributes, drawn vertices and the asset, which are as large
// as what their functions give. struct_size: sizeof *memory.
RLPC_API rlpc_status rlpc_decoder_memory(rlpc_decoder* decoder, rlpc_memory* memory,
                                         size_t struct_size);

// Decodes the next frame: x, y and z of each vertex. num_values: 3 * num_vertices. RLPC_END
// after the last frame, once the rest of the stream has been checked. Stream errors are sticky
// until rlpc_decoder_seek or _frame succeeds.
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
