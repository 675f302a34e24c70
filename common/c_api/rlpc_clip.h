// RLPC in C: clips, named parts of a sequence, for rlpc_c_decoder.h and rlpc_c_encoder.h. C99
// and C++.
#pragma once

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Maximum number of clips of a stream. Since 1.2.
#define RLPC_MAX_CLIPS 4096

// NOLINTBEGIN(readability-identifier-naming): C naming.
// Named part of a sequence. Since 1.2.
typedef struct rlpc_clip {
  const char* name;  // UTF-8 without control characters, 1 to 256 bytes
  uint32_t first_frame;
  uint32_t num_frames;  // at least 1
} rlpc_clip;
// NOLINTEND(readability-identifier-naming)

#ifdef __cplusplus
}
#endif
