// Access to the JSON values of a glTF document, with error messages that contain their path.
//
// Readers request what glTF 2.0 requires. The first violation is kept as an error, and the
// request returns a legal value, so that readers need to check only once, before they use the
// result.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

// The first error of a file: "FILE: PLACE: found X, expected Y".
class GltfErrors {
 public:
  explicit GltfErrors(std::string file) : file_(std::move(file)) {}

  void expected(const std::string& place, const std::string& found,
                const std::string& expected);
  void add(const std::string& place, const std::string& what);
  void add(const InputError& error);
  explicit operator bool() const { return first_.has_value(); }
  const InputError& first() const { return *first_; }

 private:
  std::string file_;
  std::optional<InputError> first_;
};

// A value, or the place of a missing value. Keeps references to the document and the errors.
class GltfValue {
 public:
  // Sums of such integers, and products with small numbers, fit 64 bits.
  static constexpr std::uint64_t kMaxInteger = std::uint64_t{1} << 53;
  struct Range {
    std::uint64_t min;
    std::uint64_t max;  // at most kMaxInteger
  };

  GltfValue(const nlohmann::json& root, GltfErrors& errors) : json_(&root), errors_(&errors) {}

  bool exists() const { return json_ != nullptr; }
  const std::string& path() const { return path_; }  // "accessors[3].count"
  // Returns a member of an object; missing members, also of missing values, do not exist.
  GltfValue operator[](std::string_view member) const;
  // Returns the names of the members of an object; empty if it is not an object.
  std::vector<std::string> names() const;
  // Returns an element of an array, i < size().
  GltfValue operator[](std::size_t i) const;
  // Returns the number of elements of an array; 0 if it does not exist.
  std::size_t size() const;

  // Return a typed value. If it does not exist: `absent` if given, otherwise an error.
  std::uint64_t integer(Range range, std::optional<std::uint64_t> absent = {}) const;
  bool boolean(bool absent) const;
  std::string text(const std::optional<std::string>& absent = {}) const;
  // Returns exactly `count` numbers; `absent` if the value does not exist.
  std::vector<double> numbers(std::size_t count, const std::vector<double>& absent) const;
  // Returns an index below `count`, the size of the array `of`.
  std::uint32_t index(std::size_t count, const char* of) const;
  std::optional<std::uint32_t> index_if_any(std::size_t count, const char* of) const;

  void fail(const std::string& expected) const;

 private:
  GltfValue(const nlohmann::json* json, std::string path, GltfErrors* errors)
      : json_(json), path_(std::move(path)), errors_(errors) {}
  std::string found() const;

  const nlohmann::json* json_;
  std::string path_;
  GltfErrors* errors_;
};

// Returns a member of a value that may not be an object, without an error; null: no such
// member.
const nlohmann::json& gltf_member(const nlohmann::json& value, const char* key);

// Returns the text in double quotes, as in JSON; long ones are shortened.
std::string gltf_quoted(const std::string& text);

}  // namespace rlpc
