#include "encoder/meshes/input_notes.h"

namespace rlpc {

bool tells_loss(std::string_view note) {
  const auto has = [&](std::string_view words) { return note.find(words) != note.npos; };
  return has("dropped") || has("not carried") || has("left out") || has("ignore") ||
         has("does not read") || has("fold over") || has("is kept for all frames") ||
         note.starts_with("reading the first of") || note.starts_with("materials: ");
}

}  // namespace rlpc
