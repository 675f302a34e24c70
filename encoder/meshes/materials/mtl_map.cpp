#include "encoder/meshes/materials/mtl_map.h"

#include <optional>
#include <string_view>
#include <vector>

namespace rlpc {
namespace {

// Returns the number of words after an option; none: it is no option.
std::optional<std::size_t> count_of_option(std::string_view word) {
  for (const char* const one : {"-blendu", "-blendv", "-bm", "-boost", "-cc", "-clamp",
                                "-imfchan", "-texres", "-type"}) {
    if (word == one) return 1;
  }
  if (word == "-mm") return 2;
  return std::nullopt;
}

}  // namespace

MtlMap read_mtl_map(TextWords& words) {
  std::vector<std::string_view> all;
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    all.push_back(word);
  }
  MtlMap map;
  std::size_t at = 0;
  while (at < all.size()) {
    const std::string_view option = all[at];
    if (const auto count = count_of_option(option)) {
      at += 1 + *count;
      continue;
    }
    if (option != "-s" && option != "-o" && option != "-t") break;
    // Take one to three numbers; the name comes last.
    ++at;
    for (std::size_t c = 0; c < 3 && at + 1 < all.size(); ++c, ++at) {
      const auto value = parse_number(all[at]);
      if (!value) break;
      if (c < 2 && option == "-s") map.scale[c] = *value;
      if (c < 2 && option == "-o") map.offset[c] = *value;
    }
  }
  for (; at < all.size(); ++at) {
    if (!map.name.empty()) map.name += ' ';
    map.name += all[at];
  }
  return map;
}

}  // namespace rlpc
