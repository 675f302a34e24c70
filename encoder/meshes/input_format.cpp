#include "encoder/meshes/input_format.h"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <vector>

#include "encoder/meshes/input_file.h"

namespace rlpc {

const InputFormat* format_of_extension(const std::string& path) {
  const std::string extension = lower_extension(path);
  for (const InputFormat* const format : input_formats()) {
    const auto& known = format->extensions;
    if (std::find(known.begin(), known.end(), extension) != known.end()) return format;
  }
  return nullptr;
}

const InputFormat* format_of(const std::string& path) {
  if (const InputFormat* const format = format_of_extension(path)) return format;
  const std::string beginning = beginning_of(path);
  for (const InputFormat* const format : input_formats()) {
    if (format->begins != nullptr && format->begins(beginning)) return format;
  }
  return nullptr;
}

std::string extensions_text(std::initializer_list<InputFormat::Holds> holds) {
  std::vector<std::string_view> extensions;
  for (const InputFormat::Holds kind : holds) {
    const auto first = static_cast<std::ptrdiff_t>(extensions.size());
    for (const InputFormat* const format : input_formats()) {
      if (format->holds != kind) continue;
      extensions.insert(extensions.end(), format->extensions.begin(), format->extensions.end());
    }
    std::sort(extensions.begin() + first, extensions.end());
  }
  std::string text;
  for (std::size_t i = 0; i < extensions.size(); ++i) {
    if (i > 0) text += i + 1 < extensions.size() ? ", " : " or ";
    text += extensions[i];
  }
  return text;
}

std::string formats_text() {
  return "Meshes:        " + extensions_text({InputFormat::Holds::kMesh}) +
         "\nPoint caches:  " + extensions_text({InputFormat::Holds::kPoints}) +
         "\nAnimations:    " + extensions_text({InputFormat::Holds::kAnimation}) + "\n";
}

std::string sibling_of(const std::string& path, InputFormat::Holds holds) {
  for (const InputFormat* const format : input_formats()) {
    if (format->holds != holds) continue;
    for (const std::string_view extension : format->extensions) {
      std::string sibling = std::filesystem::path(path).replace_extension(extension).string();
      std::error_code ignored;
      if (sibling != path && std::filesystem::exists(sibling, ignored)) return sibling;
    }
  }
  return "";
}

}  // namespace rlpc
