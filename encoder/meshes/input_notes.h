// Finds notes of a source that must not be missed.
#pragma once

#include <string_view>

namespace rlpc {

// Whether a note of FrameSource::notes() is about data that gets lost, rather than about how
// the input is read.
bool tells_loss(std::string_view note);

}  // namespace rlpc
