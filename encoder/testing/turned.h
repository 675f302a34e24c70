// Positions along other axes, for tests.
#pragma once

#include <string>
#include <vector>

#include "encoder/meshes/axes.h"

namespace rlpc {

// axes: as an option of the encoder has them, such as "x,z,-y".
inline std::vector<float> turned(const std::string& axes, std::vector<float> xyz) {
  turn(*parse_axes(axes), xyz);
  return xyz;
}

}  // namespace rlpc
