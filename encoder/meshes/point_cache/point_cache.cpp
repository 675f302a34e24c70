#include "encoder/meshes/point_cache/point_cache.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/files/binary_numbers.h"
#include "common/files/messages.h"
#include "encoder/meshes/axes_fit.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/materials/material_files.h"
#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/mesh_text.h"
#include "encoder/meshes/piped_frames.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::size_t kPc2HeaderBytes = 32;
constexpr std::size_t kMddHeaderBytes = 8;
constexpr std::string_view kPc2Magic("POINTCACHE2\0", 12);

// The contents of a header.
struct Layout {
  bool big_endian = false;
  std::int32_t points = 0;
  std::int32_t frames = 0;
  std::uint64_t first_byte = 0;  // offset of the positions
  // The frame of the first sample, and frames per sample, in PC2 files. They are not used.
  float start = 0.0F;
  float rate = 1.0F;
};

InputError too_short(const InputFile& file, std::size_t header_bytes) {
  return InputError{file.path() + ": " + to_string(file.size()) +
                    " bytes; a point cache has at least a header of " +
                    to_string(header_bytes)};
}

InputResult<Layout> parse_pc2_header(const std::string& path,
                                     const std::array<char, kPc2HeaderBytes>& header) {
  if (std::string_view(header.data(), kPc2Magic.size()) != kPc2Magic) {
    return InputError{path + ": does not begin with POINTCACHE2; not a PC2 point cache"};
  }
  const std::int32_t version = load_i32(header, 12);
  if (version != 1) {
    return InputError{path + ": PC2 version " + to_string(version) + " at byte 12; expected 1"};
  }
  return Layout{false,           load_i32(header, 16), load_i32(header, 28),
                kPc2HeaderBytes, load_f32(header, 20), load_f32(header, 24)};
}

InputResult<Layout> read_pc2_header(InputFile& file) {
  std::array<char, kPc2HeaderBytes> header{};
  if (file.size() < header.size()) return too_short(file, header.size());
  if (auto error = file.read(0, header)) return *error;
  return parse_pc2_header(file.path(), header);
}

InputResult<Layout> read_mdd_header(InputFile& file) {
  std::array<char, kMddHeaderBytes> header{};
  if (file.size() < header.size()) return too_short(file, header.size());
  if (auto error = file.read(0, header)) return *error;
  Layout layout;
  layout.big_endian = true;
  layout.frames = static_cast<std::int32_t>(load_u32_be(header, 0));
  layout.points = static_cast<std::int32_t>(load_u32_be(header, 4));
  if (layout.frames > 0) {
    layout.first_byte = kMddHeaderBytes + 4 * static_cast<std::uint64_t>(layout.frames);
  }
  return layout;
}

// Compares the header with the mesh.
std::optional<InputError> check_points(const std::string& path, const Layout& layout,
                                       const std::string& mesh_path,
                                       std::uint32_t num_vertices) {
  if (layout.points >= 0 && static_cast<std::uint32_t>(layout.points) == num_vertices) {
    return std::nullopt;
  }
  return InputError{path + ": " + to_string(layout.points) + " points per frame, but " +
                    name_of_input(mesh_path) + " has " + to_string(num_vertices) +
                    " vertices; use the mesh and the cache of the same export"};
}

// Compares the header with the mesh and with the size of the file.
std::optional<InputError> check_layout(const InputFile& file, const Layout& layout,
                                       const std::string& mesh_path,
                                       std::uint32_t num_vertices) {
  const std::string& path = file.path();
  if (auto error = check_points(path, layout, mesh_path, num_vertices)) return error;
  if (layout.frames < 1) {
    return InputError{path + ": " + to_string(layout.frames) +
                      " samples; expected at least 1 frame"};
  }
  // `points` is the size of a mesh in memory, so this fits 64 bits.
  const std::uint64_t expected =
      layout.first_byte +
      std::uint64_t{num_vertices} * 12 * static_cast<std::uint64_t>(layout.frames);
  if (file.size() != expected) {
    return InputError{path + ": " + to_string(file.size()) + " bytes; expected " +
                      to_string(expected) + " for " +
                      count_text(static_cast<std::uint64_t>(layout.frames), "frame") + " of " +
                      count_text(num_vertices, "point") + "; the file is " +
                      (file.size() < expected ? "truncated" : "too long")};
  }
  return std::nullopt;
}

InputError is_no_cache(const std::string& name, const std::string& mesh_path,
                       std::uint32_t num_vertices) {
  return InputError{name +
                    ": not a PC2 point cache, which begins with POINTCACHE2, nor an MDD one of "
                    "the " +
                    to_string(num_vertices) + " vertices of " + name_of_input(mesh_path)};
}

InputResult<Layout> read_header(InputFile& file, const std::string& mesh_path,
                                std::uint32_t num_vertices) {
  std::array<char, kPc2Magic.size()> magic{};
  if (file.size() >= magic.size()) {
    if (auto error = file.read(0, magic)) return *error;
  }
  const bool is_pc2 = std::string_view(magic.data(), magic.size()) == kPc2Magic;
  const std::string extension = lower_extension(file.path());
  if (is_pc2 || extension == ".pc2") return read_pc2_header(file);
  auto layout = read_mdd_header(file);
  if (extension == ".mdd") return layout;
  // MDD has no signature: the numbers of the header must match.
  if (layout && !check_layout(file, *layout, mesh_path, num_vertices)) return layout;
  return is_no_cache(file.path(), mesh_path, num_vertices);
}

// Whether standard input that begins with `begin` is PC2 or may be MDD.
bool may_begin_cache(const std::string& begin, std::uint32_t num_vertices) {
  if (begin.starts_with(kPc2Magic)) return true;
  return begin.size() >= kMddHeaderBytes && load_u32_be(begin, 4) == num_vertices;
}

// Returns notes on the contents of a PC2 header that get lost.
std::vector<std::string> notes_on_pc2(const std::string& path, const Layout& layout) {
  if (!std::isfinite(layout.start) || !std::isfinite(layout.rate)) {
    return {"dropped: start and sample rate of " + path +
            ", which are not finite; the file may be damaged"};
  }
  std::string list;
  if (layout.start != 0.0F) list += "start " + shortest_text(layout.start);
  if (layout.rate != 1.0F) {
    list += (list.empty() ? "" : ", ") + ("sample rate " + shortest_text(layout.rate));
  }
  if (list.empty()) return {};
  return {"dropped: " + list + " of " + path +
          "; each sample is a frame, the first at 0 s ('frame_rate' sets their rate)"};
}

// The times of an MDD file.
struct FrameTimes {
  // Set if the times are evenly spaced seconds; otherwise they are frame numbers or
  // meaningless.
  std::optional<FrameRate> rate;
  bool may_be_times = true;  // they are finite and not descending
  bool are_even = true;
  bool are_equal = false;  // all times are equal, of two frames or more
  double start = 0.0;
  double interval = 0.0;  // mean
};

InputResult<FrameTimes> read_times(InputFile& file, const Layout& layout,
                                   std::uint64_t max_memory_bytes) {
  const auto count = static_cast<std::size_t>(layout.frames);
  if (std::uint64_t{count} * (4 + sizeof(double)) > max_memory_bytes) {
    return InputError{file.path() + ": " + memory_problem(max_memory_bytes)};
  }
  std::vector<char> bytes(4 * count);
  if (auto error = file.read(kMddHeaderBytes, bytes)) return *error;
  std::vector<double> times(count);
  for (std::size_t f = 0; f < count; ++f) times[f] = load_f32_be(bytes, 4 * f);
  FrameTimes told;
  for (std::size_t f = 0; f < count; ++f) {
    const bool descends = f > 0 && times[f] < times[f - 1];
    told.may_be_times = told.may_be_times && std::isfinite(times[f]) && !descends;
  }
  told.start = times.front();
  if (count < 2) return told;
  const double interval = (times.back() - times.front()) / static_cast<double>(count - 1);
  constexpr double kUneven = 0.02;  // tolerance as a fraction of the interval
  for (std::size_t f = 0; f < count; ++f) {
    const double expected = times.front() + interval * static_cast<double>(f);
    told.are_even = told.are_even && std::abs(times[f] - expected) <= kUneven * interval;
  }
  told.interval = interval;
  told.are_equal = count > 1 && interval == 0.0;
  if (!told.are_even) return told;
  told.rate = frame_rate_near(1.0 / interval);
  return told;
}

// Returns notes on times of an MDD file that get lost.
std::vector<std::string> notes_on_times(const std::string& path, const FrameTimes& times,
                                        bool has_rate) {
  const std::string fps =
      has_rate ? "" : "; frames are 1/30 s apart ('frame_rate' sets another rate)";
  if (!times.may_be_times) {
    return {"dropped: the frame times of " + path + ", which are not finite and ascending" +
            fps};
  }
  if (!times.are_even) {
    return {"dropped: the uneven frame times of " + path + (has_rate ? "" : fps)};
  }
  if (times.are_equal) {
    return {"dropped: the frame times of " + path + ", which are all " +
            shortest_text(static_cast<float>(times.start)) + fps};
  }
  std::string list;
  if (times.start != 0.0) {
    list += "start " + shortest_text(static_cast<float>(times.start));
  }
  if (!times.rate && !has_rate && times.interval > 0.0) {
    list += (list.empty() ? "interval " : ", interval ") +
            shortest_text(static_cast<float>(times.interval));
  }
  if (list.empty()) return {};
  return {"dropped: " + list + " of the frame times of " + path +
          (times.rate ? "; the first frame is at 0 s" : fps)};
}

float load_value(std::span<const char> bytes, std::size_t offset, const Layout& layout) {
  return layout.big_endian ? load_f32_be(bytes, offset) : load_f32(bytes, offset);
}

class PointCache : public FrameSource {
 public:
  PointCache(Shape shape, InputFile file, const Layout& layout)
      : FrameSource(std::move(shape)), file_(std::move(file)), layout_(layout) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    bytes_.resize(xyz.size() * 4);
    const std::uint64_t offset = layout_.first_byte + frame * std::uint64_t{bytes_.size()};
    if (auto error = file_.read(offset, bytes_)) return error;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = load_value(bytes_, 4 * i, layout_);
    }
    return check_finite(file_.path(), frame, xyz);
  }

  std::string file_of(std::uint32_t /*frame*/) const override { return file_.path(); }

  // Compares the axes of frames. Stops at a frame that cannot be read: reading it again reports
  // why.
  void compare_axes(std::span<const float> mesh) {
    AxesFit fit(mesh);
    std::vector<float> xyz(mesh.size());
    for (std::uint32_t f = 0; f < num_frames() && !fit.matches(); ++f) {
      if (read_frame(f, xyz)) return;
      fit.add_frame(xyz);
    }
    set_axes_of_mesh(fit.axes_of_mesh());
  }

 private:
  InputFile file_;
  Layout layout_;
  std::vector<char> bytes_;
};

}  // namespace

InputResult<std::unique_ptr<FrameSource>> open_point_cache(const InputOptions& options) {
  const std::string& mesh_path = options.path;
  const std::string& points_path = options.points;
  const std::optional<FrameRate>& frame_rate = options.frame_rate;
  const std::uint64_t max_memory_bytes = options.max_memory_bytes;
  if (mesh_path == "-" && points_path == "-") {
    return InputError{"standard input: cannot be both the mesh and its point cache"};
  }
  auto mesh = read_mesh_and_materials(mesh_path, options.images, max_memory_bytes);
  if (!mesh) return mesh.error();
  const auto num_vertices = static_cast<std::uint32_t>(mesh->xyz.size() / 3);
  if (points_path == "-" && !may_begin_cache(beginning_of("-"), num_vertices)) {
    return is_no_cache(name_of_input(points_path), mesh_path, num_vertices);
  }
  auto file = InputFile::open(points_path, max_memory_bytes);
  if (!file) return file.error();
  const auto layout = read_header(*file, mesh_path, num_vertices);
  if (!layout) return layout.error();
  if (auto error = check_layout(*file, *layout, mesh_path, num_vertices)) return *error;
  FrameRate usual;
  std::vector<std::string> notes;
  if (!layout->big_endian) notes = notes_on_pc2(file->path(), *layout);
  if (layout->big_endian) {
    const auto times = read_times(*file, *layout, max_memory_bytes);
    if (!times) return times.error();
    usual = times->rate.value_or(usual);
    notes = notes_on_times(file->path(), *times,
                           frame_rate.has_value() || mesh->frame_rate.has_value());
  }
  const std::vector<float> mesh_xyz = mesh->xyz;
  auto shape =
      shape_of(std::move(*mesh), static_cast<std::uint32_t>(layout->frames), frame_rate, usual);
  shape.files.insert(shape.files.begin(), {mesh_path, points_path});
  shape.notes.insert(shape.notes.end(), notes.begin(), notes.end());
  shape.memory_bytes += file->memory_bytes();
  auto source = std::make_unique<PointCache>(std::move(shape), std::move(*file), *layout);
  source->compare_axes(mesh_xyz);
  return std::unique_ptr<FrameSource>(std::move(source));
}

namespace {

constexpr std::array<std::string_view, 1> kPc2Extensions{".pc2"};

}  // namespace

const InputFormat kPc2Format{
    .holds = InputFormat::Holds::kPoints,
    .extensions = kPc2Extensions,
    .begins = [](std::string_view beginning) { return beginning.starts_with("POINTCACHE2"); },
    .open_points = open_point_cache,
};

namespace {

class Pc2Stream final : public FrameStream {
 public:
  Pc2Stream(Shape shape, std::FILE* file)
      : FrameStream(std::move(shape)), frames_(file, this->shape().name) {}

  InputResult<bool> next_frame(std::span<float> xyz) override {
    bytes_.resize(4 * xyz.size());
    auto read = frames_.read(bytes_);
    if (!read || !*read) return read;
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = load_f32(bytes_, 4 * i);
    return true;
  }

 private:
  PipedFrames frames_;
  std::vector<char> bytes_;
};

}  // namespace

InputResult<std::unique_ptr<FrameStream>> open_pc2_stream(
    std::FILE* file, const std::string& name, const std::string& mesh_path,
    const std::optional<FrameRate>& frame_rate, std::uint64_t max_memory_bytes) {
  auto mesh = read_mesh_and_materials(mesh_path, Images::kNone, max_memory_bytes);
  if (!mesh) return mesh.error();
  const auto num_vertices = static_cast<std::uint32_t>(mesh->xyz.size() / 3);
  std::array<char, kPc2HeaderBytes> header{};
  if (std::fread(header.data(), 1, header.size(), file) < header.size()) {
    return InputError{name + ": ends before its first frame; expected a PC2 point cache"};
  }
  const auto layout = parse_pc2_header(name, header);
  if (!layout) return layout.error();
  if (auto error = check_points(name, *layout, mesh_path, num_vertices)) return *error;
  FrameSource::Shape shape = shape_of(std::move(*mesh), 1, frame_rate);
  for (std::string& note : notes_on_pc2(name, *layout)) shape.notes.push_back(std::move(note));
  return std::unique_ptr<FrameStream>(std::make_unique<Pc2Stream>(
      FrameStream::Shape{name, num_vertices, shape.frame_rate, std::move(shape.triangles),
                         std::move(shape.attributes), std::move(shape.notes)},
      file));
}

namespace {

constexpr std::array<std::string_view, 1> kMddExtensions{".mdd"};

}  // namespace

const InputFormat kMddFormat{
    .holds = InputFormat::Holds::kPoints,
    .extensions = kMddExtensions,
    .open_points = open_point_cache,
};

}  // namespace rlpc
