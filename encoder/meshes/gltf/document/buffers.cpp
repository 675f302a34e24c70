#include "encoder/meshes/gltf/document/buffers.h"

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>

namespace rlpc {

namespace fs = std::filesystem;

namespace {

using std::to_string;

constexpr std::string_view kData = "data:";
constexpr std::string_view kBase64 = ";base64,";

std::string place_of(std::uint32_t buffer) { return "buffers[" + to_string(buffer) + "]"; }

int base64_value(char c) {
  if (c >= 'A' && c <= 'Z') return c - 'A';
  if (c >= 'a' && c <= 'z') return c - 'a' + 26;
  if (c >= '0' && c <= '9') return c - '0' + 52;
  if (c == '+' || c == '-') return 62;  // '-' and '_' are URL-safe base64: RFC 4648, 5
  return c == '/' || c == '_' ? 63 : -1;
}

std::optional<std::string> decode_base64(std::string_view text) {
  while (text.ends_with('=')) text.remove_suffix(1);
  std::string bytes;
  bytes.reserve(text.size() / 4 * 3 + 2);
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    const int value = base64_value(c);
    if (value < 0) return std::nullopt;
    bits = (bits << 6 | static_cast<std::uint32_t>(value)) & 0xFFFF;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes += static_cast<char>(bits >> count & 0xFF);
  }
  return bytes;
}

int hex_value(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

// Decodes percent-encoded characters: "%20" is a blank.
std::string percent_decoded(std::string_view uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? hex_value(uri[i + 1]) : -1;
    const int low = high >= 0 ? hex_value(uri[i + 2]) : -1;
    text += low >= 0 ? static_cast<char>(16 * high + low) : uri[i];
    if (low >= 0) i += 2;
  }
  return text;
}

// Whether a path stays in or below its folder, ignoring links.
bool stays_inside(const fs::path& path) {
  return path.is_relative() && std::find(path.begin(), path.end(), "..") == path.end();
}

// Whether a path stays in or below the folder after resolving links; true if it does not exist.
bool is_below(const fs::path& path, const fs::path& folder) {
  std::error_code missing;
  const fs::path real = fs::canonical(path, missing);
  if (missing) return true;
  const fs::path way = real.lexically_relative(fs::canonical(folder, missing));
  return !way.empty() && *way.begin() != "..";
}

}  // namespace

GltfBuffers::GltfBuffers(std::vector<GltfBuffer> buffers, GltfFile& file, GltfErrors& errors)
    : buffers_(std::move(buffers)),
      file_(file),
      errors_(errors),
      bytes_at_hand_(file.file.size()) {}

bool GltfBuffers::available(std::uint32_t buffer) {
  assert(buffer < buffers_.size());
  if (places_.contains(buffer)) return true;
  auto place = find(buffer);
  if (!place) return false;
  if (place->size < buffers_[buffer].size) {
    errors_.expected(place_of(buffer) + ".byteLength", to_string(buffers_[buffer].size),
                     "at most " + to_string(place->size) + ", the bytes that are there");
    return false;
  }
  places_.emplace(buffer, std::move(*place));
  return true;
}

void GltfBuffers::read(std::uint32_t buffer, std::uint64_t offset, std::span<char> bytes) {
  const Place& place = places_.at(buffer);
  assert(offset <= place.size && bytes.size() <= place.size - offset);
  if (place.file) {
    if (auto error = place.file->read(place.offset + offset, bytes)) errors_.add(*error);
  } else {
    std::copy_n(place.text.data() + offset, bytes.size(), bytes.data());
  }
}

std::vector<std::string> GltfBuffers::files() const {
  std::vector<std::string> paths{file_.file.path()};
  for (const auto& [path, file] : others_) paths.push_back(path);
  return paths;
}

std::optional<GltfBuffers::Place> GltfBuffers::find(std::uint32_t buffer) {
  const std::optional<std::string>& uri = buffers_[buffer].uri;
  if (!uri) return find_binary(buffer);
  const std::string place = place_of(buffer) + ".uri";
  if (!uri->starts_with(kData)) return find_file(place, *uri);
  const std::size_t comma = uri->find(kBase64);
  auto bytes = comma == uri->npos
                   ? std::nullopt
                   : decode_base64(std::string_view(*uri).substr(comma + kBase64.size()));
  if (!bytes) {
    errors_.expected(place, gltf_quoted(*uri), "data in base64, without other characters");
    return std::nullopt;
  }
  const std::uint64_t size = bytes->size();
  return Place{nullptr, 0, size, std::move(*bytes)};
}

std::optional<GltfBuffers::Place> GltfBuffers::find_binary(std::uint32_t buffer) {
  if (buffer == 0 && file_.binary) {
    return Place{&file_.file, file_.binary->offset, file_.binary->size, ""};
  }
  errors_.expected(place_of(buffer) + ".uri", "nothing",
                   buffer == 0 ? "a URI, or the binary chunk of a .glb file"
                               : "a URI; only the first buffer can be in the binary chunk");
  return std::nullopt;
}

std::optional<GltfBuffers::Place> GltfBuffers::find_file(const std::string& place,
                                                         const std::string& uri) {
  const fs::path relative(percent_decoded(uri));
  const std::size_t colon = uri.find(':');
  const fs::path document_folder = fs::path(file_.file.path()).parent_path();
  // Use the folder, so that the path is never "-", which is standard input.
  const fs::path folder = document_folder.empty() ? fs::path(".") : document_folder;
  if (!stays_inside(relative) || (colon != uri.npos && colon < uri.find('/')) ||
      !is_below(folder / relative, folder)) {
    errors_.expected(place, gltf_quoted(uri),
                     "a file in the folder of the document, or below it; put it there");
    return std::nullopt;
  }
  const std::string path = (folder / relative).string();
  auto known = others_.find(path);
  if (known == others_.end()) {
    auto file = InputFile::open(path);
    if (!file) {
      errors_.add(place, file.error().message);
      return std::nullopt;
    }
    bytes_at_hand_ += file->size();
    known = others_.emplace(path, std::move(*file)).first;
  }
  return Place{&known->second, 0, known->second.size(), ""};
}

}  // namespace rlpc
