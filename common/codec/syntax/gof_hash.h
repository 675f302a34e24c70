// 6.7 GOF hash.
#pragma once

#include <cstdint>

#include "common/memory/owned.h"

namespace rlpc {

struct GofHash {
  bool per_frame_flag = false;
  Vector<std::uint32_t> position_crc;  // one per frame, or one for the GOF
};

}  // namespace rlpc
