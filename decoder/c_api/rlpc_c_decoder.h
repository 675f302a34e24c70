// RLPC decoder in C. C99 and C++; part of librlpc and librlpcdec.
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
// Frames are decoded one at a time, in any order. No function throws or aborts. A thread that
// calls these functions needs a stack of 64 KiB. rlpc_status.h describes versions, structures
// and the use of handles by threads.
//
// Status: functions that return rlpc_status return RLPC_OK on success. All of them can return
//   RLPC_BAD_ARGUMENT                        a handle, structure or output pointer is null, a
//                                            struct_size is invalid, or a buffer has the wrong
//                                            size; the handle remains usable
//   RLPC_OUT_OF_MEMORY, RLPC_INTERNAL_ERROR  later calls return the same; the handle can only
//                                            be closed, which releases everything
// The comment of a function lists what else it returns. A stream error is RLPC_BAD_STREAM,
// RLPC_UNSUPPORTED, RLPC_LIMIT_EXCEEDED or RLPC_IO_FAILED. Stream errors of frames are sticky
// until rlpc_decoder_seek or rlpc_decoder_frame succeeds.
//
// Memory: use is bounded by one group of frames (GOF), the shared rigs that it can refer to,
// one shared rig being replaced, four frames and max_cached_bytes (more with several threads),
// whatever the length of the stream; and by max_memory_bytes, whatever the stream declares. All
// output goes to buffers of the caller. The handle is the only object to free, and can itself
// be placed in memory of the caller (place). The decoder allocates when it opens a stream, for
// each GOF and shared rig, and for the first frame. Within a GOF, every fourth frame allocates
// temporary buffers, and the others nothing; several threads and seeking allocate more. Memory
// comes from rlpc_decode_options.allocator or from C++ operator new. With an allocator, the C
// and C++ runtimes still allocate for files, for starting threads and for error texts, and zlib
// for metadata and assets.
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
// Handle of a decoder.
typedef struct rlpc_decoder rlpc_decoder;

// Value of a limit for no limit, and of the index of a set for none.
#define RLPC_ALL UINT32_MAX

// Source of the memory of a decoder. allocate: returns null if it has no memory; alignment is a
// power of two. release: receives the size and alignment that the block was allocated with.
// With several threads, they are called concurrently. Since 1.2.
typedef struct rlpc_allocator {
  void* user;
  void* (*allocate)(void* user, size_t size, size_t alignment);
  void (*release)(void* user, void* place, size_t size, size_t alignment);
} rlpc_allocator;

// Options of a decoder. rlpc_decode_options_init sets the defaults.
typedef struct rlpc_decode_options {
  size_t struct_size;     // set by rlpc_decode_options_init
  uint32_t max_vertices;  // streams above one of these limits: RLPC_LIMIT_EXCEEDED
  uint32_t max_triangles;
  uint32_t max_frames;
  uint32_t verify_hashes;     // 1: verify the hashes of the stream; 0: do not
  uint64_t max_memory_bytes;  // default 4 GiB; includes the buffer of a pipe or device
  uint32_t threads;           // 1 to 256; positions do not depend on it
  // Reduced detail in less time (Main profile): decodes only the leading groups of
  // trajectories, and of vertex layers, whose sizes add up to at most these. RLPC_ALL: all.
  uint32_t max_components;
  uint32_t max_layers;
  // Memory for the handle: rlpc_decoder_bytes() bytes, aligned as by malloc, valid until the
  // handle is closed. Null: allocated by the library.
  void* place;
  size_t place_bytes;
  // Number of temporal layers to decode, 1 or more (High profile); dropping some drops no
  // frames. RLPC_ALL: all. Since 1.2.
  uint32_t max_temporal_layers;
  // Number of vertex layers of the coarse mesh to decode, 1 or more: num_vertices and
  // num_triangles of rlpc_stream_info, triangles and frames are then its own, and layer groups
  // that it does not need are dropped. RLPC_ALL: decodes the whole mesh. Since 1.2.
  uint32_t coarse_layers;
  // Memory for GOFs that playback has left and, within half of it, for decoded frames of inter
  // GOFs (High profile), so that returning to them decodes nothing. Estimated; part of
  // max_memory_bytes, and released where that is short. Default 64 MiB; 0: none. Since 1.2.
  uint64_t max_cached_bytes;
  // Allocator of all memory of this decoder, including a handle without a place. Both functions
  // null, the default: C++ operator new. Only librlpcdec has it; librlpc: RLPC_UNSUPPORTED.
  // Since 1.2.
  rlpc_allocator allocator;
  // 1: ignore ancillary units (attributes, the asset, clips, metadata) whose CRC or contents
  // are wrong; 0, the default: report them as errors. Since 1.2.
  uint32_t skip_damaged_units;
} rlpc_decode_options;

// Properties of a stream, as far as they are known.
typedef struct rlpc_stream_info {
  size_t struct_size;  // size passed to rlpc_decoder_info
  uint32_t profile;    // 0: Baseline, 1: Main, 2: High
  uint32_t level;
  uint32_t num_vertices;
  uint32_t num_triangles;
  uint32_t num_frames;            // 0: unknown, an open-ended stream that was cut off
  uint32_t frame_rate_numerator;  // frames per second
  uint32_t frame_rate_denominator;
  // coordinate = (position + grid_origin) * 2^grid_log2_step; positions are signed integers of
  // position_bits bits
  int32_t grid_log2_step;
  int32_t grid_origin[3];
  uint32_t position_bits;
  uint32_t has_vertex_order;  // 1: vertices are in the order of the encoder's input
  // Vertex layers of the whole mesh, the maximum of coarse_layers; 0 in the Baseline profile
  // unless coarse_layers is set. Since 1.2.
  uint32_t num_layers;
  double duration_seconds;  // from the first frame to the last; 0 if num_frames is 0; since 1.2
  // Range of the grid, in units, which bounds all frames; the exact extent is known only after
  // decoding. Since 1.2.
  float range_min[3];
  float range_max[3];  // since 1.2
} rlpc_stream_info;

// Frames of a GOF, which are decoded together. Since 1.2.
typedef struct rlpc_gof {
  uint32_t first_frame;
  uint32_t num_frames;
} rlpc_gof;

// Estimates of memory, as compared with max_memory_bytes: upper bounds of what is allocated.
// Since 1.2.
typedef struct rlpc_memory {
  size_t struct_size;     // size passed to rlpc_decoder_memory
  uint64_t stream_bytes;  // the open stream: connectivity and data derived from it, four
                          // frames per thread, metadata and clips
  uint64_t gof_bytes;     // the current GOF, without shared rigs
  uint64_t cached_bytes;  // cached GOFs with their shared rigs
} rlpc_memory;

// Source of a stream. read: fills `out` with num_bytes bytes from `offset`, always within
// `size`; returns 0 on success.
typedef struct rlpc_source {
  void* user;
  uint64_t size;  // bytes
  int (*read)(void* user, uint64_t offset, void* out, size_t num_bytes);
} rlpc_source;
// NOLINTEND(readability-identifier-naming)

// Sets all members to their defaults. struct_size: sizeof *options.
RLPC_API void rlpc_decode_options_init(rlpc_decode_options* options, size_t struct_size);

// Returns the size of a handle, for rlpc_decode_options.place.
RLPC_API size_t rlpc_decoder_bytes(void);

// Opens a stream in memory: reads up to its first GOF, including the asset to verify its CRC.
//   bytes    num_bytes of them, which must stay valid and unchanged until the handle is closed
//   options  null: the defaults
// Returns a stream error, RLPC_BAD_ARGUMENT for options out of range, or RLPC_UNSUPPORTED for
// an allocator that the library lacks. On failure, *decoder is still a handle, which holds the
// error text and must be closed; it is null only if an argument is null or invalid, or if there
// is no memory for a handle.
RLPC_API rlpc_status rlpc_decoder_open_memory(const void* bytes, size_t num_bytes,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
// Opens a file, a pipe or a device, like rlpc_decoder_open_memory. A pipe or device is read
// into memory as far as it is needed (max_memory_bytes). path: in the encoding of the system.
// Returns what rlpc_decoder_open_memory returns; RLPC_IO_FAILED if the file cannot be read.
RLPC_API rlpc_status rlpc_decoder_open_file(const char* path,
                                            const rlpc_decode_options* options,
                                            rlpc_decoder** decoder);
// Opens a stream that a callback reads, like rlpc_decoder_open_memory. Copies *source; its
// `user` must stay valid until the handle is closed. Returns what rlpc_decoder_open_memory
// returns; RLPC_IO_FAILED if the callback fails.
RLPC_API rlpc_status rlpc_decoder_open_source(const rlpc_source* source,
                                              const rlpc_decode_options* options,
                                              rlpc_decoder** decoder);
// Closes a handle and releases its memory. decoder may be null.
RLPC_API void rlpc_decoder_close(rlpc_decoder* decoder);

// Returns the error of the last failed call, or "" if none failed or a call that decodes or
// seeks has succeeded since. Valid until the next call on the handle.
RLPC_API const char* rlpc_decoder_error_text(const rlpc_decoder* decoder);

// Describes the stream. struct_size: sizeof *info. Decodes nothing.
RLPC_API rlpc_status rlpc_decoder_info(rlpc_decoder* decoder, rlpc_stream_info* info,
                                       size_t struct_size);
// Copies the vertex indices, three per triangle. num_values: 3 * num_triangles.
RLPC_API rlpc_status rlpc_decoder_triangles(rlpc_decoder* decoder, uint32_t* indices,
                                            size_t num_values);
// Copies the vertex indices as integers of index_bytes bytes, 2 or 4. num_bytes: 3 *
// num_triangles * index_bytes. Returns RLPC_BAD_ARGUMENT for 2 bytes and more than 65536
// vertices. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_indices(rlpc_decoder* decoder, void* indices,
                                          size_t num_bytes, uint32_t index_bytes);
// Copies the index in the whole mesh of each vertex of a coarse mesh, ascending. num_values:
// num_vertices. Returns RLPC_BAD_ARGUMENT without coarse_layers. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_coarse_vertices(rlpc_decoder* decoder, uint32_t* indices,
                                                  size_t num_values);
// Returns the latest metadata so far, JSON text, or "" if there was none. Valid until the next
// call on the handle.
RLPC_API const char* rlpc_decoder_metadata(const rlpc_decoder* decoder);
// Returns the number of ancillary units that were ignored so far (skip_damaged_units).
// Since 1.2.
RLPC_API uint32_t rlpc_decoder_num_damaged_units(const rlpc_decoder* decoder);
// Returns the number of clips in the latest clip table so far. Since 1.2.
RLPC_API uint32_t rlpc_decoder_num_clips(const rlpc_decoder* decoder);
// Returns a clip as the latest clip table defines it; in an open-ended stream it may end after
// the last frame. Its name is valid until the next call that decodes or seeks, and ends at the
// first zero byte. index: below the number of clips, otherwise RLPC_BAD_ARGUMENT. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_clip(rlpc_decoder* decoder, uint32_t index, rlpc_clip* clip);
// Finds the first clip with a name. Its name is valid as that of rlpc_decoder_clip. Returns
// RLPC_BAD_ARGUMENT if no clip has the name. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_find_clip(rlpc_decoder* decoder, const char* name,
                                            rlpc_clip* clip);

// Clip time: frame k of a clip is due k intervals after its start; an interval is the
// reciprocal of the frame rate. A clip of n frames thus lasts n - 1 intervals. When it repeats,
// its end is the start of the next pass: a loop whose last pose equals its first does not
// pause.
//   clip     from rlpc_decoder_clip, or any other with a first_frame below num_frames
//            (otherwise RLPC_BAD_ARGUMENT), ended with the stream; null: the whole sequence
//
// Computes the seconds from the first frame of a clip to its last. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_duration(rlpc_decoder* decoder, const rlpc_clip* clip,
                                           double* seconds);
// Computes the index in the sequence of the frame that is nearest to a time of a clip.
//   seconds  since the start of the clip; negative: 0; a NaN: RLPC_BAD_ARGUMENT
//   repeats  1: the clip restarts at its end; 0: its last pose is held
//   place    null, or receives the index with a fraction, for interpolation: 12.25 is a quarter
//            of the way from frame 12 to frame 13
// Since 1.2.
RLPC_API rlpc_status rlpc_decoder_frame_at(rlpc_decoder* decoder, const rlpc_clip* clip,
                                           double seconds, uint32_t repeats, uint32_t* frame,
                                           double* place);

// Finds the GOF of a frame below num_frames (otherwise RLPC_BAD_ARGUMENT). Reads headers of
// units, or the GOF index if the stream has one, and decodes nothing. Returns a stream error if
// they are damaged. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_gof_of(rlpc_decoder* decoder, uint32_t frame, rlpc_gof* gof);
// Finds all GOFs, like rlpc_decoder_gof_of: copies the first max_gofs of them to gofs, which
// may be null if max_gofs is 0, and sets num_gofs to their total number. Returns a stream error
// if headers or the index are damaged. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_gofs(rlpc_decoder* decoder, rlpc_gof* gofs, size_t max_gofs,
                                       uint32_t* num_gofs);

// Decodes a frame below num_frames (otherwise RLPC_BAD_ARGUMENT) at random access, in the form
// that `output` describes (rlpc_frame_output.h). The frame after it becomes the next one.
// Returns a stream error if the frame cannot be decoded.
//
// Time: proportional to the vertices; successive frames in either direction are decoded in
// bands of four per thread. The first frame of a GOF that is neither cached (max_cached_bytes)
// nor prefetched also takes parsing and preparing that GOF. In an inter GOF (High profile), a
// frame that is not cached also takes decoding the frames that it is predicted from: one or a
// few in playback order, otherwise up to the whole GOF. Memory: allocates one frame, and
// another for normals, once; and that of a GOF on entering it. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_frame(rlpc_decoder* decoder, uint32_t frame,
                                        const rlpc_frame_output* output);
// Decodes the next frame, like rlpc_decoder_frame. Returns RLPC_END after the last one, once
// the rest of the stream has been checked, or a stream error. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_next(rlpc_decoder* decoder, const rlpc_frame_output* output);
// Prepares the GOF of a frame below num_frames (otherwise RLPC_BAD_ARGUMENT). With several
// threads, reads the units of the GOF and returns; playing forward or backward prefetches
// without calls. With one thread, takes the time that its first frame would, and does nothing
// if the GOF may not be cached (max_cached_bytes). Returns a stream error if the GOF cannot be
// found; errors inside it are reported with its frames. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_prefetch(rlpc_decoder* decoder, uint32_t frame);
// Computes the bounding box of the last frame that _frame, _next, _next_floats or _blend
// decoded, in the units of the encoder's input: smallest and largest x, y and z. Reads all
// vertices; allocates nothing. Returns RLPC_BAD_ARGUMENT if no frame has been decoded.
// Since 1.2.
RLPC_API rlpc_status rlpc_decoder_bounds(rlpc_decoder* decoder, float min[3], float max[3]);
// Reports the memory in use for frames, estimated for the worst contents: usually several times
// what is allocated. Excludes attributes, drawn vertices and the asset, which take as much as
// their functions return. struct_size: sizeof *memory. Since 1.2.
RLPC_API rlpc_status rlpc_decoder_memory(rlpc_decoder* decoder, rlpc_memory* memory,
                                         size_t struct_size);

// Decodes the next frame: x, y and z of each vertex in grid units, exact and equal for all
// decoders. num_values: 3 * num_vertices. Returns RLPC_END after the last frame, once the rest
// of the stream has been checked, or a stream error. Time: as for rlpc_decoder_frame.
RLPC_API rlpc_status rlpc_decoder_next_positions(rlpc_decoder* decoder, int32_t* positions,
                                                 size_t num_values);
// Decodes the next frame, like rlpc_decoder_next_positions, in the units of the encoder's
// input. num_values: 3 * num_vertices. Returns the same.
RLPC_API rlpc_status rlpc_decoder_next_floats(rlpc_decoder* decoder, float* xyz,
                                              size_t num_values);
// Makes `frame`, below num_frames (otherwise RLPC_BAD_ARGUMENT), the next one. GOFs in between
// are not decoded. Returns a stream error if its GOF cannot be found.
RLPC_API rlpc_status rlpc_decoder_seek(rlpc_decoder* decoder, uint32_t frame);
// Returns the index of the next frame: num_frames after the last one, 0 without a stream.
RLPC_API uint32_t rlpc_decoder_position(const rlpc_decoder* decoder);

#ifdef __cplusplus
}
#endif
