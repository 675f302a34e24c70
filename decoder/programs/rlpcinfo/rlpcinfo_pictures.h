// rlpcinfo --pictures: a folder of SVG files.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/files/output_file.h"
#include "decoder/report/gof_pictures.h"

namespace rlpc {

class PictureFolder {
 public:
  // Creates a temporary folder. input: the stream, which must not be replaced.
  static OutputResult<PictureFolder> create(const std::string& path, const std::string& input);

  // Writes NAME.svg for each picture; they appear together, and replace existing files.
  std::optional<OutputError> write(const std::vector<GofPicture>& pictures);

 private:
  PictureFolder(std::string path, std::string input, TemporaryFolder temporary)
      : path_(std::move(path)), input_(std::move(input)), temporary_(std::move(temporary)) {}

  std::string path_;
  std::string input_;
  TemporaryFolder temporary_;
};

}  // namespace rlpc
