// Values of a glTF document that know their place in it.
//
// A reader asks for what the specification of glTF 2.0 promises. The first promise that is
// broken is kept as an error; the value then read is a legal one, so that readers need no check
// after each step, only one before they use what they have read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "encoder/input/frame_source.h"

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

// A value, or the place where one is missing. Refers to the document and the errors.
class GltfValue {
 public:
  // Sums of such, and products with small numbers, fit.
  static constexpr std::uint64_t kMaxInteger = std::uint64_t{1} << 53;
  struct Range {
    std::uint64_t min;
    std::uint64_t max;  // at most kMaxInteger
  };

  GltfValue(const nlohmann::json& root, GltfErrors& errors) : json_(&root), errors_(&errors) {}

  bool exists() const { return json_ != nullptr; }
  const std::string& path() const { return path_; }  // "accessors[3].count"
  // Of an object; a member that is missing, or of something missing, does not exist.
  GltfValue operator[](std::string_view member) const;
  // Of an array: i < size().
  GltfValue operator[](std::size_t i) const;
  // Elements of an array; 0 if it does not exist.
  std::size_t size() const;

  // Without `absent`, the value must exist.
  std::uint64_t integer(Range range, std::optional<std::uint64_t> absent = {}) const;
  bool boolean(bool absent) const;
  std::string text(const std::optional<std::string>& absent = {}) const;
  // As many as `count`; `absent` if it does not exist.
  std::vector<double> numbers(std::size_t count, const std::vector<double>& absent) const;
  // Below `count`, which is that of the array `of`.
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

// In double quotes, as in JSON; long ones are cut.
std::string gltf_quoted(const std::string& text);

}  // namespace rlpc
