// Lists the searches; encode() keeps the best result.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/codec/settings.h"

namespace rlpc {

struct Search {
  EncoderSettings settings;
  // Whether it ends early if it cannot be expected to beat the best result so far.
  bool may_be_given_up = false;
  double duration = 1.0;  // expected, relative to others
};

// Returns at least one; the first is that of the settings. With preset slow, those of medium
// are added: the choices of slow, which are better for each GOF, may by chance be worse at the
// target. If all tools are left to the encoder, the searches of the profiles that the profile
// contains follow where they take little time: their streams can also be written in this
// profile, so its streams are never much larger.
std::vector<Search> list_searches(const EncoderSettings& settings, std::uint32_t num_vertices,
                                  std::uint32_t num_frames);

}  // namespace rlpc
