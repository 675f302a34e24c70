// The sink of point caches: X.pc2 or X.mdd, with the mesh X.obj.
#include <cassert>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include "common/io/binary_numbers.h"
#include "common/io/float_position.h"
#include "common/io/interrupts.h"
#include "common/io/output_file.h"
#include "decoder/output/companion_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace {

constexpr std::uint32_t kMaxCount = std::numeric_limits<std::int32_t>::max();  // of the format

class PointCacheSink : public FrameSink {
 public:
  // mesh: none in a live stream. materials: of the mesh, if it has any.
  PointCacheSink(SinkFormat format, SinkOptions options, OutputFile points,
                 std::optional<OutputFile> mesh, std::optional<OutputFile> materials)
      : mdd_(format == SinkFormat::kMdd),
        options_(std::move(options)),
        points_(std::move(points)),
        mesh_(std::move(mesh)),
        materials_(std::move(materials)) {}

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
      if (auto error = write_mesh(positions)) return error;
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
    if (materials_) {
      if (auto error = materials_->close()) return error;
    }
    const HoldInterrupts hold;
    if (materials_) {
      if (auto error = materials_->commit()) return error;
    }
    if (auto error = mesh_->commit()) return error;
    return points_.commit();
  }

 private:
  std::optional<OutputError> write_mesh(std::span<const std::int32_t> positions) {
    std::string name;
    if (materials_) {
      name = std::filesystem::path(materials_->path()).filename().string();
      if (auto error = materials_->write(mtl_text(options_))) return error;
    }
    return mesh_->write(make_mesh_bytes(SinkFormat::kObj, options_, name)->frame(positions));
  }

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
  std::optional<OutputFile> materials_;
  std::string bytes_;
  std::uint32_t written_ = 0;
};

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
                                                 std::nullopt, std::nullopt);
    if (auto error = sink->write_header()) return *error;
    return std::unique_ptr<FrameSink>(std::move(sink));
  }
  const std::string mesh_path = std::filesystem::path(path).replace_extension(".obj").string();
  if (OutputFile::is_same_file(path, mesh_path)) {
    return OutputError{path + ": the mesh of the point cache goes to " + mesh_path +
                       "; choose another name"};
  }
  if (auto error = check_companion(mesh_path, "# frame_rate ", "the mesh of " + path)) {
    return *error;
  }
  auto points = OutputFile::create(path, options.limit);
  if (!points) return points.error();
  auto mesh = OutputFile::create(mesh_path, options.limit);
  if (!mesh) return mesh.error();
  std::optional<OutputFile> materials;
  if (!mtl_text(options).empty()) {
    const std::string beside = std::filesystem::path(path).replace_extension(".mtl").string();
    if (auto error = check_companion(beside, kMtlBegin, "the materials of " + path)) {
      return *error;
    }
    auto created = OutputFile::create(beside, options.limit);
    if (!created) return created.error();
    materials.emplace(std::move(*created));
  }
  auto sink = std::make_unique<PointCacheSink>(format, std::move(options), std::move(*points),
                                               std::move(*mesh), std::move(materials));
  if (auto error = sink->write_header()) return *error;
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace rlpc
