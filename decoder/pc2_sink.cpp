// Point cache with its mesh: X.pc2 and X.obj.
#include <cassert>
#include <filesystem>
#include <limits>
#include <utility>

#include "decoder/float_position.h"
#include "decoder/frame_sink.h"
#include "decoder/obj_text.h"
#include "decoder/output_file.h"

namespace rlpc {

namespace {

constexpr std::uint32_t kMaxCount = std::numeric_limits<std::int32_t>::max();  // of the format

class Pc2Sink : public FrameSink {
 public:
  Pc2Sink(SinkOptions options, OutputFile points, OutputFile mesh)
      : options_(std::move(options)), points_(std::move(points)), mesh_(std::move(mesh)) {}

  std::optional<OutputError> write_header() {
    std::string bytes("POINTCACHE2\0", 12);
    append_u32(bytes, 1);
    append_u32(bytes, options_.num_vertices);
    append_f32(bytes, 0);  // start
    append_f32(bytes, 1);  // frames per sample
    append_u32(bytes, options_.num_frames);
    return points_.write(bytes);
  }

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    if (written_++ == 0) {
      if (auto error = write_mesh(positions)) return error;
    }
    bytes_.clear();
    for (std::size_t i = 0; i < positions.size(); ++i) {
      append_f32(bytes_, float_position(options_.grid, i % 3, positions[i]));
    }
    return points_.write(bytes_);
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames);
    for (OutputFile* file : {&points_, &mesh_}) {
      if (auto error = file->close()) return error;
    }
    for (OutputFile* file : {&mesh_, &points_}) {
      if (auto error = file->commit()) return error;
    }
    return std::nullopt;
  }

 private:
  std::optional<OutputError> write_mesh(std::span<const std::int32_t> positions) {
    std::string text;
    append_obj_frame_rate(text, options_.frame_rate);
    append_obj_vertices(text, options_.grid, positions);
    append_obj_faces(text, options_.triangles);
    return mesh_.write(text);
  }

  SinkOptions options_;
  OutputFile points_;
  OutputFile mesh_;
  std::string bytes_;
  std::uint32_t written_ = 0;
};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_pc2_sink(const std::string& path,
                                                       SinkOptions options) {
  if (options.num_vertices > kMaxCount || options.num_frames > kMaxCount) {
    return OutputError{path + ": a point cache holds at most 2147483647 vertices and frames"};
  }
  auto points = OutputFile::create(path);
  if (!points) return points.error();
  auto mesh =
      OutputFile::create(std::filesystem::path(path).replace_extension(".obj").string());
  if (!mesh) return mesh.error();
  auto sink =
      std::make_unique<Pc2Sink>(std::move(options), std::move(*points), std::move(*mesh));
  if (auto error = sink->write_header()) return *error;
  return std::unique_ptr<FrameSink>(std::move(sink));
}

}  // namespace rlpc
