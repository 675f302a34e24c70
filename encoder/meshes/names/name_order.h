// Decides which of the ways to read the numbers of names gives the order of the frames.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/names/frame_reading.h"

namespace rlpc {

// At most one of the first three is set; none: the names do not differ in one number.
struct NameOrder {
  std::optional<Reading> chosen{};
  std::vector<Reading> rivals{};       // with different orders, that can all be meant
  std::optional<Reading> doubtful{};   // has all names, of several sequences perhaps
  std::optional<Reading> twice{};      // gives several names one number
  std::optional<Reading> pointless{};  // what is chosen as fractions, without a point
  std::optional<Reading> unlikely{};   // takes hyphens for signs that the chosen one does not
};

// The readings are: numbers with fractions, a counter after a point, and each with hyphens as
// signs or separators. Where they differ in the order, the one is chosen that alone can be
// written so, or alone has equal steps. It refers to the texts of the names.
NameOrder find_order(const std::vector<std::string>& names);

}  // namespace rlpc
