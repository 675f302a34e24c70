// Sink of point caches: X.pc2 or X.mdd, with the mesh X.obj.
#include <cassert>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/binary_numbers.h"
#include "common/files/float_position.h"
#include "common/files/interrupts.h"
#include "common/files/output_file.h"
#include "decoder/meshes/companion_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/mesh_bytes.h"
#include "decoder/meshes/obj_materials.h"

namespace rlpc {

namespace {

constexpr std::uint32_t kMaxCount =
    std::numeric_limits<std::int32_t>::max();  // limit of the format

class PointCacheSink : public FrameSink {
 public:
  // mesh: none in a live stream. library: name of the .mtl file, the first of materials; empty:
  // none.
  PointCacheSink(SinkFormat format, SinkOptions options, OutputFile points,
                 std::optional<OutputFile> mesh, std::string library, CompanionFiles materials)
      : mdd_(format == SinkFormat::kMdd),
        options_(std::move(options)),
        points_(std::move(points)),
        mesh_(std::move(mesh)),
        library_(std::move(library)),
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
    if (auto error = materials_.write()) return error;
    const HoldInterrupts hold;
    if (auto error = materials_.commit()) return error;
    if (auto error = mesh_->commit()) return error;
    return points_.commit();
  }

  std::vector<std::string> remarks() const override { return remarks_; }

 private:
  std::optional<OutputError> write_mesh(std::span<const std::int32_t> positions) {
    const auto mesh = make_mesh_bytes(SinkFormat::kObj, options_, library_);
    remarks_ = left_out_remark(SinkFormat::kObj, options_, *mesh);
    return mesh_->write(mesh->frame(positions));
  }

  // Writes the numbers of frames and points, and the times of the frames in seconds.
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
  std::string library_;
  CompanionFiles materials_;
  std::string bytes_;
  std::vector<std::string> remarks_;
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
                                                 std::nullopt, "", CompanionFiles());
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
  const std::filesystem::path name(path);
  std::vector<CompanionFile> files = ObjMaterials(options).files(name.stem().string());
  std::string library = files.empty() ? std::string() : files[0].name;
  auto materials = CompanionFiles::create(name.parent_path().string(), std::move(files),
                                          "the materials of " + path, options.limit);
  if (!materials) return materials.error();
  auto sink = std::make_unique<PointCacheSink>(format, std::move(options), std::move(*points),
                                               std::move(*mesh), std::move(library),
                                               std::move(*materials));
  if (auto error = sink->write_header()) return *error;
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace rlpc
