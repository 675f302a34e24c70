// One side of a comparison: any input of the encoder, or a stream, decoded on the fly.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

struct ComparisonInput {
  std::unique_ptr<FrameSource> frames;
  std::string name;                // for people: "cow.obj with cow.pc2"
  std::uint64_t stream_bytes = 0;  // size of an .rlpc file; 0: not a stream
  // Vertices are in the order of the connectivity process, not of the encoder's input.
  bool traversal_order = false;
};

// An .rlpc file is decoded to float32, with its hashes checked; x.pc2 and x.mdd take their
// triangles from x.obj (or .ply, .off) next to it; everything else is as for the encoder.
InputResult<ComparisonInput> open_comparison_input(const InputOptions& given);

// Both sides, with equal numbers of vertices and frames. x.obj alone is one frame; if the other
// side has several and x.pc2 is next to it, the cache is read too, and the name says so.
struct ComparisonPair {
  ComparisonInput a;
  ComparisonInput b;
};
InputResult<ComparisonPair> open_comparison_pair(const InputOptions& options_a,
                                                 const InputOptions& options_b);

}  // namespace rlpc
