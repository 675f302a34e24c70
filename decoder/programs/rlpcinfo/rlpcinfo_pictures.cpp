#include "decoder/programs/rlpcinfo/rlpcinfo_pictures.h"

#include <filesystem>
#include <system_error>

#include "common/files/interrupts.h"

namespace rlpc {

namespace fs = std::filesystem;

OutputResult<PictureFolder> PictureFolder::create(const std::string& path,
                                                  const std::string& input) {
  fs::path folder = fs::path(path).lexically_normal();
  if (!folder.has_filename()) folder = folder.parent_path();  // "out/"
  std::error_code ec;
  if (fs::exists(folder, ec) && !fs::is_directory(folder, ec)) {
    return OutputError{path + ": is a file; pictures need a folder, choose another name"};
  }
  auto temporary = TemporaryFolder::create(folder.string());
  if (!temporary) return temporary.error();
  return PictureFolder(folder.string(), input, std::move(*temporary));
}

std::optional<OutputError> PictureFolder::write(const std::vector<GofPicture>& pictures) {
  const auto name_of = [](const GofPicture& picture) { return picture.name + ".svg"; };
  for (const GofPicture& picture : pictures) {
    const std::string target = (fs::path(path_) / name_of(picture)).string();
    if (OutputFile::is_same_file(target, input_)) {
      return OutputError{target + ": is also an input; choose another folder", true};
    }
    auto file =
        OutputFile::create_within((fs::path(temporary_.path()) / name_of(picture)).string());
    if (!file) return file.error();
    if (auto error = file->write(svg_file(picture))) return error;
    if (auto error = file->close()) return error;
  }
  if (auto error = temporary_.sync()) return error;
  std::error_code ec;
  if (!fs::exists(path_, ec)) return temporary_.commit(path_);
  const HoldInterrupts hold;  // all pictures are replaced, or none
  for (const GofPicture& picture : pictures) {
    const std::string target = (fs::path(path_) / name_of(picture)).string();
    if (auto error = temporary_.commit_file(name_of(picture), target)) return error;
  }
  return std::nullopt;
}

}  // namespace rlpc
