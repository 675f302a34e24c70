// Measures how regular the numbers of a sequence are.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/meshes/names/frame_reading.h"

namespace rlpc {

enum class Regularity : std::uint8_t {
  kEqualSteps,  // within the rounding of the last decimal that is written
  kFewGaps,     // multiples of one step, fewer missing than present
  kIrregular,
};

struct FrameSteps {
  std::vector<double> values;        // values of the names, ascending
  std::vector<std::size_t> gaps;     // ascending; g: a gap between values g and g + 1
  double step = 0.0;                 // 0: only one value
  bool is_rounded = false;           // the steps are only equal if numbers are rounded
  bool crosses_whole_frame = false;  // in one step, as from 0.9 to 1.0
  Regularity regularity = Regularity::kEqualSteps;
};

// Returns the steps. Numbers with fractions may be rounded or cut off after any decimal, and
// have one with six significant digits or without zeros at their ends.
FrameSteps steps_of(const Reading& reading);

}  // namespace rlpc
