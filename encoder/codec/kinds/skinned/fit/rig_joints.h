// Joints of a rig that need no values of their own.
#pragma once

#include "encoder/codec/spans/rig.h"

namespace rlpc {

// Pins bones to their parents, and lets them turn with their parents, where each of these is
// expected to raise the squared error over all frames by at most `max_error`. Poses stay as
// they are.
void fix_joints(double max_error, Rig& rig);

}  // namespace rlpc
