// The values of a PLY file, after its header.
#pragma once

#include <bit>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "encoder/meshes/mesh_text.h"
#include "encoder/meshes/ply/ply_header.h"

namespace rlpc {

// Reads the values of a text body in order; returns zeros after an error.
class TextBody {
 public:
  TextBody(std::string_view text, const PlyHeader& header)
      : words_(text.substr(header.body), header.body_line), bytes_(text.size() - header.body) {}

  // Returns the position of the last value, for error messages.
  std::string place() const { return ":" + std::to_string(line_); }
  const std::optional<std::string>& problem() const { return problem_; }
  std::uint64_t bytes_left() const { return bytes_ - words_.position(); }
  // Returns the smallest size of a value: a character and a separator, which the last value may
  // lack.
  static std::uint64_t min_bytes(PlyType) { return 2; }
  static std::uint64_t spare_bytes() { return 1; }

  float coordinate(PlyType) {
    const std::string_view word = next();
    left_ = 0.0;
    return problem_ ? 0 : parse_coordinate(word, problem_, &left_);
  }
  // Returns the last number minus the coordinate that it became.
  double left() const { return left_; }

  std::int64_t integer(PlyType) {
    const std::string_view word = next();
    if (problem_) return 0;
    std::int64_t value = 0;
    const char* const last = word.data() + word.size();
    const auto [end, ec] = std::from_chars(word.data(), last, value);
    if (ec == std::errc() && end == last) return value;
    problem_ = quoted(word) + " is not an integer";
    return 0;
  }

  void skip(PlyType, std::uint64_t count) {
    for (std::uint64_t i = 0; i < count && !problem_; ++i) next();
  }

  void expect_end() {
    if (!words_.next_of_any_line().empty())
      problem_ = "has data after what the header announces";
    line_ = words_.line();
  }

 private:
  std::string_view next() {
    const std::string_view word = words_.next_of_any_line();
    line_ = words_.line();
    if (word.empty() && !problem_)
      problem_ = "the file ends before all values; is it complete?";
    return word;
  }

  TextWords words_;
  std::uint64_t bytes_;
  std::uint64_t line_ = 0;
  double left_ = 0.0;
  std::optional<std::string> problem_;
};

// Reads the values of a binary body, with the same interface.
class BinaryBody {
 public:
  BinaryBody(std::string_view text, const PlyHeader& header)
      : text_(text),
        pos_(header.body),
        little_endian_(header.encoding == PlyEncoding::kLittleEndian) {}

  std::string place() const { return ": byte " + std::to_string(last_); }
  const std::optional<std::string>& problem() const { return problem_; }
  std::uint64_t bytes_left() const { return text_.size() - pos_; }
  static std::uint64_t min_bytes(PlyType type) { return ply_bytes(type); }
  static std::uint64_t spare_bytes() { return 0; }

  float coordinate(PlyType type) {
    const double exact = number(type);
    const auto value = static_cast<float>(exact);
    left_ = exact - static_cast<double>(value);
    if (std::isfinite(value)) return value;
    if (!problem_) {
      problem_ = std::string("a coordinate is ") +
                 (std::isnan(value) ? "not a number" : "infinite, or too large for 32 bits") +
                 "; every coordinate must be finite";
    }
    return 0;
  }

  double left() const { return left_; }

  std::int64_t integer(PlyType type) {
    const std::uint64_t bits = take(type);
    switch (type) {
      case PlyType::kI8:
        return static_cast<std::int8_t>(bits);
      case PlyType::kI16:
        return static_cast<std::int16_t>(bits);
      case PlyType::kI32:
        return static_cast<std::int32_t>(bits);
      default:
        return static_cast<std::int64_t>(bits);
    }
  }

  void skip(PlyType type, std::uint64_t count) {
    if (!has(type, count)) return;
    pos_ += static_cast<std::size_t>(count) * ply_bytes(type);
  }

  void expect_end() {
    last_ = pos_;
    if (pos_ < text_.size()) problem_ = "has data after what the header announces";
  }

 private:
  bool has(PlyType type, std::uint64_t count) {
    last_ = pos_;
    if (!problem_ && bytes_left() / ply_bytes(type) < count) {
      problem_ = "the file ends before all values; is it complete?";
    }
    return !problem_;
  }

  double number(PlyType type) {
    if (!is_ply_float(type)) return static_cast<double>(integer(type));
    const std::uint64_t bits = take(type);
    return type == PlyType::kF64
               ? std::bit_cast<double>(bits)
               : double{std::bit_cast<float>(static_cast<std::uint32_t>(bits))};
  }

  std::uint64_t take(PlyType type) {
    if (!has(type, 1)) return 0;
    const std::size_t size = ply_bytes(type);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = little_endian_ ? pos_ + size - 1 - i : pos_ + i;
      bits = (bits << 8) | static_cast<unsigned char>(text_[at]);
    }
    pos_ += size;
    return bits;
  }

  std::string_view text_;
  std::size_t pos_;
  std::size_t last_ = 0;  // first byte of the last value
  bool little_endian_;
  double left_ = 0.0;
  std::optional<std::string> problem_;
};

}  // namespace rlpc
