#include "decoder/programs/stream_message.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <string_view>
#include <system_error>

#include "common/files/messages.h"
#include "decoder/describe_error.h"

namespace rlpc {
namespace {

struct Known {
  std::string_view beginning;
  const char* what;
};

// Files that are mistaken for streams.
constexpr std::array<Known, 14> kKnown{{{"glTF", "glTF"},
                                        {"{", "glTF or other JSON"},
                                        {"POINTCACHE2", "a PC2 point cache"},
                                        {"RLPD", "decoded positions (.rlpd)"},
                                        {"ply", "a PLY mesh"},
                                        {"OFF", "an OFF mesh"},
                                        {"v ", "an OBJ mesh"},
                                        {"# ", "an OBJ mesh or other text"},
                                        {"<", "an HTML page"},
                                        {"\x1F\x8B", "a gzip file"},
                                        {"PK\x03\x04", "a zip archive"},
                                        {"\x28\xB5\x2F\xFD", "a Zstandard file"},
                                        {"\xFD"
                                         "7zXZ",
                                         "an xz file"},
                                        {"RLPC", "a stream damaged by a transfer as text"}}};

// Returns the apparent type of the file; "" if it is unknown or cannot be read again.
std::string guess(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) return "";
  std::ifstream file(path, std::ios::binary);
  std::array<char, 64> bytes{};
  file.read(bytes.data(), bytes.size());
  std::string_view text(bytes.data(), static_cast<std::size_t>(file.gcount()));
  if (text.empty()) return "it is empty";
  if (text.substr(1).starts_with("RLPC")) text.remove_prefix(1);
  text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n"), text.size()));
  for (const Known& known : kKnown) {
    if (text.starts_with(known.beginning)) return std::string("it looks like ") + known.what;
  }
  return "";
}

std::string option_of(ExceededLimit limit, const DecodeLimits& limits) {
  switch (limit) {
    case ExceededLimit::kVertices:
      return "--max-vertices " + std::to_string(limits.max_vertices);
    case ExceededLimit::kTriangles:
      return std::to_string(limits.max_triangles);
    case ExceededLimit::kFrames:
      return "--max-frames " + std::to_string(limits.max_frames);
    case ExceededLimit::kMemory:
      break;
  }
  return "--max-memory, " + size_text(limits.max_memory_bytes);
}

}  // namespace

std::string stream_message(const std::string& path, const Error& error,
                           const DecodeLimits& limits) {
  std::string text = name_of_input(path) + ": " + describe_error(error);
  if (error.code == Errc::kLimitExceeded) {
    text += " (" + option_of(exceeded_limit(error), limits) + ")";
  } else if (std::string_view(error.rule) == "R-STR-01") {
    const std::string what = guess(path);
    if (!what.empty()) text += "; " + what;
  }
  return text;
}

}  // namespace rlpc
