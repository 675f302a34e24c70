// Sinks that write one mesh file per frame: OBJ, PLY.
#include <cassert>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "common/files/interrupts.h"
#include "common/files/numbered_name.h"
#include "common/files/output_file.h"
#include "decoder/meshes/companion_file.h"
#include "decoder/meshes/frame_sink.h"
#include "decoder/meshes/mesh_bytes.h"
#include "decoder/meshes/obj_materials.h"

namespace rlpc {

namespace fs = std::filesystem;

namespace {

class MeshSink : public FrameSink {
 public:
  MeshSink(SinkFormat format, SinkOptions options, fs::path folder, NumberedName name,
           TemporaryFolder temporary, std::vector<CompanionFile> materials)
      : format_(format),
        options_(std::move(options)),
        materials_(std::move(materials)),
        mesh_(make_mesh_bytes(format, options_,
                              materials_.empty() ? std::string() : materials_[0].name)),
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
    for (const CompanionFile& file : materials_) {
      if (auto error = temporary_.commit_file(file.name, (folder_ / file.name).string())) {
        return error;
      }
    }
    return std::nullopt;
  }

  std::vector<std::string> remarks() const override {
    return left_out_remark(format_, options_, *mesh_);
  }

 private:
  std::string file_name(std::uint32_t frame) const {
    return name_.with(std::uint64_t{options_.first_number} + frame);
  }

  std::optional<OutputError> write_materials() const {
    for (const CompanionFile& material : materials_) {
      const fs::path path = fs::path(temporary_.path()) / material.name;
      auto file = OutputFile::create_within(path.string(), options_.limit);
      if (!file) return file.error();
      if (auto error = file->write(material.bytes)) return error;
      if (auto error = file->close()) return error;
    }
    return std::nullopt;
  }

  SinkFormat format_;
  SinkOptions options_;
  std::vector<CompanionFile> materials_;  // .mtl file first; may be empty
  std::unique_ptr<MeshBytes> mesh_;
  fs::path folder_;
  NumberedName name_;
  TemporaryFolder temporary_;
  std::uint32_t written_ = 0;
};

// Writes a single frame: one file, and perhaps its materials.
class SingleMeshSink : public FrameSink {
 public:
  // library: name of the .mtl file, the first of materials; empty: none.
  SingleMeshSink(SinkFormat format, SinkOptions options, OutputFile file,
                 const std::string& library, CompanionFiles materials)
      : format_(format),
        options_(std::move(options)),
        mesh_(make_mesh_bytes(format, options_, library)),
        file_(std::move(file)),
        materials_(std::move(materials)) {}

  std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) override {
    return file_.write(mesh_->frame(positions));
  }

  std::optional<OutputError> finish() override {
    if (auto error = file_.close()) return error;
    if (auto error = materials_.write()) return error;
    const HoldInterrupts hold;
    if (auto error = materials_.commit()) return error;
    return file_.commit();
  }

  std::vector<std::string> remarks() const override {
    return left_out_remark(format_, options_, *mesh_);
  }

 private:
  SinkFormat format_;
  SinkOptions options_;
  std::unique_ptr<MeshBytes> mesh_;
  OutputFile file_;
  CompanionFiles materials_;
};

// Returns the beginning of the names of materials of a sequence: "walk" for "walk_%04d.obj".
std::string stem_of(const NumberedName& name) {
  const std::size_t last = name.prefix.find_last_not_of("_-. ");
  return last == std::string::npos ? "materials" : name.prefix.substr(0, last + 1);
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
  std::vector<CompanionFile> files;
  if (is_file && format == SinkFormat::kObj) {
    files = ObjMaterials(options).files(fs::path(path).stem().string());
  }
  const std::string library = files.empty() ? std::string() : files[0].name;
  auto materials =
      CompanionFiles::create(fs::path(path).parent_path().string(), std::move(files),
                             "the materials of " + path, options.limit);
  if (!materials) return materials.error();
  return std::unique_ptr<FrameSink>(std::make_unique<SingleMeshSink>(
      format, options, std::move(*file), library, std::move(*materials)));
}

OutputResult<std::unique_ptr<FrameSink>> open_mesh_sink(const std::string& pattern,
                                                        SinkFormat format,
                                                        SinkOptions options) {
  const fs::path path(pattern);
  auto name = parse_pattern(path.filename().string());
  if (!name) {
    return OutputError{pattern +
                           ": expected one %d, %04d or #### (any width) in the file name, as "
                           "in out/frame_%04d.obj" +
                           advice_on_pattern(path.filename().string()),
                       true};
  }
  fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ec;
  if (fs::exists(folder, ec) && !fs::is_directory(folder, ec)) {
    return OutputError{folder.string() + ": is a file; a folder of files cannot go there"};
  }
  std::vector<CompanionFile> materials;
  if (format == SinkFormat::kObj) materials = ObjMaterials(options).files(stem_of(*name));
  for (const CompanionFile& file : materials) {
    if (auto error = check_companion((folder / file.name).string(), file.begin,
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
