#include "common/files/messages.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <optional>

namespace rlpc {
namespace {

struct Character {
  std::uint32_t code = 0;
  std::size_t bytes = 1;
};

// Decodes the first character; none if it is invalid UTF-8.
std::optional<Character> first_character(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned lead = byte(0);
  if (lead < 0x80) return Character{lead, 1};
  const std::size_t bytes = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : 2;
  if (lead < 0xC2 || lead > 0xF4 || bytes > text.size()) return std::nullopt;
  std::uint32_t code = lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0) != 0x80) return std::nullopt;
    code = code << 6 | (byte(i) & 0x3F);
  }
  constexpr std::array<std::uint32_t, 5> kMinCode{0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  if (code < kMinCode[bytes] || code > 0x10FFFF || surrogate) return std::nullopt;
  return Character{code, bytes};
}

bool is_harmless(std::uint32_t code) {
  if (code < 0x20 || (code >= 0x7F && code <= 0x9F)) return false;
  // Excludes line and paragraph separators, and directional controls.
  return (code < 0x200E || code > 0x200F) && (code < 0x2028 || code > 0x202E) &&
         (code < 0x2066 || code > 0x2069);
}

std::string escaped(std::string_view text, std::string_view kept) {
  constexpr std::string_view kDigits = "0123456789ABCDEF";
  std::string shown;
  while (!text.empty()) {
    const auto c = first_character(text);
    const std::string_view bytes = text.substr(0, c ? c->bytes : 1);
    if (c && (is_harmless(c->code) || kept.find(text[0]) != kept.npos)) {
      shown += bytes;
    } else {
      for (const char b : bytes) {
        const auto value = static_cast<unsigned char>(b);
        shown += {'\\', 'x', kDigits[value >> 4], kDigits[value & 15]};
      }
    }
    text.remove_prefix(bytes.size());
  }
  return shown;
}

}  // namespace

std::string printable(std::string_view text) { return escaped(text, ""); }
std::string printable_lines(std::string_view text) { return escaped(text, "\n\t"); }

std::string size_text(std::uint64_t bytes) {
  struct Units {
    std::uint64_t factor;
    std::array<const char*, 3> names;
  };
  constexpr std::array<Units, 2> kUnits{
      {{1024, {" KiB", " MiB", " GiB"}}, {1000, {" kB", " MB", " GB"}}}};
  std::uint64_t min = bytes;
  const char* unit = " bytes";
  for (const Units& units : kUnits) {
    std::uint64_t count = bytes;
    for (const char* name : units.names) {
      if (count == 0 || count % units.factor != 0) break;
      count /= units.factor;
      if (count >= min) continue;
      min = count;
      unit = name;
    }
  }
  return std::to_string(min) + unit;
}

std::string count_text(std::uint64_t count, std::string_view one, std::string_view many) {
  std::string text = std::to_string(count) + " ";
  if (count != 1 && !many.empty()) return text.append(many);
  return text.append(one).append(count == 1 ? "" : "s");
}

void print_message(std::string_view tool, std::string_view message) {
  std::cerr << tool << ": " << printable(message) << "\n";
}

}  // namespace rlpc
