// Contents of OBJ files that streams cannot hold.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

// Counts these contents while a file is read.
class ObjRest {
 public:
  // Adds a line whose keyword the reader does not know, and the first word after it.
  void add_line(std::string_view keyword, std::string_view word);
  // Adds a weight after x, y, z other than 1.
  void add_weight() { ++weights_; }
  // Adds other numbers or words after x, y, z, which are no colour.
  void add_vertex_numbers() { ++vertex_numbers_; }
  void add_third_uv() { ++third_uv_; }

  // Returns the number of lines that do not belong in an OBJ file.
  std::uint64_t num_unknown_lines() const { return unknown_lines_; }
  // Returns "dropped: lines (2), smoothing groups"; none: nothing was dropped.
  std::optional<std::string> note() const;

 private:
  std::map<std::string, std::uint64_t, std::less<>> kinds_;  // number of lines, [kind]
  std::string unknown_;                                      // the first such keyword
  std::uint64_t unknown_lines_ = 0;
  std::uint64_t weights_ = 0;
  std::uint64_t vertex_numbers_ = 0;
  std::uint64_t third_uv_ = 0;
};

}  // namespace rlpc
