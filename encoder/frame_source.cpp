#include "encoder/frame_source.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>

#include "encoder/gltf_source.h"
#include "encoder/input_file.h"
#include "encoder/obj_sequence.h"
#include "encoder/pc2_reader.h"
#include "encoder/rlpd_reader.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

// All of `text` as a number below 2^32.
std::optional<std::uint32_t> parse_u32(std::string_view text) {
  std::uint32_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, ec] = std::from_chars(text.data(), last, value);
  if (ec != std::errc() || end != last) return std::nullopt;
  return value;
}

// "29.97" as 2997 / 100; at most 9 digits after the point.
std::optional<FrameRate> parse_decimal(std::string_view text) {
  const std::size_t point = text.find('.');
  const std::string_view fraction = text.substr(point + 1);
  if (fraction.size() > 9) return std::nullopt;
  const auto whole = parse_u32(text.substr(0, point));
  const auto digits = fraction.empty() ? std::optional<std::uint32_t>(0) : parse_u32(fraction);
  if (!whole || !digits) return std::nullopt;
  std::uint64_t denominator = 1;
  for (std::size_t i = 0; i < fraction.size(); ++i) denominator *= 10;
  const std::uint64_t numerator = *whole * denominator + *digits;
  const std::uint64_t divisor = std::gcd(numerator, denominator);
  if (numerator / divisor > std::numeric_limits<std::uint32_t>::max()) return std::nullopt;
  return FrameRate{static_cast<std::uint32_t>(numerator / divisor),
                   static_cast<std::uint32_t>(denominator / divisor)};
}

std::optional<FrameRate> parse_fraction(std::string_view text) {
  const std::size_t slash = text.find('/');
  const auto numerator = parse_u32(text.substr(0, slash));
  const auto denominator =
      slash == text.npos ? std::optional<std::uint32_t>(1) : parse_u32(text.substr(slash + 1));
  if (!numerator || !denominator || *denominator == 0) return std::nullopt;
  const std::uint32_t divisor = std::gcd(*numerator, *denominator);
  return FrameRate{*numerator / divisor, *denominator / divisor};
}

// Does the file begin as a .glb or .gltf file does, whatever its name is?
bool looks_like_gltf(const std::string& path) {
  auto file = InputFile::open(path);
  if (!file) return false;
  std::string text(std::min<std::uint64_t>(file->size(), 64), '\0');
  if (file->read(0, text)) return false;
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  return text.starts_with("glTF") || (first != text.npos && text[first] == '{');
}

InputResult<std::unique_ptr<FrameSource>> open_listed(
    InputResult<std::vector<std::string>> paths, const InputOptions& options) {
  if (!paths) return paths.error();
  return open_obj_sequence(std::move(*paths), options.frame_rate);
}

}  // namespace

InputResult<std::unique_ptr<FrameSource>> open_frame_source(const InputOptions& options) {
  const std::string& path = options.path;
  std::error_code ec;
  const bool exists = fs::exists(path, ec);
  if (!options.points.empty()) return open_pc2(path, options.points, options.frame_rate);
  if (fs::is_directory(path, ec)) return open_listed(list_obj_folder(path), options);
  // A file of exactly this name comes first, whatever characters are in it.
  const std::string name = fs::path(path).filename().string();
  if (!exists && name.find('%') != name.npos)
    return open_listed(list_obj_pattern(path), options);
  if (!exists && name.find_first_of("*?[") != name.npos) {
    return open_listed(list_obj_glob(path), options);
  }
  std::string extension = fs::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  const bool named = extension == ".glb" || extension == ".gltf";
  const bool unknown = extension != ".rlpd" && extension != ".obj" && extension != ".pc2";
  if (named || (unknown && looks_like_gltf(path))) return open_gltf(options);
  if (!options.animation.empty()) {
    return InputError{path + ": only .glb and .gltf files have animations to choose from"};
  }
  if (extension == ".rlpd") return open_rlpd(path, options.frame_rate);
  if (extension == ".obj") return open_obj_sequence({path}, options.frame_rate);
  if (extension == ".pc2") {
    return InputError{path +
                      ": a point cache has no triangles; give its mesh as the input and the "
                      "cache with --points"};
  }
  return InputError{
      path + (exists ? ": unknown kind of file" : ": no such file or folder") +
      "; expected an .obj, .glb, .gltf or .rlpd file, a folder of .obj files, or a pattern "
      "such as walk_%04d.obj or 'walk_*.obj'"};
}

InputResult<FrameRate> parse_frame_rate(std::string_view text) {
  const auto rate = text.find('.') != text.npos ? parse_decimal(text) : parse_fraction(text);
  if (rate && rate->numerator > 0) return *rate;
  return InputError{"frame rate \"" + std::string(text) +
                    "\": expected frames per second as in 25, 30000/1001 or 29.97"};
}

}  // namespace rlpc
