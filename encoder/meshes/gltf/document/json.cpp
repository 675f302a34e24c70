#include "encoder/meshes/gltf/document/json.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/json/json.h"

namespace rlpc {

using std::to_string;

void GltfErrors::expected(const std::string& place, const std::string& found,
                          const std::string& expected) {
  add(place, "found " + found + ", expected " + expected);
}

void GltfErrors::add(const std::string& place, const std::string& what) {
  if (!first_) first_ = InputError{file_ + (place.empty() ? "" : ": " + place) + ": " + what};
}

void GltfErrors::add(const InputError& error) {
  if (!first_) first_ = error;
}

GltfValue GltfValue::operator[](std::string_view member) const {
  const std::string path =
      path_.empty() ? std::string(member) : path_ + "." + std::string(member);
  if (!json_) return {nullptr, path, errors_};
  if (!json_->is_object()) {
    fail("an object");
    return {nullptr, path, errors_};
  }
  const auto found = json_->find(std::string(member));
  return {found == json_->end() ? nullptr : &*found, path, errors_};
}

std::vector<std::string> GltfValue::names() const {
  std::vector<std::string> names;
  if (!json_ || !json_->is_object()) return names;
  for (const auto& [name, value] : json_->items()) names.push_back(name);
  return names;
}

GltfValue GltfValue::operator[](std::size_t i) const {
  return {&(*json_)[i], path_ + "[" + to_string(i) + "]", errors_};
}

std::size_t GltfValue::size() const {
  if (!json_) return 0;
  if (json_->is_array()) return json_->size();
  fail("an array");
  return 0;
}

std::uint64_t GltfValue::integer(Range range, std::optional<std::uint64_t> absent) const {
  if (!json_ && absent) return *absent;
  if (json_ && json_->is_number_unsigned()) {
    const auto value = json_->get<std::uint64_t>();
    if (range.min <= value && value <= range.max) return value;
  }
  fail("an integer from " + to_string(range.min) + " to " + to_string(range.max));
  return range.min;
}

bool GltfValue::boolean(bool absent) const {
  if (!json_) return absent;
  if (json_->is_boolean()) return json_->get<bool>();
  fail("true or false");
  return absent;
}

std::string GltfValue::text(const std::optional<std::string>& absent) const {
  if (!json_ && absent) return *absent;
  if (json_ && json_->is_string()) return json_->get<std::string>();
  fail("a string");
  return "";
}

std::vector<double> GltfValue::numbers(std::size_t count,
                                       const std::vector<double>& absent) const {
  if (!json_) return absent;
  if (size() != count) {
    fail("an array of " + to_string(count) + " numbers");
    return absent;
  }
  std::vector<double> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const nlohmann::json& element = (*json_)[i];
    if (element.is_number()) values[i] = element.get<double>();
    if (!element.is_number() || !std::isfinite(values[i])) (*this)[i].fail("a number");
  }
  return values;
}

std::uint32_t GltfValue::index(std::size_t count, const char* of) const {
  if (json_ && json_->is_number_unsigned()) {
    const auto value = json_->get<std::uint64_t>();
    if (value < count) return static_cast<std::uint32_t>(value);
  }
  fail("an index of " + std::string(of) + ", of which there are " + to_string(count));
  return 0;
}

std::optional<std::uint32_t> GltfValue::index_if_any(std::size_t count, const char* of) const {
  if (!json_) return std::nullopt;
  return index(count, of);
}

void GltfValue::fail(const std::string& expected) const {
  errors_->expected(path_, found(), expected);
}

std::string GltfValue::found() const {
  if (!json_) return "nothing";
  if (json_->is_array()) return "an array of " + to_string(json_->size());
  if (json_->is_object()) return "an object";
  if (json_->is_string()) return gltf_quoted(json_->get<std::string>());
  return json_text(*json_);
}

const nlohmann::json& gltf_member(const nlohmann::json& value, const char* key) {
  static const nlohmann::json kNone;
  if (!value.is_object()) return kNone;
  const auto found = value.find(key);
  return found == value.end() ? kNone : *found;
}

std::string gltf_quoted(const std::string& text) {
  constexpr std::size_t kLongest = 60;
  const bool cut = text.size() > kLongest;
  const nlohmann::json shown = cut ? text.substr(0, kLongest) + "..." : text;
  return json_text(shown, -1, true);
}

}  // namespace rlpc
