#include "common/codec/mesh/clip.h"

#include "common/memory/owned.h"

namespace rlpc {
namespace {

bool is_continuation(unsigned char byte) { return (byte & 0xC0U) == 0x80U; }

// Returns the bytes of the character at a place; 0 if it is invalid or a control character.
std::size_t character_at(const String& text, std::size_t at) {
  const auto byte = [&](std::size_t i) -> unsigned char {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned char first = byte(0);
  if (first < 0x80U) return first >= 0x20U && first != 0x7FU ? 1 : 0;
  const std::size_t size = first >= 0xC2U && first < 0xE0U   ? 2
                           : first >= 0xE0U && first < 0xF0U ? 3
                           : first >= 0xF0U && first < 0xF5U ? 4
                                                             : 0;
  for (std::size_t i = 1; i < size; ++i) {
    if (!is_continuation(byte(i))) return 0;
  }
  const unsigned char second = byte(1);
  const bool is_control = first == 0xC2U && second < 0xA0U;
  const bool is_overlong =
      (first == 0xE0U && second < 0xA0U) || (first == 0xF0U && second < 0x90U);
  const bool is_surrogate = first == 0xEDU && second >= 0xA0U;
  const bool is_beyond = first == 0xF4U && second >= 0x90U;
  return is_control || is_overlong || is_surrogate || is_beyond ? 0 : size;
}

}  // namespace

std::size_t find_clip_name_error(const String& name) {
  std::size_t at = 0;
  while (at < name.size()) {
    const std::size_t size = character_at(name, at);
    if (size == 0) break;
    at += size;
  }
  return at;
}

}  // namespace rlpc
