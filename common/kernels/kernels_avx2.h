// Twins of the plain loops of tile_loops.cpp.
#pragma once

#include "common/kernels/kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define RLPC_HAVE_AVX2_LOOPS

namespace rlpc {

// For machines that have AVX2.
extern const TileLoops kTileLoopsAvx2;

}  // namespace rlpc

#endif
