#include "common/codec/mesh/indices.h"

#include <algorithm>
#include <span>

namespace rlpc {

void sort_without_repetitions(Vector<std::uint32_t>& indices) {
  // Sorts a span, as other code does, so that librlpcdec has one sort of indices, not two.
  const std::span all(indices);
  std::sort(all.begin(), all.end());
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
}

}  // namespace rlpc
