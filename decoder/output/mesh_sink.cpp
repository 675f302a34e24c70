// Sinks that write one mesh file per frame: OBJ, PLY.
#include <cassert>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

#include "common/io/interrupts.h"
#include "common/io/numbered_name.h"
#include "common/io/output_file.h"
#include "decoder/output/companion_file.h"
#include "decoder/output/frame_sink.h"
#include "decoder/output/mesh_bytes.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

class MeshSink : public FrameSink {
 public:
  MeshSink(SinkFormat format, SinkOptions options, fs::path folder, NumberedName name,
           TemporaryFolder temporary, std::string materials)
      : options_(std::move(options)),
        materials_(std::move(materials)),
        mesh_(make_mesh_bytes(format, options_, materials_)),
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
    if (auto error = file->write(mesh_->frame(positions))) return error;
    return file->close();
  }

  std::optional<OutputError> finish() override {
    assert(written_ == options_.num_frames || options_.live);
    if (auto error = write_materials()) return error;
    if (auto error = temporary_.sync()) return error;
    std::error_code ec;
    if (!fs::exists(folder_, ec)) return temporary_.commit(folder_.string());
    const HoldInterrupts hold;  // all frames are replaced, or none
    for (std::uint32_t i = 0; i < written_; ++i) {
      const std::string name = file_name(i);
      if (auto error = temporary_.commit_file(name, (folder_ / name).string())) return error;
    }
    if (materials_.empty()) return std::nullopt;
    return temporary_.commit_file(materials_, (folder_ / materials_).string());
  }

 private:
  std::string file_name(std::uint32_t frame) const {
    return name_.with(std::uint64_t{options_.first_number} + frame);
  }

  std::optional<OutputError> write_materials() const {
    if (materials_.empty()) return std::nullopt;
    const fs::path path = fs::path(temporary_.path()) / materials_;
    auto file = OutputFile::create_within(path.string(), options_.limit);
    if (!file) return file.error();
    if (auto error = file->write(mtl_text(options_))) return error;
    return file->close();
  }

  SinkOptions options_;
  std::string materials_;  // name of the .mtl file; empty: none
  std::unique_ptr<MeshBytes> mesh_;
  fs::path folder_;
  NumberedName name_;
  TemporaryFolder temporary_;
  std::uint32_t written_ = 0;
};

// A single frame: one file, and perhaps its materials.
class SingleMeshSink : public FrameSink {
 public:
  // materials: the .mtl file, if there are any.
  SingleMeshSink(SinkFormat format, SinkOptions options, OutputFile file,
                 std::optional<OutputFile> materials)
      : options_(std::move(options)),
        mesh_(make_mesh_bytes(
            format, options_,
            materials ? fs::path(materials->path()).filename().string() : std::string())),
        file_(std::move(file)),
        materials_(std::move(materials)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    return file_.write(mesh_->frame(positions));
  }

  std::optional<OutputError> finish() override {
    if (auto error = file_.close()) return error;
    if (!materials_) return file_.commit();
    if (auto error = materials_->write(mtl_text(options_))) return error;
    if (auto error = materials_->close()) return error;
    const HoldInterrupts hold;
    if (auto error = materials_->commit()) return error;
    return file_.commit();
  }

 private:
  SinkOptions options_;
  std::unique_ptr<MeshBytes> mesh_;
  OutputFile file_;
  std::optional<OutputFile> materials_;
};

// The name of the .mtl file of a sequence: "walk.mtl" for "walk_%04d.obj".
std::string materials_of(const NumberedName& name) {
  const std::size_t last = name.prefix.find_last_not_of("_-. ");
  const std::string stem =
      last == std::string::npos ? "materials" : name.prefix.substr(0, last + 1);
  return stem + ".mtl";
}

bool needs_materials(SinkFormat format, const SinkOptions& options) {
  return format == SinkFormat::kObj && !mtl_text(options).empty();
}

}  // namespace

OutputResult<std::unique_ptr<FrameSink>> open_single_mesh_sink(const std::string& path,
                                                               SinkFormat format,
                                                               const SinkOptions& options) {
  assert(options.num_frames == 1);
  auto file = OutputFile::create(path, options.limit);
  if (!file) return file.error();
  std::error_code ec;
  const bool is_file = path != "-" && (!fs::exists(path, ec) || fs::is_regular_file(path, ec));
  std::optional<OutputFile> materials;
  if (is_file && needs_materials(format, options)) {
    const std::string beside = fs::path(path).replace_extension(".mtl").string();
    if (auto error = check_companion(beside, kMtlBegin, "the materials of " + path)) {
      return *error;
    }
    auto created = OutputFile::create(beside, options.limit);
    if (!created) return created.error();
    materials.emplace(std::move(*created));
  }
  return std::unique_ptr<FrameSink>(std::make_unique<SingleMeshSink>(
      format, options, std::move(*file), std::move(materials)));
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
  std::string materials;
  if (needs_materials(format, options)) {
    materials = materials_of(*name);
    if (auto error = check_companion((folder / materials).string(), kMtlBegin,
                                     "the materials of " + pattern)) {
      return *error;
    }
  }
  auto temporary = TemporaryFolder::create(folder.string());
  if (!temporary) return temporary.error();
  return std::unique_ptr<FrameSink>(std::make_unique<MeshSink>(
      format, std::move(options), std::move(folder), std::move(*name), std::move(*temporary),
      std::move(materials)));
}

}  // namespace rlpc
