// Options and limits of the decoder.
#pragma once

#include <cstdint>

#include "common/codec/bits/trace.h"
#include "common/codec/syntax/sequence_header.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// Default memory limit of DecodeLimits.
inline constexpr std::uint64_t kUsualMemoryBytes = std::uint64_t{1} << 32;

// Limits that a caller sets to one stream. Beyond them: Errc::kLimitExceeded.
struct DecodeLimits {
  std::uint32_t max_vertices = 1U << 23;
  std::uint32_t max_triangles = 1U << 24;
  std::uint32_t max_frames = kMaxFrames;
  // Limit of estimates; includes the buffered contents of a pipe.
  std::uint64_t max_memory_bytes = kUsualMemoryBytes;
};

inline constexpr std::uint32_t kMaxThreads = 256;

struct DecoderOptions {
  DecodeLimits limits;
  bool verify_hashes = true;  // compare decoded positions with the stream's hash units
  Trace* trace = nullptr;     // not owned; receives every syntax element
  // Number of threads, clamped to 1 to kMaxThreads. More than one prefetch GOFs, and
  // reconstruct the vertices of a layer and several frames in parallel; positions and errors
  // are the same. Each further thread may take memory for two GOFs and the shared rigs before
  // them, each up to max_memory_bytes / threads / 2, and for four frames.
  std::uint32_t threads = 1;
  // Slices to decode. Slices outside the cut are treated as absent, which saves their time:
  // only their CRC and indices are checked. The hashes of GOFs that lose slices no longer
  // match, and are not verified. Cluster GOFs are decoded whole.
  SliceCut cut;
  // Vertex layers of the coarse mesh to decode (8.9.8), at least 1; triangles() and frames are
  // then its own. kAll, or at least the number of layers: the whole mesh; unless kAll, without
  // degenerate triangles. Slices of unneeded layer groups are dropped as by a cut.
  std::uint32_t coarse_layers = SliceCut::kAll;
  // True: reads slices outside the cut, and checks their CRC. False: reads only their first
  // bytes, so that a source that loads bytes on demand need not load the rest. Prefetching
  // reads them all.
  bool read_dropped_slices = true;
  // Memory (estimated) for GOFs that playback has left and, within half of it, for decoded
  // frames of an inter GOF. Part of max_memory_bytes, and released where that is short. 0:
  // none.
  std::uint64_t max_cached_bytes = 0;
  // True: ignores ancillary units whose CRC or contents are wrong, and lists them in
  // damaged_units(). False: they are errors.
  bool skip_damaged_units = false;
  // True: seek() is never called, and a source that keeps what it has read can forget it.
  bool forward_only = false;
};

}  // namespace rlpc
