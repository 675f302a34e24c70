// What OBJ files have that streams do not.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

// Counts it while a file is read.
class ObjRest {
 public:
  // A line whose keyword the reader does not know, and the first word after it.
  void add_line(std::string_view keyword, std::string_view word);
  // A weight after x, y, z other than 1.
  void add_weight() { ++weights_; }
  // Other numbers or words after x, y, z, which are no colour.
  void add_vertex_numbers() { ++vertex_numbers_; }
  void add_third_uv() { ++third_uv_; }

  // Lines that are none of an OBJ file.
  std::uint64_t num_unknown_lines() const { return unknown_lines_; }
  // "dropped: lines (2), smoothing groups"; none: there is nothing.
  std::optional<std::string> note() const;

 private:
  std::map<std::string, std::uint64_t, std::less<>> kinds_;  // numbers of lines
  std::string unknown_;                                      // the first such keyword
  std::uint64_t unknown_lines_ = 0;
  std::uint64_t weights_ = 0;
  std::uint64_t vertex_numbers_ = 0;
  std::uint64_t third_uv_ = 0;
};

}  // namespace rlpc
