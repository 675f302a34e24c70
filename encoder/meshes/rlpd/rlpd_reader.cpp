#include "encoder/meshes/rlpd/rlpd_reader.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "common/files/binary_numbers.h"
#include "common/files/float_position.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/piped_frames.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::size_t kHeaderBytes = 44;

// Annex A: the fixed part of the header.
struct RlpdHeader {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_triangles = 0;
  std::uint32_t num_frames = 0;
  FrameRate frame_rate;
  Grid grid;

  std::uint64_t bytes_before_frames() const {
    return kHeaderBytes + std::uint64_t{num_triangles} * 12;
  }
  std::uint64_t overhead_bytes() const { return std::uint64_t{num_vertices} * 12; }
};

InputResult<RlpdHeader> parse_header(const std::string& path,
                                     const std::array<char, kHeaderBytes>& bytes) {
  if (std::string_view(bytes.data(), 4) != "RLPD") {
    return InputError{path + ": does not begin with RLPD; not a .rlpd file"};
  }
  if (load_u32(bytes, 4) != 1) {
    return InputError{path + ": .rlpd version " + to_string(load_u32(bytes, 4)) +
                      " at byte 4; expected 1"};
  }
  RlpdHeader header;
  header.num_vertices = load_u32(bytes, 8);
  header.num_triangles = load_u32(bytes, 12);
  header.num_frames = load_u32(bytes, 16);
  header.frame_rate = {load_u32(bytes, 20), load_u32(bytes, 24)};
  header.grid.log2_step = load_i32(bytes, 28);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    header.grid.origin[axis] = load_i32(bytes, 32 + 4 * axis);
  }
  if (header.frame_rate.numerator == 0 || header.frame_rate.denominator == 0) {
    return InputError{path + ": frame rate " + to_string(header.frame_rate.numerator) + "/" +
                      to_string(header.frame_rate.denominator) +
                      " at byte 20; both parts must be at least 1"};
  }
  if (header.grid.log2_step < -150 || header.grid.log2_step > 127) {
    return InputError{path + ": grid_log2_step " + to_string(header.grid.log2_step) +
                      " at byte 28; expected -150 to 127"};
  }
  return header;
}

InputResult<RlpdHeader> read_header(InputFile& file) {
  std::array<char, kHeaderBytes> bytes{};
  if (file.size() < kHeaderBytes) {
    return InputError{file.path() + ": " + to_string(file.size()) +
                      " bytes; the header of a .rlpd file has " + to_string(kHeaderBytes)};
  }
  if (auto error = file.read(0, bytes)) return *error;
  return parse_header(file.path(), bytes);
}

// Returns the number of frames present, from the size of the file.
InputResult<std::uint32_t> count_frames(const InputFile& file, const RlpdHeader& header) {
  const std::string& path = file.path();
  if (header.num_vertices == 0) return InputError{path + ": no vertices (byte 8)"};
  if (file.size() < header.bytes_before_frames()) {
    return InputError{path + ": " + to_string(file.size()) + " bytes; " +
                      to_string(header.num_triangles) + " triangles alone need " +
                      to_string(header.bytes_before_frames()) + "; the file is truncated"};
  }
  const std::uint64_t payload = file.size() - header.bytes_before_frames();
  const std::uint64_t frames = payload / header.overhead_bytes();
  if (payload % header.overhead_bytes() != 0) {
    return InputError{path + ": " + to_string(file.size()) + " bytes end inside frame " +
                      to_string(frames) + " (from 0); a frame has " +
                      to_string(header.overhead_bytes()) + " bytes"};
  }
  if (frames == 0) return InputError{path + ": the file holds no frame"};
  if (frames > header.num_frames) {
    return InputError{path + ": holds " + to_string(frames) + " frames, but announces " +
                      to_string(header.num_frames) + " at byte 16"};
  }
  return static_cast<std::uint32_t>(frames);
}

InputResult<std::vector<Triangle>> parse_triangles(const std::string& path,
                                                   const RlpdHeader& header,
                                                   std::span<const char> bytes) {
  std::vector<Triangle> triangles(header.num_triangles);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const std::uint32_t v = load_u32(bytes, 12 * t + 4 * corner);
      if (v >= header.num_vertices) {
        return InputError{path + ": triangle " + to_string(t) + " (from 0): index " +
                          to_string(v) + " is out of range 0 to " +
                          to_string(header.num_vertices - 1)};
      }
      triangles[t][corner] = v;
    }
  }
  return triangles;
}

InputResult<std::vector<Triangle>> read_triangles(InputFile& file, const RlpdHeader& header) {
  std::vector<char> bytes(std::size_t{header.num_triangles} * 12);
  if (auto error = file.read(kHeaderBytes, bytes)) return *error;
  return parse_triangles(file.path(), header, bytes);
}

// Returns a position as a double: it has up to 28 bits, floats have 24.
double exact_position(const Grid& grid, std::size_t axis, std::int32_t position) {
  return (static_cast<double>(position) + grid.origin[axis]) * exact_exp2(grid.log2_step);
}

class RlpdSource : public FrameSource {
 public:
  RlpdSource(Shape shape, InputFile file, const RlpdHeader& header)
      : FrameSource(std::move(shape)), file_(std::move(file)), header_(header) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    if (auto error = read_bytes(frame)) return error;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = float_position(header_.grid, i % 3, load_i32(bytes_, 4 * i));
    }
    return check_finite(file_.path(), frame, xyz);
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    if (auto error = read_bytes(frame)) return error;
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      xyz[i] = exact_position(header_.grid, i % 3, load_i32(bytes_, 4 * i));
    }
    return std::nullopt;
  }
  bool is_finer_than_floats() const override { return true; }

  std::string file_of(std::uint32_t /*frame*/) const override { return file_.path(); }

 private:
  std::optional<InputError> read_bytes(std::uint32_t frame) {
    bytes_.resize(3 * std::size_t{num_vertices()} * 4);
    const std::uint64_t offset =
        header_.bytes_before_frames() + frame * header_.overhead_bytes();
    return file_.read(offset, bytes_);
  }

  InputFile file_;
  RlpdHeader header_;
  std::vector<char> bytes_;
};

}  // namespace

InputResult<std::unique_ptr<FrameSource>> open_rlpd(const std::string& path,
                                                    const std::optional<FrameRate>& frame_rate,
                                                    std::uint64_t max_memory_bytes) {
  auto file = InputFile::open(path, max_memory_bytes);
  if (!file) return file.error();
  const auto header = read_header(*file);
  if (!header) return header.error();
  const auto frames = count_frames(*file, *header);
  if (!frames) return frames.error();
  // Triangles are held twice, as bytes and as indices.
  const std::uint64_t mesh_bytes = 24 * std::uint64_t{header->num_triangles};
  if (mesh_bytes + file->memory_bytes() > max_memory_bytes) {
    return InputError{file->path() + ": " + memory_problem(max_memory_bytes)};
  }
  auto triangles = read_triangles(*file, *header);
  if (!triangles) return triangles.error();
  FrameSource::Shape shape{header->num_vertices, *frames,
                           frame_rate.value_or(header->frame_rate), std::move(*triangles)};
  shape.files = {path};
  shape.memory_bytes = mesh_bytes / 2 + file->memory_bytes();
  return std::unique_ptr<FrameSource>(
      std::make_unique<RlpdSource>(std::move(shape), std::move(*file), *header));
}

namespace {

class RlpdStream final : public FrameStream {
 public:
  RlpdStream(Shape shape, std::FILE* file, const Grid& grid)
      : FrameStream(std::move(shape)), frames_(file, this->shape().name), grid_(grid) {}

  InputResult<bool> next_frame(std::span<float> xyz) override {
    bytes_.resize(4 * xyz.size());
    auto read = frames_.read(bytes_);
    if (!read || !*read) return read;
    exact_.resize(xyz.size());
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      const std::int32_t position = load_i32(bytes_, 4 * i);
      xyz[i] = float_position(grid_, i % 3, position);
      exact_[i] = exact_position(grid_, i % 3, position);
    }
    return true;
  }
  std::span<const double> exact() const override { return exact_; }

 private:
  PipedFrames frames_;
  Grid grid_;
  std::vector<char> bytes_;
  std::vector<double> exact_;
};

}  // namespace

InputResult<std::unique_ptr<FrameStream>> open_rlpd_stream(
    std::FILE* file, const std::string& name, const std::optional<FrameRate>& frame_rate,
    std::uint64_t max_memory_bytes) {
  std::array<char, kHeaderBytes> bytes{};
  const InputError ended{name + ": ends before its first frame; expected a .rlpd file"};
  if (std::fread(bytes.data(), 1, bytes.size(), file) < bytes.size()) return ended;
  const auto header = parse_header(name, bytes);
  if (!header) return header.error();
  if (header->num_vertices == 0) return InputError{name + ": no vertices (byte 8)"};
  if (header->bytes_before_frames() * 2 + header->overhead_bytes() > max_memory_bytes) {
    return InputError{name + ": " + memory_problem(max_memory_bytes), true};
  }
  std::vector<char> indices;
  while (indices.size() < std::size_t{header->num_triangles} * 12) {
    // Reads in steps, as the header may announce more than the file has.
    constexpr std::size_t kStep = std::size_t{1} << 20;  // fixed: memory
    const std::size_t before = indices.size();
    indices.resize(std::min(before + kStep, std::size_t{header->num_triangles} * 12));
    const std::size_t wanted = indices.size() - before;
    if (std::fread(&indices[before], 1, wanted, file) < wanted) return ended;
  }
  auto triangles = parse_triangles(name, *header, indices);
  if (!triangles) return triangles.error();
  FrameStream::Shape shape{name, header->num_vertices, frame_rate.value_or(header->frame_rate),
                           std::move(*triangles)};
  return std::unique_ptr<FrameStream>(
      std::make_unique<RlpdStream>(std::move(shape), file, header->grid));
}

namespace {

constexpr std::array<std::string_view, 1> kRlpdExtensions{".rlpd"};

}  // namespace

const InputFormat kRlpdFormat{
    .holds = InputFormat::Holds::kAnimation,
    .extensions = kRlpdExtensions,
    .begins = [](std::string_view beginning) { return beginning.starts_with("RLPD"); },
    .open =
        [](const InputOptions& options) {
          return open_rlpd(options.path, options.frame_rate, options.max_memory_bytes);
        },
};

}  // namespace rlpc
