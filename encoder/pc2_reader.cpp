#include "encoder/pc2_reader.h"

#include <array>
#include <cassert>
#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/input_file.h"
#include "encoder/obj_reader.h"

namespace rlpc {

namespace {

using std::to_string;

constexpr std::size_t kHeaderBytes = 32;
constexpr std::string_view kMagic("POINTCACHE2\0", 12);

// Number of samples, after comparing the header with the mesh and with the size of the file.
InputResult<std::uint32_t> check_header(InputFile& file, const std::string& mesh_path,
                                        std::uint32_t num_vertices) {
  const std::string& path = file.path();
  std::array<char, kHeaderBytes> header{};
  if (file.size() < kHeaderBytes) {
    return InputError{path + ": " + to_string(file.size()) +
                      " bytes; a point cache has at least a header of " +
                      to_string(kHeaderBytes)};
  }
  if (auto error = file.read(0, header)) return *error;
  if (std::string_view(header.data(), kMagic.size()) != kMagic) {
    return InputError{path + ": does not begin with POINTCACHE2; not a PC2 point cache"};
  }
  const std::int32_t version = load_i32(header, 12);
  if (version != 1) {
    return InputError{path + ": PC2 version " + to_string(version) + " at byte 12; expected 1"};
  }
  const std::int32_t points = load_i32(header, 16);
  if (points < 0 || static_cast<std::uint32_t>(points) != num_vertices) {
    return InputError{path + ": " + to_string(points) + " points per frame, but " + mesh_path +
                      " has " + to_string(num_vertices) +
                      " vertices; use the mesh and the cache of the same export"};
  }
  const std::int32_t samples = load_i32(header, 28);
  if (samples < 1) {
    return InputError{path + ": " + to_string(samples) + " samples; expected at least 1 frame"};
  }
  // points is the size of a mesh in memory, so this fits 64 bits.
  const std::uint64_t expected =
      kHeaderBytes + std::uint64_t{num_vertices} * 12 * static_cast<std::uint64_t>(samples);
  if (file.size() != expected) {
    return InputError{path + ": " + to_string(file.size()) + " bytes; expected " +
                      to_string(expected) + " for " + to_string(samples) + " frames of " +
                      to_string(points) + " points; the file is " +
                      (file.size() < expected ? "truncated" : "too long")};
  }
  return static_cast<std::uint32_t>(samples);
}

class Pc2Source : public FrameSource {
 public:
  Pc2Source(Shape shape, InputFile file)
      : FrameSource(std::move(shape)), file_(std::move(file)) {}

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    assert(frame < num_frames() && xyz.size() == 3 * std::size_t{num_vertices()});
    bytes_.resize(xyz.size() * 4);
    if (auto error = file_.read(kHeaderBytes + frame * std::uint64_t{bytes_.size()}, bytes_)) {
      return error;
    }
    for (std::size_t i = 0; i < xyz.size(); ++i) xyz[i] = load_f32(bytes_, 4 * i);
    return check_finite(file_.path(), frame, xyz);
  }

 private:
  InputFile file_;
  std::vector<char> bytes_;
};

}  // namespace

InputResult<std::unique_ptr<FrameSource>> open_pc2(const std::string& mesh_path,
                                                   const std::string& points_path,
                                                   const std::optional<FrameRate>& frame_rate) {
  auto mesh = read_obj(mesh_path);
  if (!mesh) return mesh.error();
  auto file = InputFile::open(points_path);
  if (!file) return file.error();
  FrameSource::Shape shape;
  shape.num_vertices = static_cast<std::uint32_t>(mesh->xyz.size() / 3);
  const auto samples = check_header(*file, mesh_path, shape.num_vertices);
  if (!samples) return samples.error();
  shape.num_frames = *samples;
  shape.frame_rate = frame_rate.value_or(mesh->frame_rate.value_or(FrameRate{}));
  shape.triangles = std::move(mesh->triangles);
  return std::unique_ptr<FrameSource>(
      std::make_unique<Pc2Source>(std::move(shape), std::move(*file)));
}

}  // namespace rlpc
