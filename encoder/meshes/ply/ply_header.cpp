#include "encoder/meshes/ply/ply_header.h"

#include <array>
#include <charconv>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "encoder/meshes/mesh_text.h"

namespace rlpc {

namespace {

using std::to_string;

struct TypeName {
  std::string_view name;
  PlyType type;
};

constexpr std::array<TypeName, 16> kTypeNames{{{"char", PlyType::kI8},
                                               {"int8", PlyType::kI8},
                                               {"uchar", PlyType::kU8},
                                               {"uint8", PlyType::kU8},
                                               {"short", PlyType::kI16},
                                               {"int16", PlyType::kI16},
                                               {"ushort", PlyType::kU16},
                                               {"uint16", PlyType::kU16},
                                               {"int", PlyType::kI32},
                                               {"int32", PlyType::kI32},
                                               {"uint", PlyType::kU32},
                                               {"uint32", PlyType::kU32},
                                               {"float", PlyType::kF32},
                                               {"float32", PlyType::kF32},
                                               {"double", PlyType::kF64},
                                               {"float64", PlyType::kF64}}};

class HeaderParser {
 public:
  HeaderParser(std::string_view text, const std::string& name) : text_(text), name_(name) {}

  InputResult<PlyHeader> parse() {
    if (!text_.starts_with("ply\n") && !text_.starts_with("ply\r")) {
      return InputError{name_ + ":1: does not begin with a line \"ply\"; not a PLY file"};
    }
    // A binary body begins right after the last line end, which must be unambiguous.
    line_end_ = text_[3] == '\n' ? "\n" : text_.substr(3, 2) == "\r\n" ? "\r\n" : "\r";
    take_line();
    while (!error_ && !at_end_header_) parse_line();
    if (!error_ && !has_format_) fail("no line \"format\" in the header");
    for (const PlyElement& e : header_.elements) {
      if (!error_ && e.count > 0 && e.properties.empty()) {
        fail("element " + quoted(e.name) + " has no property");
      }
    }
    if (error_) return *error_;
    header_.body = pos_;
    header_.body_line = line_ + 1;
    return std::move(header_);
  }

 private:
  void fail(const std::string& what) {
    if (!error_) error_ = InputError{name_ + ":" + to_string(line_) + ": " + what};
  }

  std::string_view take_line() {
    ++line_;
    const std::size_t end = text_.find(line_end_, pos_);
    if (end == text_.npos) {
      fail("the file ends in its header; there is no line \"end_header\"");
      return {};
    }
    const std::string_view line = text_.substr(pos_, end - pos_);
    pos_ = end + line_end_.size();
    return line;
  }

  void parse_line() {
    TextWords words(take_line());
    if (error_) return;
    const std::string_view keyword = words.next();
    if (keyword == "format") {
      parse_format(words);
    } else if (keyword == "element") {
      parse_element(words);
    } else if (keyword == "property") {
      parse_property(words);
    } else if (keyword == "comment") {
      parse_comment(words);
    } else if (keyword == "end_header") {
      at_end_header_ = true;
    } else if (keyword == "obj_info") {
      header_.has_info = true;
    } else {
      fail(quoted(keyword) +
           " does not begin a line of a PLY header; expected format, element, property, "
           "comment or "
           "end_header");
    }
  }

  void parse_format(TextWords& words) {
    const std::string_view encoding = words.next();
    const std::string_view version = words.next();
    if (encoding == "ascii") {
      header_.encoding = PlyEncoding::kText;
    } else if (encoding == "binary_little_endian") {
      header_.encoding = PlyEncoding::kLittleEndian;
    } else if (encoding == "binary_big_endian") {
      header_.encoding = PlyEncoding::kBigEndian;
    } else {
      fail("format " + quoted(encoding) +
           "; expected ascii, binary_little_endian or binary_big_endian");
    }
    if (version != "1.0") fail("PLY version " + quoted(version) + "; expected 1.0");
    has_format_ = true;
  }

  void parse_element(TextWords& words) {
    PlyElement element;
    const std::string_view name = words.next();
    element.name = name;
    const std::string_view count = words.next();
    const char* const last = count.data() + count.size();
    const auto [end, ec] = std::from_chars(count.data(), last, element.count);
    if (ec != std::errc() || end != last) {
      return fail("element " + quoted(name) + ": " + quoted(count) +
                  " of them; expected a number from 0 to 4294967295");
    }
    if (!elements_.insert(name).second) fail("a second element " + quoted(name));
    properties_.clear();
    header_.elements.push_back(std::move(element));
  }

  void parse_property(TextWords& words) {
    if (header_.elements.empty()) return fail("a property before the first element");
    PlyProperty property;
    std::string_view type = words.next();
    if (type == "list") {
      property.length = parse_type(words.next());
      if (property.length && is_ply_float(*property.length)) {
        fail("a list whose length is not an integer");
      }
      type = words.next();
    }
    property.type = parse_type(type);
    const std::string_view name = words.next();
    property.name = name;
    if (name.empty()) fail("a property without a name");
    if (!properties_.insert(name).second) fail("a second property " + quoted(name));
    header_.elements.back().properties.push_back(std::move(property));
  }

  PlyType parse_type(std::string_view name) {
    for (const TypeName& t : kTypeNames) {
      if (t.name == name) return t.type;
    }
    fail(quoted(name) + " is not a PLY type; expected for example float, uchar or int");
    return PlyType::kF32;
  }

  void parse_comment(TextWords& words) {
    const std::string_view key = words.next();
    if (key == "TextureFile") {
      header_.textures.emplace_back(words.next());
    } else if (key == "frame_rate" && !header_.frame_rate) {
      if (const auto rate = parse_frame_rate(words.next())) header_.frame_rate = *rate;
    }
  }

  std::string_view text_;
  const std::string& name_;
  std::string_view line_end_;
  std::size_t pos_ = 0;
  std::uint64_t line_ = 0;
  bool has_format_ = false;
  bool at_end_header_ = false;
  PlyHeader header_;
  std::set<std::string_view> elements_;    // names of elements, in text_
  std::set<std::string_view> properties_;  // names of properties of the last element
  std::optional<InputError> error_;
};

}  // namespace

std::size_t ply_bytes(PlyType type) {
  constexpr std::array<std::size_t, 8> kBytes{1, 1, 2, 2, 4, 4, 4, 8};
  return kBytes[static_cast<std::size_t>(type)];
}

bool is_ply_float(PlyType type) { return type >= PlyType::kF32; }

InputResult<PlyHeader> parse_ply_header(std::string_view text, const std::string& name) {
  return HeaderParser(text, name).parse();
}

}  // namespace rlpc
