// The sink of point caches: X.pc2 or X.mdd, with the mesh X.obj.
#include <array>
#include <cassert>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>

#include "common/io/binary_numbers.h"
#include "common/io/float_position.h"
#include "common/io/interrupts.h"
#include "common/io/output_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace {

constexpr std::uint32_t kMaxCount = std::numeric_limits<std::int32_t>::max();  // of the format

class PointCacheSink : public FrameSink {
 public:
  // mesh: none in a live stream.
  PointCacheSink(SinkFormat format, SinkOptions options, OutputFile points,
                 std::optional<OutputFile> mesh)
      : mdd_(format == SinkFormat::kMdd),
        options_(std::move(options)),
        points_(std::move(points)),
        mesh_(std::move(mesh)) {}

  std::optional<OutputError> write_header() {
    if (mdd_) return write_mdd_header();
    std::string bytes("POINTCACHE2\0", 12);
    append_u32(bytes, 1);
    append_u32(bytes, options_.num_vertices);
    append_f32(bytes, 0);  // start
    append_f32(bytes, 1);  // frames per sample
    append_u32(bytes, options_.live ? 0 : options_.num_frames);
    return points_.write(bytes);
  }

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    if (written_++ == 0 && mesh_) {
      if (auto error = mesh_->write(MeshBytes(SinkFormat::kObj, options_).frame(positions))) {
        return error;
      }
    }
    bytes_.clear();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      const float x = float_position(options_.grid, i % 3, positions[i]);
      mdd_ ? append_f32_be(bytes_, x) : append_f32(bytes_, x);
    }
    if (auto error = points_.write(bytes_)) return error;
    return options_.live ? points_.flush() : std::nullopt;
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames || options_.live);
    if (auto error = points_.close()) return error;
    if (!mesh_) return points_.commit();
    if (auto error = mesh_->close()) return error;
    const HoldInterrupts hold;
    if (auto error = mesh_->commit()) return error;
    return points_.commit();
  }

 private:
  // Frames, points, and the times of the frames in seconds.
  std::optional<OutputError> write_mdd_header() {
    std::string bytes;
    append_u32_be(bytes, options_.num_frames);
    append_u32_be(bytes, options_.num_vertices);
    for (std::uint32_t f = 0; f < options_.num_frames; ++f) {
      append_f32_be(bytes, frame_time(options_.frame_rate, f));
    }
    return points_.write(bytes);
  }

  bool mdd_;
  SinkOptions options_;
  OutputFile points_;
  std::optional<OutputFile> mesh_;
  std::string bytes_;
  std::uint32_t written_ = 0;
};

// Whether X.obj may be replaced: since the user did not name it, only a file that MeshBytes
// wrote, which its beginning shows.
bool may_replace_mesh(const std::string& path) {
  constexpr std::string_view kOurs = "# frame_rate ";
  std::array<char, kOurs.size()> begin{};
  std::ifstream file(path);
  file.read(begin.data(), begin.size());
  return file.gcount() == 0 || std::string_view(begin.data(), begin.size()) == kOurs;
}

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_point_cache_sink(const std::string& path,
                                                               SinkFormat format,
                                                               SinkOptions options) {
  if (options.num_vertices > kMaxCount || options.num_frames > kMaxCount) {
    return OutputError{path + ": a point cache holds at most 2147483647 vertices and frames"};
  }
  if (options.live) {
    auto points = OutputFile::create(path, options.limit);
    if (!points) return points.error();
    auto sink = std::make_unique<PointCacheSink>(format, std::move(options), std::move(*points),
                                                 std::nullopt);
    if (auto error = sink->write_header()) return *error;
    return std::unique_ptr<FrameSink>(std::move(sink));
  }
  const std::string mesh_path = std::filesystem::path(path).replace_extension(".obj").string();
  if (OutputFile::is_same_file(path, mesh_path)) {
    return OutputError{path + ": the mesh of the point cache goes to " + mesh_path +
                       "; choose another name"};
  }
  if (!may_replace_mesh(mesh_path)) {
    return OutputError{mesh_path + ": already exists, not written by rlpcdec; the mesh of " +
                       path + " would replace it. Choose another name, or remove it"};
  }
  auto points = OutputFile::create(path, options.limit);
  if (!points) return points.error();
  auto mesh = OutputFile::create(mesh_path, options.limit);
  if (!mesh) return mesh.error();
  auto sink = std::make_unique<PointCacheSink>(format, std::move(options), std::move(*points),
                                               std::move(*mesh));
  if (auto error = sink->write_header()) return *error;
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace rlpc
