#include "encoder/meshes/glb_asset.h"

#include <utility>

#include "common/files/glb.h"
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
  binary_.resize((binary_.size() + 3) / 4 * 4);
  return glb_head(json_text(root), binary_.size()) + binary_;
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
