// What callers of the decoder choose.
#pragma once

#include <cstdint>

#include "common/codec/bits/trace.h"
#include "common/codec/syntax/sequence_header.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// The default memory limit of DecodeLimits.
inline constexpr std::uint64_t kUsualMemoryBytes = std::uint64_t{1} << 32;

// The most that a caller will spend on one stream. Beyond it: Errc::kLimitExceeded.
struct DecodeLimits {
  std::uint32_t max_vertices = 1U << 23;
  std::uint32_t max_triangles = 1U << 24;
  std::uint32_t max_frames = kMaxFrames;
  // Estimated; includes the buffered contents of a pipe.
  std::uint64_t max_memory_bytes = kUsualMemoryBytes;
};

inline constexpr std::uint32_t kMaxThreads = 256;

struct DecoderOptions {
  DecodeLimits limits;
  bool verify_hashes = true;  // compare decoded positions with the stream's hash units
  Trace* trace = nullptr;     // not owned; receives every syntax element
  // With more than one, GOFs are prefetched, and the vertices of a layer and several frames are
  // reconstructed in parallel; positions and errors are the same. Each further thread may take
  // memory for two GOFs and the shared rigs before them, each up to max_memory_bytes /
  // threads / 2, and for four frames. Clamped to 1 to kMaxThreads.
  std::uint32_t threads = 1;
  // Decodes as if slices outside the cut were absent, which saves their time: only their CRC
  // and indices are checked. The hashes of GOFs that lose slices no longer match, and are not
  // verified. Cluster GOFs are decoded whole.
  SliceCut cut;
  // Decodes a coarse mesh (8.9.8) of this many vertex layers, at least 1: triangles() and
  // frames are its own. kAll, or as many as there are or more: the whole mesh; where it is not
  // kAll, without degenerate triangles. Slices of layer groups that it does not need are
  // dropped as by a cut.
  std::uint32_t coarse_layers = SliceCut::kAll;
  // Reads slices outside the cut, and checks their CRC. Otherwise reads their first bytes only,
  // so that a source that loads what is asked for need not load the others. Prefetching reads
  // them all.
  bool read_dropped_slices = true;
  // GOFs that have been left are kept within this much memory (estimated), and so are, within
  // half of it, decoded frames of an inter GOF. It counts towards max_memory_bytes; where
  // that is not enough, they are dropped. 0: nothing is kept.
  std::uint64_t max_cached_bytes = 0;
  // Ancillary units whose CRC or contents are wrong count as absent: damaged_units(). Otherwise
  // they are errors.
  bool skip_damaged_units = false;
  // There will be no seek(): a source that keeps what it has read can forget it.
  bool forward_only = false;
};

}  // namespace rlpc
