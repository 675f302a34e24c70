#include "decoder/meshes/companion_file.h"

#include <filesystem>
#include <fstream>
#include <utility>

namespace rlpc {

std::optional<OutputError> check_companion(const std::string& path, std::string_view begin,
                                           const std::string& what) {
  std::string found(begin.size(), '\0');
  std::ifstream file(path);
  file.read(found.data(), static_cast<std::streamsize>(found.size()));
  if (file.gcount() == 0 || found == begin) return std::nullopt;
  return OutputError{path + ": already exists, and is not known to be written by rlpcdec; " +
                     what + " would replace it. Choose another name, or remove it"};
}

OutputResult<CompanionFiles> CompanionFiles::create(const std::string& folder,
                                                    std::vector<CompanionFile> files,
                                                    const std::string& what,
                                                    const std::shared_ptr<OutputLimit>& limit) {
  CompanionFiles created;
  created.files_ = std::move(files);
  for (const CompanionFile& file : created.files_) {
    const std::string path = (std::filesystem::path(folder) / file.name).string();
    if (auto error = check_companion(path, file.begin, what)) return *error;
    auto output = OutputFile::create(path, limit);
    if (!output) return output.error();
    created.outputs_.push_back(std::move(*output));
  }
  return created;
}

std::optional<OutputError> CompanionFiles::write() {
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (auto error = outputs_[i].write(files_[i].bytes)) return error;
    if (auto error = outputs_[i].close()) return error;
  }
  return std::nullopt;
}

std::optional<OutputError> CompanionFiles::commit() {
  for (OutputFile& output : outputs_) {
    if (auto error = output.commit()) return error;
  }
  return std::nullopt;
}

}  // namespace rlpc
