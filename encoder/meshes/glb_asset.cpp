#include "encoder/meshes/glb_asset.h"

#include <utility>

#include "common/files/binary_numbers.h"
#include "common/json/json.h"

namespace rlpc {

using Json = nlohmann::json;

std::size_t GlbAsset::add_view(const std::string& bytes) {
  binary_.resize((binary_.size() + 3) / 4 * 4);
  views_.push_back(
      {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes.size()}});
  binary_ += bytes;
  return views_.size() - 1;
}

std::string GlbAsset::glb(Json asset) {
  if (!binary_.empty()) {
    root["bufferViews"] = views_;
    root["buffers"] = {{{"byteLength", binary_.size()}}};
  }
  root["asset"] = std::move(asset);
  std::string text = json_text(root);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  binary_.resize((binary_.size() + 3) / 4 * 4);
  const std::size_t size = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
  std::string file;
  file.reserve(size);
  file += "glTF";
  append_u32(file, 2);
  append_u32(file, static_cast<std::uint32_t>(size));
  append_u32(file, static_cast<std::uint32_t>(text.size()));
  file += "JSON";
  file += text;
  if (!binary_.empty()) {
    append_u32(file, static_cast<std::uint32_t>(binary_.size()));
    file.append("BIN\0", 4);
    file += binary_;
  }
  return file;
}

std::optional<std::size_t> index_of(const Json& object, const char* name, std::size_t limit) {
  if (!object.is_object() || !object.contains(name)) return std::nullopt;
  const Json& index = object[name];
  if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= limit) return std::nullopt;
  return index.get<std::size_t>();
}

std::string type_of_image(std::string_view bytes) {
  const auto has = [&](std::size_t at, std::string_view word) {
    return bytes.size() > at && bytes.substr(at).starts_with(word);
  };
  if (has(0, "\x89PNG")) return "image/png";
  if (has(0, "\xFF\xD8\xFF")) return "image/jpeg";
  if (has(0, "\xABKTX 20")) return "image/ktx2";
  if (has(0, "RIFF") && has(8, "WEBP")) return "image/webp";
  if (has(4, "ftypavif") || has(4, "ftypavis")) return "image/avif";
  return has(0, "DDS ") ? "image/vnd-ms.dds" : "";
}

}  // namespace rlpc
