// Lists the searches of which encode() keeps the best result.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/codec/settings.h"

namespace rlpc {

struct Search {
  EncoderSettings settings;
  // Whether it ends early where it has no prospect of beating the best result so far.
  bool may_be_given_up = false;
  double duration = 1.0;  // expected, relative to others
};

// At least one; the first is that of the settings. With preset slow, there are those of medium
// besides: its own choices, which are better for each GOF, may by chance be worse at the
// target. If all tools are left to the encoder, the searches of the profiles that the profile
// contains follow: what these would write can be written in the profile, too, so that it is
// never much larger.
std::vector<Search> list_searches(const EncoderSettings& settings, std::uint32_t num_vertices,
                                  std::uint32_t num_frames);

}  // namespace rlpc
