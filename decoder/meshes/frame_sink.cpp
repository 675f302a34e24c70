#include "decoder/meshes/frame_sink.h"

#include <array>
#include <filesystem>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/files/numbered_name.h"
#include "common/files/output_file.h"

namespace rlpc {

namespace {

namespace fs = std::filesystem;

struct NamedFormat {
  std::string_view extension;
  SinkFormat format;
};

constexpr std::array<NamedFormat, 6> kFormats{{{".rlpd", SinkFormat::kRlpd},
                                               {".pc2", SinkFormat::kPc2},
                                               {".mdd", SinkFormat::kMdd},
                                               {".glb", SinkFormat::kGlb},
                                               {".obj", SinkFormat::kObj},
                                               {".ply", SinkFormat::kPly}}};

std::string_view extension_of(SinkFormat format) {
  for (const NamedFormat& f : kFormats) {
    if (f.format == format) return f.extension;
  }
  return "";
}

SinkFormat format_of_extension(std::string_view extension) {
  for (const NamedFormat& f : kFormats) {
    if (f.extension == extension) return f.format;
  }
  return SinkFormat::kByName;
}

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(c >= 'A' && c <= 'Z' ? c - 'A' + 'a' : c);
  return extension;
}

bool is_mesh(SinkFormat format) {
  return format == SinkFormat::kObj || format == SinkFormat::kPly;
}

// Returns a lower bound of the bytes to write.
std::uint64_t min_bytes(SinkFormat format, const SinkOptions& options) {
  const std::uint64_t vertices = options.num_vertices;
  const std::uint64_t triangles = options.triangles.size();
  const std::uint64_t frames = options.num_frames;
  switch (format) {
    case SinkFormat::kGlb:  // without motion
      return 12 * vertices;
    case SinkFormat::kObj:  // "v 0 0 0", "f 1 2 3"
      return frames * 8 * (vertices + triangles);
    case SinkFormat::kPly:  // "0 0 0"
      return frames * (options.ascii ? 6 : 12) * vertices;
    default:
      return frames * 12 * vertices;
  }
}

OutputResult<std::unique_ptr<FrameSink>> open_one_file(const std::string& path,
                                                       SinkFormat format, SinkOptions options) {
  switch (format) {
    case SinkFormat::kRlpd:
      return open_rlpd_sink(path, std::move(options));
    case SinkFormat::kGlb:
      return open_gltf_sink(path, std::move(options));
    case SinkFormat::kPc2:
    case SinkFormat::kMdd:
      return open_point_cache_sink(path, format, std::move(options));
    default:
      return open_single_mesh_sink(path, format, options);
  }
}

OutputError misuse(std::string message) { return {std::move(message), true}; }

OutputResult<std::unique_ptr<FrameSink>> open_standard_output(SinkOptions options) {
  const SinkFormat format = options.format;
  const std::string name = "standard output: ";
  if (format == SinkFormat::kByName) {
    return misuse(name + "needs a format");
  }
  const bool is_stream = options.live && format == SinkFormat::kPc2;
  if ((format == SinkFormat::kPc2 || format == SinkFormat::kMdd) && !is_stream) {
    return misuse(name + "a point cache needs the mesh in a second file; write .rlpd or .glb");
  }
  if (is_mesh(format) && options.num_frames > 1) {
    return misuse(name + "takes a single frame as " + std::string(extension_of(format)));
  }
  return open_one_file("-", format, std::move(options));
}

// Returns whether a name stands for numbered files. One "#" may be part of the name of a single
// file or folder.
bool is_numbered(const std::string& name, std::uint32_t num_frames) {
  if (name.find('%') != std::string::npos) return true;
  const auto numbered = parse_pattern(name);
  return numbered && is_mesh(format_of_extension(lower_extension(name))) &&
         numbered->width >= (num_frames == 1 ? 2 : 1);
}

std::string name_in_folder(SinkFormat format) {
  return "frame_%04d" + std::string(extension_of(format));
}

// Returns the pattern of the files of `path`, perhaps a folder; none if it is one file.
std::optional<fs::path> pattern_of(const fs::path& path, SinkFormat format) {
  if (!is_mesh(format) || path == "-") return std::nullopt;
  const std::string name = path.filename().string();
  if (is_numbered(name, 0)) return path;
  const bool is_file = format_of_extension(lower_extension(name)) != SinkFormat::kByName;
  return is_file ? std::nullopt : std::optional(path / name_in_folder(format));
}

}  // namespace

bool holds_attributes(SinkFormat format) {
  return is_mesh(format) || format == SinkFormat::kPc2 || format == SinkFormat::kMdd ||
         format == SinkFormat::kGlb;
}

SinkFormat sink_format(const std::string& path, SinkFormat given) {
  if (given != SinkFormat::kByName) return given;
  const SinkFormat named = format_of_extension(lower_extension(path));
  return named != SinkFormat::kByName ? named : SinkFormat::kObj;
}

std::optional<std::string> find_written_input(const std::string& path, SinkFormat given,
                                              const std::string& input) {
  const SinkFormat format = sink_format(path, given);
  const auto pattern = pattern_of(path, format);
  if (!pattern) {
    return OutputFile::is_same_file(path, input) ? std::optional(path) : std::nullopt;
  }
  const auto name = parse_pattern(pattern->filename().string());
  if (!name) return std::nullopt;
  const fs::path folder = pattern->has_parent_path() ? pattern->parent_path() : fs::path(".");
  std::error_code ec;
  for (fs::directory_iterator it(folder, ec), end; !ec && it != end; it.increment(ec)) {
    const std::string file = it->path().filename().string();
    if (!name->number_of(file)) continue;
    if (OutputFile::is_same_file(it->path().string(), input)) {
      return (pattern->parent_path() / file).string();
    }
  }
  return std::nullopt;
}

OutputResult<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& path,
                                                         SinkOptions options) {
  const SinkFormat format = sink_format(path, options.format);
  if (options.limit != nullptr && min_bytes(format, options) > options.limit->left) {
    return options.limit->exceeded(path == "-" ? "standard output" : path);
  }
  if (path == "-") return open_standard_output(std::move(options));
  const fs::path name = fs::path(path).filename();
  if (is_numbered(name.string(), options.num_frames)) {
    if (!is_mesh(format)) {
      return misuse(path + ": numbered names are for .obj and .ply files; one " +
                    std::string(extension_of(format)) + " file holds all frames");
    }
    return open_mesh_sink(path, format, std::move(options));
  }
  if (!is_mesh(format)) return open_one_file(path, format, std::move(options));
  const std::string extension = lower_extension(name);
  const SinkFormat named = format_of_extension(extension);
  if (is_mesh(named)) {
    if (options.num_frames == 1) return open_one_file(path, format, std::move(options));
    const std::string kind = named == SinkFormat::kObj ? "OBJ" : "PLY";
    return misuse(path + ": one " + kind +
                  " file holds one frame; choose a folder, a numbered name such as "
                  "frame_%04d" +
                  extension + ", or X.pc2 (which also writes X.obj)");
  }
  if (named != SinkFormat::kByName) {
    return misuse(path + ": " + std::string(extension_of(format)) +
                  " files hold one frame each; choose a folder, or a numbered name "
                  "such as frame_%04d" +
                  std::string(extension_of(format)));
  }
  std::error_code ignored;
  if (!extension.empty() && !fs::is_directory(path, ignored)) {
    return misuse(path + ": cannot write " + extension +
                  " files; expected .rlpd, .pc2, .mdd, .glb, frame_%04d.obj, "
                  "frame_%04d.ply, or a folder (ending in / if its name has a dot)");
  }
  return open_mesh_sink((fs::path(path) / name_in_folder(format)).string(), format,
                        std::move(options));
}

}  // namespace rlpc
