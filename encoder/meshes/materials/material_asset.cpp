#include "encoder/meshes/materials/material_asset.h"

#include <algorithm>
#include <filesystem>
#include <map>
#include <system_error>
#include <utility>

#include "common/files/messages.h"
#include "encoder/meshes/glb_asset.h"
#include "encoder/meshes/input_file.h"
#include "encoder/meshes/materials/material_files.h"
#include "encoder/meshes/materials/mtl_map.h"
#include "encoder/meshes/materials/mtl_reader.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;
class AssetMaker {
 public:
  AssetMaker(const std::string& folder, Images images, std::uint64_t max_bytes)
      : folder_(folder), images_(images), max_bytes_(max_bytes) {}

  MaterialAsset make(const SourceMaterials& materials) {
    MtlFile file = read_mtl(materials);
    const auto& described = file.materials;
    const bool describes = std::any_of(
        materials.names.begin(), materials.names.end(),
        [&](const std::string& name) { return described.find(name) != described.end(); });
    if (!file.dropped.empty()) made_.notes.push_back(std::move(file.dropped));
    // A single name distinguishes nothing.
    if (!describes && materials.names.size() < 2 && materials.part_names.size() < 2) {
      return std::move(made_);
    }
    for (const std::string& name : materials.names) {
      const auto found = described.find(name);
      Json material = json_of(found == described.end() ? Mtl() : found->second);
      material["name"] = name;
      asset_.root["materials"].push_back(std::move(material));
    }
    for (const std::string& name : materials.part_names) {
      asset_.root["nodes"].push_back({{"name", name}});
    }
    if (!asset_.root.empty()) made_.glb = asset_.glb({{"version", "2.0"}});
    return std::move(made_);
  }

 private:
  // Returns a material. OBJ has no culling, and metalness only as an extension.
  Json json_of(const Mtl& mtl) {
    Json pbr = {{"metallicFactor", mtl.metalness.value_or(0.0)}};
    if (mtl.roughness) pbr["roughnessFactor"] = *mtl.roughness;
    Json material = {{"doubleSided", true}};
    if (const Json image = texture(mtl.base_image); !image.is_null()) {
      pbr["baseColorTexture"] = image;
    }
    // Kd with a texture is seldom meant as a factor.
    const MtlColour white{1.0, 1.0, 1.0};
    const MtlColour base = pbr.contains("baseColorTexture") ? white : mtl.base.value_or(white);
    const double opacity = mtl.opacity.value_or(1.0);
    if (base != white || opacity < 1.0) {
      pbr["baseColorFactor"] = {base[0], base[1], base[2], opacity};
    }
    // glTF has no other alpha than that of the base colour.
    const bool uses_alpha =
        pbr.contains("baseColorTexture") && mtl.alpha_image.name == mtl.base_image.name;
    if (opacity < 1.0 || uses_alpha) material["alphaMode"] = "BLEND";
    const Json glow = texture(mtl.emission_image);
    if (!glow.is_null()) material["emissiveTexture"] = glow;
    const MtlColour black{};
    const MtlColour emission = mtl.emission.value_or(glow.is_null() ? black : white);
    if (emission != black) material["emissiveFactor"] = emission;
    if (const Json image = texture(mtl.normal_image); !image.is_null()) {
      material["normalTexture"] = image;
    }
    material["pbrMetallicRoughness"] = std::move(pbr);
    return material;
  }

  // Returns the texture of a map; null: no such image.
  Json texture(const MtlMap& map) {
    if (map.name.empty() || images_ == Images::kNone) return nullptr;
    const auto [place, is_new] = textures_of_names_.try_emplace(map.name, nullptr);
    if (is_new) place->second = add_texture(map.name);
    Json info = place->second;
    if (info.is_null() || (map.scale == MtlMap().scale && map.offset == MtlMap().offset)) {
      return info;
    }
    constexpr const char* kTransform = "KHR_texture_transform";
    // In glTF, v points down.
    info["extensions"][kTransform] = {
        {"scale", map.scale}, {"offset", {map.offset[0], 1.0 - map.scale[1] - map.offset[1]}}};
    asset_.root["extensionsUsed"] = {kTransform};
    return info;
  }

  Json add_texture(const std::string& name) {
    const auto leave_out = [&](const std::string& why) {
      made_.notes.push_back("texture " + rlpc::quoted(name) + " is not carried: " + why);
      return Json();
    };
    // Separators as Windows writes them.
    std::string file = name;
    std::replace(file.begin(), file.end(), '\\', '/');
    if (!stays_below(folder_, file)) return leave_out("it is not in the folder of the mesh");
    const std::string path = (std::filesystem::path(folder_) / file).string();
    std::error_code unknown;
    if (const auto size = std::filesystem::file_size(path, unknown);
        !unknown && size > max_bytes_) {
      return leave_out(path + ": " + std::to_string(size) +
                       " bytes, too many for 'max_memory_bytes'");
    }
    auto bytes = read_whole_file(path, max_bytes_);
    if (!bytes) return leave_out(bytes.error().message);
    const std::string type = type_of_image(*bytes);
    if (type != "image/png" && type != "image/jpeg") {
      return leave_out("it is neither PNG nor JPEG");
    }
    max_bytes_ -= bytes->size();
    if (images_ == Images::kSmaller) *bytes = smaller_png(std::move(*bytes));
    made_.files.push_back(path);
    asset_.root["images"].push_back(
        {{"bufferView", asset_.add_view(*bytes)}, {"mimeType", type}});
    asset_.root["textures"].push_back({{"source", asset_.root["images"].size() - 1}});
    return {{"index", asset_.root["textures"].size() - 1}};
  }

  std::string folder_;
  Images images_;
  std::uint64_t max_bytes_;
  GlbAsset asset_;
  MaterialAsset made_;
  std::map<std::string, Json, std::less<>> textures_of_names_;
};

}  // namespace

std::uint64_t material_asset_bytes(const SourceMaterials& materials) {
  // Bytes of texts and tree of a material with all members, and of the name of a part.
  constexpr std::uint64_t kMaterialBytes = 8192;
  constexpr std::uint64_t kNameBytes = 1024;
  constexpr std::uint64_t kByteCost = 8;
  const bool is_described = !materials.mtl.empty();
  std::uint64_t bytes = 0;
  for (const std::string& name : materials.names) {
    bytes += (is_described ? kMaterialBytes : kNameBytes) + kByteCost * name.size();
  }
  for (const std::string& name : materials.part_names)
    bytes += kNameBytes + kByteCost * name.size();
  return bytes;
}

MaterialAsset make_material_asset(const SourceMaterials& materials, const std::string& folder,
                                  Images images, std::uint64_t max_bytes) {
  return AssetMaker(folder, images, max_bytes).make(materials);
}

}  // namespace rlpc
