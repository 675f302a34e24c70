#include "encoder/input/glb_asset.h"

#include <utility>

#include "common/io/binary_numbers.h"

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
  std::string text = root.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string binary = binary_;
  binary.resize((binary.size() + 3) / 4 * 4);
  const std::size_t size = 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
  std::string file = "glTF";
  append_u32(file, 2);
  append_u32(file, static_cast<std::uint32_t>(size));
  append_u32(file, static_cast<std::uint32_t>(text.size()));
  file += "JSON" + text;
  if (!binary.empty()) {
    append_u32(file, static_cast<std::uint32_t>(binary.size()));
    file += std::string("BIN\0", 4) + binary;
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
  if (bytes.starts_with("\x89PNG")) return "image/png";
  if (bytes.starts_with("\xFF\xD8\xFF")) return "image/jpeg";
  if (bytes.starts_with("\xABKTX 20")) return "image/ktx2";
  return bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0 ? "image/webp" : "";
}

}  // namespace rlpc
