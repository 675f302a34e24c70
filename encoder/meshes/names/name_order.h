// Decides which way to read the numbers of names yields the order of the frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/names/frame_reading.h"

namespace rlpc {

// At most one of the first three is set; none: the names do not differ in one number.
struct NameOrder {
  std::optional<Reading> chosen{};
  std::vector<Reading> rivals{};       // have different orders and can all be meant
  std::optional<Reading> doubtful{};   // has all names, perhaps of several sequences
  std::optional<Reading> twice{};      // gives several names one number
  std::optional<Reading> pointless{};  // the chosen one as fractions without a point
  std::optional<Reading> unlikely{};   // takes hyphens for signs, unlike the chosen one
};

// Compares these readings: numbers with fractions, a counter after a point, and each with
// hyphens as signs or separators. If their orders differ, chooses the only one that a program
// can have written, or that has equal steps. The result refers to the texts of the names.
NameOrder find_order(const std::vector<std::string>& names);

}  // namespace rlpc
