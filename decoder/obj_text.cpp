#include "decoder/obj_text.h"

#include <array>
#include <charconv>

#include "decoder/float_position.h"

namespace rlpc {

namespace {

template <class Number>
void append_number(std::string& text, Number value) {
  std::array<char, 64> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

}  // namespace

void append_obj_vertices(std::string& text, const Grid& grid,
                         std::span<const std::int32_t> positions) {
  for (std::size_t i = 0; i < positions.size(); ++i) {
    text += i % 3 == 0 ? "v " : " ";
    append_number(text, float_position(grid, i % 3, positions[i]));
    if (i % 3 == 2) text += '\n';
  }
}

void append_obj_faces(std::string& text, const std::vector<Triangle>& triangles) {
  for (const Triangle& t : triangles) {
    text += 'f';
    for (const std::uint32_t v : t) {
      text += ' ';
      append_number(text, std::uint64_t{v} + 1);
    }
    text += '\n';
  }
}

void append_obj_frame_rate(std::string& text, FrameRate frame_rate) {
  text += "# frame_rate " + std::to_string(frame_rate.numerator) + "/" +
          std::to_string(frame_rate.denominator) + "\n";
}

}  // namespace rlpc
