#include "encoder/input/frame_source.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <numeric>
#include <system_error>
#include <utility>
#include <vector>

#include "common/attributes/attribute_set.h"
#include "common/io/numbered_name.h"
#include "common/syntax/stream_format.h"
#include "encoder/input/axes.h"
#include "encoder/input/formats/mesh_sequence.h"
#include "encoder/input/formats/point_cache.h"
#include "encoder/input/input_file.h"
#include "encoder/input/input_format.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

// Parses all of `text` as a number below 2^32.
std::optional<std::uint32_t> parse_u32(std::string_view text) {
  std::uint32_t value = 0;
  const char* const last = text.data() + text.size();
  const auto [end, ec] = std::from_chars(text.data(), last, value);
  if (ec != std::errc() || end != last) return std::nullopt;
  return value;
}

// Parses "29.97" as 2997 / 100; at most 9 digits after the point.
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

InputResult<std::unique_ptr<FrameSource>> open_listed(InputResult<FrameFiles> files,
                                                      const InputOptions& options) {
  if (!files) return files.error();
  return open_mesh_sequence(std::move(*files), options);
}

// Of "uv12", 12; of a name without one, 0.
std::uint32_t number_of(std::string_view name) {
  const std::size_t digits = name.find_last_not_of("0123456789") + 1;
  return parse_u32(name.substr(digits)).value_or(0);
}

bool is_stream(const std::string& path) {
  return beginning_of(path).starts_with(std::string(kSignature.begin(), kSignature.end()));
}

InputResult<std::unique_ptr<FrameSource>> open_file(const InputOptions& options, bool exists) {
  using Holds = InputFormat::Holds;
  const std::string& path = options.path;
  const InputFormat* const format = format_of(path);
  if (format == nullptr && is_stream(path)) {
    return InputError{
        name_of_input(path) +
        ": is already an RLPC stream; rlpcdec decodes it, rlpcinfo --extract makes "
        "it smaller"};
  }
  // Perhaps it cannot be read, or only stands for the file. (Not all of a pipe is read.)
  const bool is_whole =
      path != "-" || beginning_of(path).starts_with("version https://git-lfs");
  if (format == nullptr && exists && is_whole) {
    const auto file = InputFile::open(path, options.max_memory_bytes);
    if (!file) return file.error();
  }
  if (format == nullptr) {
    return InputError{name_of_input(path) +
                      (exists ? ": unknown kind of file" : ": no such file or folder") +
                      "; expected " + extensions_text({Holds::kMesh, Holds::kAnimation}) +
                      ", a folder of " + extensions_text({Holds::kMesh}) +
                      " files, or a pattern such as walk_%04d.obj or 'walk_*.obj'"};
  }
  switch (format->holds) {
    case Holds::kAnimation:
      return format->open(options);
    case Holds::kPoints:
      return InputError{name_of_input(path) +
                        ": a point cache has no triangles; give its mesh as the input and the "
                        "cache with --points"};
    default:
      return open_mesh_sequence({{path}}, options);
  }
}

InputResult<std::unique_ptr<FrameSource>> open_with_its_axes(const InputOptions& options) {
  const std::string& path = options.path;
  std::error_code ec;
  if (!options.more_paths.empty()) {
    std::vector<std::string> paths{path};
    paths.insert(paths.end(), options.more_paths.begin(), options.more_paths.end());
    return open_listed(list_mesh_files(paths), options);
  }
  const bool exists = path == "-" || fs::exists(path, ec);
  if (!options.points.empty()) {
    const InputFormat* const format = format_of(options.points);
    const bool known = format != nullptr && format->open_points != nullptr;
    return (known ? format->open_points : open_point_cache)(options);
  }
  if (fs::is_directory(path, ec)) return open_listed(list_mesh_folder(path), options);
  // A file with exactly this name takes precedence over a pattern.
  const std::string name = fs::path(path).filename().string();
  const bool is_glob = name.find('%') == name.npos && name.find_first_of("*?[") != name.npos;
  if (!exists && is_glob) return open_listed(list_mesh_glob(path), options);
  if (!exists && is_pattern(name)) return open_listed(list_mesh_pattern(path), options);
  return open_file(options, exists);
}

bool is_gltf(const std::string& path) {
  const InputFormat* const format = format_of(path);
  return format != nullptr && format->has_clips;
}

}  // namespace

std::optional<InputError> FrameSource::read_exact(std::uint32_t frame, std::span<double> xyz) {
  std::vector<float> floats(xyz.size());
  if (auto error = read_frame(frame, floats)) return error;
  std::copy(floats.begin(), floats.end(), xyz.begin());
  return std::nullopt;
}

void FrameSource::limit_attributes(std::size_t most) {
  auto& sets = shape_.attributes.sets;
  if (sets.size() <= most) return;
  std::string names;
  while (sets.size() > most) {
    const auto last = std::max_element(
        sets.rbegin(), sets.rend(),
        [](const auto& a, const auto& b) { return number_of(a.name) < number_of(b.name); });
    names = last->name + (names.empty() ? "" : ", ") + names;
    sets.erase(std::prev(last.base()));
  }
  add_note("dropped " + names + ": a stream has at most " + std::to_string(most) +
           " attributes");
}

bool has_clips(const InputOptions& options) {
  return options.more_paths.empty() && options.points.empty() && is_gltf(options.path);
}

std::optional<InputError> check_gltf_options(const InputOptions& options) {
  if (!options.points.empty() && is_gltf(options.path)) {
    return InputError{name_of_input(options.path) +
                      ": a glTF file brings its own animation and takes no --points; leave it "
                      "out, or replace this file by the mesh (" +
                      extensions_text({InputFormat::Holds::kMesh}) + ") of " +
                      name_of_input(options.points)};
  }
  if ((options.animations.empty() && options.weld) || has_clips(options)) return std::nullopt;
  return InputError{name_of_input(options.path) +
                    (options.weld
                         ? ": --animation is for .glb and .gltf files"
                         : ": --no-weld is for .glb and .gltf files; other formats are never "
                           "welded")};
}

InputResult<std::unique_ptr<FrameSource>> open_frame_source(const InputOptions& options) {
  if (!options.more_paths.empty() && !options.points.empty()) {
    return InputError{
        name_of_input(options.points) +
        ": a point cache has the frames of one mesh; give one INPUT with --points"};
  }
  if (auto error = check_gltf_options(options)) return *error;
  auto source = open_with_its_axes(options);
  if (source) (*source)->limit_attributes(kMaxAttributeSets);
  if (!source || !options.axes) return source;
  return turn_source(std::move(*source), *options.axes);
}

InputResult<FrameRate> parse_frame_rate(std::string_view text) {
  const auto rate = text.find('.') != text.npos ? parse_decimal(text) : parse_fraction(text);
  if (rate && rate->numerator > 0) return *rate;
  return InputError{"frame rate \"" + std::string(text) +
                    "\": expected frames per second as in 25, 30000/1001 or 29.97"};
}

std::optional<FrameRate> frame_rate_near(double frames_per_second) {
  constexpr double kLeast = 2.0;
  constexpr double kMost = 1000.0;
  constexpr double kNear = 1e-4;
  if (!(frames_per_second >= kLeast && frames_per_second <= kMost)) return std::nullopt;
  const auto near = [&](double rate) {
    return std::abs(frames_per_second / rate - 1.0) < kNear;
  };
  const auto whole = static_cast<std::uint32_t>(std::lround(frames_per_second));
  if (near(whole)) return FrameRate{whole, 1};
  const auto slowed = static_cast<std::uint32_t>(std::lround(frames_per_second * 1.001));
  if (near(slowed / 1.001)) return FrameRate{1000 * slowed, 1001};
  const auto thousandths = static_cast<std::uint32_t>(std::lround(frames_per_second * 1000.0));
  const std::uint32_t divisor = std::gcd(thousandths, 1000U);
  return FrameRate{thousandths / divisor, 1000 / divisor};
}

}  // namespace rlpc
