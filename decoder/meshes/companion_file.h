// Files that are written next to the one that the user named.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/files/output_file.h"

namespace rlpc {

// Returns an error if `path` may not be replaced. As the user did not name it, only a file that
// rlpcdec wrote may be; its beginning identifies it. what: "the mesh of a.pc2", for messages.
std::optional<OutputError> check_companion(const std::string& path, std::string_view begin,
                                           const std::string& what);

struct CompanionFile {
  std::string name;   // without a folder
  std::string begin;  // beginning of a file that it may replace
  std::string bytes;
};

// Companion files that appear together.
class CompanionFiles {
 public:
  // Checks and creates the files in a folder, under temporary names.
  static OutputResult<CompanionFiles> create(const std::string& folder,
                                             std::vector<CompanionFile> files,
                                             const std::string& what,
                                             const std::shared_ptr<OutputLimit>& limit);

  std::optional<OutputError> write();
  // Renames the files to their names, after write().
  std::optional<OutputError> commit();

 private:
  std::vector<CompanionFile> files_;
  std::vector<OutputFile> outputs_;
};

}  // namespace rlpc
