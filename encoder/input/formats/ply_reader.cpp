#include "encoder/input/formats/ply_reader.h"

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <optional>
#include <system_error>
#include <utility>

#include "encoder/input/formats/mesh_text.h"
#include "encoder/input/formats/ply_header.h"
#include "encoder/input/input_file.h"

namespace rlpc {

namespace {

using std::to_string;

// Reads the values of a text body in order; gives zeros after an error.
class TextBody {
 public:
  TextBody(std::string_view text, const PlyHeader& header)
      : words_(text.substr(header.body), header.body_line), bytes_(text.size() - header.body) {}

  // The position of the last value, for error messages.
  std::string place() const { return ":" + to_string(line_); }
  const std::optional<std::string>& problem() const { return problem_; }
  std::uint64_t bytes_left() const { return bytes_ - words_.position(); }
  // The smallest size of a value: a character and a separator, which the last value may lack.
  static std::uint64_t least_bytes(PlyType) { return 2; }
  static std::uint64_t spare_bytes() { return 1; }

  float coordinate(PlyType) {
    const std::string_view word = next();
    return problem_ ? 0 : parse_coordinate(word, problem_);
  }

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
  std::optional<std::string> problem_;
};

// Reads the values of a binary body, with the same interface.
class BinaryBody {
 public:
  BinaryBody(std::string_view text, const PlyHeader& header)
      : text_(text),
        pos_(header.body),
        little_endian_(header.encoding == PlyEncoding::kLittleEndian) {}

  std::string place() const { return ": byte " + to_string(last_); }
  const std::optional<std::string>& problem() const { return problem_; }
  std::uint64_t bytes_left() const { return text_.size() - pos_; }
  static std::uint64_t least_bytes(PlyType type) { return ply_bytes(type); }
  static std::uint64_t spare_bytes() { return 0; }

  float coordinate(PlyType type) {
    if (!is_ply_float(type)) return static_cast<float>(integer(type));
    const std::uint64_t bits = take(type);
    const float value = type == PlyType::kF64
                            ? static_cast<float>(std::bit_cast<double>(bits))
                            : std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    if (std::isfinite(value)) return value;
    if (!problem_) {
      problem_ = std::string("a coordinate is ") +
                 (std::isnan(value) ? "not a number" : "infinite, or too large for 32 bits") +
                 "; every coordinate must be finite";
    }
    return 0;
  }

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
  std::optional<std::string> problem_;
};

template <class Body>
class PlyReader {
 public:
  PlyReader(std::string_view text, const std::string& name, const PlyHeader& header,
            const MeshLimit& limit)
      : body_(text, header), name_(name), header_(header), limit_(limit) {}

  InputResult<SingleMesh> read() {
    mesh_.frame_rate = header_.frame_rate;
    for (const PlyElement& element : header_.elements) {
      if (element.name == "vertex") num_vertices_ = element.count;
    }
    if (num_vertices_ == 0) {
      return InputError{name_ + ": no vertices: the header needs an element \"vertex\""};
    }
    for (const PlyElement& element : header_.elements) {
      if (auto error = check(element)) return *error;
      read_element(element);
      if (auto error = failure()) return *error;
    }
    body_.expect_end();
    if (auto error = failure()) return *error;
    return std::move(mesh_);
  }

 private:
  static bool is_scalar(const PlyElement& element, std::string_view name) {
    for (const PlyProperty& p : element.properties) {
      if (p.name == name) return !p.length;
    }
    return false;
  }

  static bool is_polygon(const PlyProperty& p) {
    return p.name == "vertex_indices" || p.name == "vertex_index";
  }

  // Checks, before memory is allocated, that the counts of the header are possible and usable.
  std::optional<InputError> check(const PlyElement& element) const {
    std::uint64_t row_bytes = 0;
    for (const PlyProperty& p : element.properties) {
      row_bytes += Body::least_bytes(p.length.value_or(p.type));
    }
    // Cannot overflow: a count has 32 bits, and a row has only a few bytes per line of the
    // header.
    const std::uint64_t needed = row_bytes * element.count;
    if (needed > body_.bytes_left() + Body::spare_bytes()) {
      return InputError{name_ + ": element " + quoted(element.name) + ": " +
                        to_string(element.count) + " of them need at least " +
                        to_string(needed) + " bytes, but " + to_string(body_.bytes_left()) +
                        " are left in the file; is it complete?"};
    }
    if (element.name == "vertex") {
      if (std::uint64_t{element.count} * 12 > limit_.of_mesh) {
        return InputError{name_ + ": " + memory_problem(limit_.of_all)};
      }
      for (const char* axis : {"x", "y", "z"}) {
        if (is_scalar(element, axis)) continue;
        return InputError{name_ + ": element \"vertex\" has no number " + axis};
      }
    } else if (element.name == "face" && element.count > 0) {
      bool found = false;
      for (const PlyProperty& p : element.properties) {
        found |= is_polygon(p) && p.length && !is_ply_float(p.type);
      }
      if (!found) {
        return InputError{name_ + ": element \"face\" has no list of integers vertex_indices"};
      }
    } else if (element.name == "tristrips") {
      return InputError{name_ + ": triangle strips are not supported; export triangles"};
    }
    return std::nullopt;
  }

  void read_element(const PlyElement& element) {
    const bool is_vertex = element.name == "vertex";
    const bool is_face = element.name == "face";
    if (is_vertex) mesh_.xyz.resize(3 * std::size_t{element.count});
    for (std::uint32_t i = 0; i < element.count && !failed(); ++i) {
      for (const PlyProperty& p : element.properties) {
        if (is_vertex && !p.length && p.name.size() == 1 && p.name[0] >= 'x' &&
            p.name[0] <= 'z') {
          mesh_.xyz[3 * std::size_t{i} + static_cast<std::size_t>(p.name[0] - 'x')] =
              body_.coordinate(p.type);
        } else if (is_face && p.length && is_polygon(p)) {
          read_polygon(p);
        } else {
          body_.skip(p.type, p.length ? length_of(p) : 1);
        }
        if (failed()) return;
      }
    }
  }

  std::uint64_t length_of(const PlyProperty& list) {
    const std::int64_t length = body_.integer(*list.length);
    if (length < 0) problem_ = "a list of " + to_string(length) + " values";
    return length < 0 ? 0 : static_cast<std::uint64_t>(length);
  }

  // Splits the polygon into a fan from its first corner.
  void read_polygon(const PlyProperty& list) {
    const std::uint64_t corners = length_of(list);
    if (!failed() && corners < 3) {
      problem_ = "a face of " + to_string(corners) + " corners; it needs 3 or more";
    }
    Triangle fan{};
    for (std::uint64_t i = 0; i < corners; ++i) {
      const std::uint32_t vertex = read_corner(list.type);
      if (failed()) return;
      if (i >= 3) fan[1] = fan[2];
      fan[i < 2 ? static_cast<std::size_t>(i) : 2] = vertex;
      if (i < 2) continue;
      if (!limit_.leaves_room(mesh_, mesh_.triangles)) {
        problem_ = memory_problem(limit_.of_all);
        return;
      }
      mesh_.triangles.push_back(fan);
    }
  }

  std::uint32_t read_corner(PlyType type) {
    const std::int64_t index = body_.integer(type);
    if (!failed() && (index < 0 || index >= num_vertices_)) {
      problem_ = "vertex index " + to_string(index) + " is out of range 0 to " +
                 to_string(num_vertices_ - 1);
    }
    return failed() ? 0 : static_cast<std::uint32_t>(index);
  }

  bool failed() const { return problem_ || body_.problem(); }
  std::optional<InputError> failure() const {
    if (!failed()) return std::nullopt;
    return InputError{name_ + body_.place() + ": " + (problem_ ? *problem_ : *body_.problem())};
  }

  Body body_;
  const std::string& name_;
  const PlyHeader& header_;
  const MeshLimit& limit_;
  std::int64_t num_vertices_ = 0;
  SingleMesh mesh_;
  std::optional<std::string> problem_;
};

}  // namespace

InputResult<SingleMesh> parse_ply(std::string_view text, const std::string& name,
                                  const MeshLimit& limit) {
  const auto header = parse_ply_header(text, name);
  if (!header) return header.error();
  if (header->encoding == PlyEncoding::kText) {
    return PlyReader<TextBody>(text, name, *header, limit).read();
  }
  return PlyReader<BinaryBody>(text, name, *header, limit).read();
}

namespace {

constexpr std::array<std::string_view, 1> kPlyExtensions{".ply"};

}  // namespace

const InputFormat kPlyFormat{
    .holds = InputFormat::Holds::kMesh,
    .extensions = kPlyExtensions,
    .begins =
        [](std::string_view beginning) {
          return beginning.starts_with("ply\n") || beginning.starts_with("ply\r");
        },
    .parse = parse_ply,
};

}  // namespace rlpc
