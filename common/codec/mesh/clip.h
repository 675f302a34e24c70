// Clips: named parts of a sequence (clause 7.15).
#pragma once

#include <cstddef>
#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

struct Clip {
  String name;  // UTF-8 without control characters, 1 to kMaxClipNameBytes bytes
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;  // at least 1

  std::uint32_t last_frame() const { return first_frame + num_frames - 1; }
  bool operator==(const Clip&) const = default;
};

inline constexpr std::uint32_t kMaxClips = 4096;  // per clip table (R-CLP-01)
inline constexpr std::size_t kMaxClipNameBytes = 256;

// Returns the offset of the first invalid byte of the name of a clip: not well-formed UTF-8
// (RFC 3629), or part of a control character; the size of the name if it is valid.
std::size_t find_clip_name_error(const String& name);

}  // namespace rlpc
