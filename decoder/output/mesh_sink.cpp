// Sinks that write one mesh file per frame: OBJ, PLY.
#include <cassert>
#include <filesystem>
#include <system_error>
#include <utility>

#include "common/io/interrupts.h"
#include "common/io/numbered_name.h"
#include "common/io/output_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

class MeshSink : public FrameSink {
 public:
  MeshSink(SinkFormat format, SinkOptions options, fs::path folder, NumberedName name,
           TemporaryFolder temporary)
      : mesh_(format, options),
        options_(std::move(options)),
        folder_(std::move(folder)),
        name_(std::move(name)),
        temporary_(std::move(temporary)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    assert(positions.size() == 3 * std::size_t{options_.num_vertices});
    assert(written_ < options_.num_frames);
    const fs::path path = fs::path(temporary_.path()) / file_name(written_);
    auto file = OutputFile::create_within(path.string(), options_.limit);
    if (!file) return file.error();
    ++written_;
    if (auto error = file->write(mesh_.frame(positions))) return error;
    return file->close();
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames || options_.live);
    if (auto error = temporary_.sync()) return error;
    std::error_code ec;
    if (!fs::exists(folder_, ec)) return temporary_.commit(folder_.string());
    const HoldInterrupts hold;  // all frames are replaced, or none
    for (std::uint32_t i = 0; i < written_; ++i) {
      const std::string name = file_name(i);
      if (auto error = temporary_.commit_file(name, (folder_ / name).string())) return error;
    }
    return std::nullopt;
  }

 private:
  std::string file_name(std::uint32_t frame) const {
    return name_.with(std::uint64_t{options_.first_number} + frame);
  }

  MeshBytes mesh_;
  SinkOptions options_;
  fs::path folder_;
  NumberedName name_;
  TemporaryFolder temporary_;
  std::uint32_t written_ = 0;
};

// A single frame: one file.
class SingleMeshSink : public FrameSink {
 public:
  SingleMeshSink(SinkFormat format, const SinkOptions& options, OutputFile file)
      : mesh_(format, options), file_(std::move(file)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    return file_.write(mesh_.frame(positions));
  }

  std::optional<OutputError> finish() override {
    if (auto error = file_.close()) return error;
    return file_.commit();
  }

 private:
  MeshBytes mesh_;
  OutputFile file_;
};

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_single_mesh_sink(const std::string& path,
                                                               SinkFormat format,
                                                               const SinkOptions& options) {
  assert(options.num_frames == 1);
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  return std::unique_ptr<FrameSink>(
      std::make_unique<SingleMeshSink>(format, options, std::move(*file)));
}

OutputResult<std::unique_ptr<FrameSink>> open_mesh_sink(const std::string& pattern,
                                                        SinkFormat format,
                                                        SinkOptions options) {
  const fs::path path(pattern);
  auto name = parse_pattern(path.filename().string());
  if (!name) {
    return OutputError{pattern +
                           ": expected one %d or %04d (any width) in the file name, as in "
                           "out/frame_%04d.obj",
                       true};
  }
  fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ec;
  if (fs::exists(folder, ec) && !fs::is_directory(folder, ec)) {
    return OutputError{folder.string() + ": is a file; a folder of files cannot go there"};
  }
  auto temporary = TemporaryFolder::create(folder.string());
  if (!temporary) return temporary.error();
  return std::unique_ptr<FrameSink>(std::make_unique<MeshSink>(
      format, std::move(options), std::move(folder), std::move(*name), std::move(*temporary)));
}

}  // namespace rlpc
