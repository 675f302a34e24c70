#include "decoder/meshes/obj_materials.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "common/codec/mesh/indices.h"
#include "decoder/meshes/mesh_bytes.h"

namespace rlpc {
namespace {

constexpr const char* kMtlBegin = "# materials of rlpcdec\n";

// Returns a name as one word of a line.
std::string word_of(const std::string& name, const char* otherwise, std::uint32_t number) {
  if (name.empty()) return otherwise + std::to_string(number);
  std::string word = name;
  for (char& c : word) {
    const auto byte = static_cast<unsigned char>(c);
    constexpr unsigned char kDelete = 0x7F;
    if (byte <= ' ' || byte == kDelete) c = '_';
  }
  return word;
}

const GltfJson* member(const GltfJson* object, const char* key) {
  if (object == nullptr || !object->is_object() || !object->contains(key)) return nullptr;
  return &(*object)[key];
}

// Appends "Kd 0.8 0.8 0.8": the first three numbers of a list.
void append_colour(std::string& mtl, const char* key, const GltfJson* list) {
  if (list == nullptr || !list->is_array() || list->size() < 3) return;
  mtl += key;
  for (std::size_t c = 0; c < 3; ++c) {
    mtl += ' ';
    append_number(mtl, (*list)[c].is_number() ? (*list)[c].get<float>() : 0.0F);
  }
  mtl += '\n';
}

void append_factor(std::string& mtl, const char* key, const GltfJson* number) {
  if (number == nullptr || !number->is_number()) return;
  mtl += std::string(key) + " ";
  append_number(mtl, number->get<float>());
  mtl += '\n';
}

double number_of(const GltfJson* number, double otherwise) {
  return number != nullptr && number->is_number() ? number->get<double>() : otherwise;
}

std::array<double, 2> pair_of(const GltfJson* list, double otherwise) {
  if (list == nullptr || !list->is_array() || list->size() != 2) return {otherwise, otherwise};
  return {number_of(&(*list)[0], otherwise), number_of(&(*list)[1], otherwise)};
}

std::uint32_t set_of(const GltfJson* info, std::uint32_t otherwise) {
  const GltfJson* const set = member(info, "texCoord");
  constexpr std::uint64_t kMax = 0xFFFFFFFF;
  if (set == nullptr || !set->is_number_unsigned() || set->get<std::uint64_t>() > kMax) {
    return otherwise;
  }
  return set->get<std::uint32_t>();
}

ObjTexture texture_of(const GltfJson* info) {
  const GltfJson* const transform = member(member(info, "extensions"), "KHR_texture_transform");
  const std::array<double, 2> offset = pair_of(member(transform, "offset"), 0.0);
  const std::array<double, 2> scale = pair_of(member(transform, "scale"), 1.0);
  const double angle = number_of(member(transform, "rotation"), 0.0);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  ObjTexture texture;
  texture.set = set_of(transform, set_of(info, 0));
  texture.rows = {{{cosine * scale[0], sine * scale[1], offset[0]},
                   {-sine * scale[0], cosine * scale[1], offset[1]}}};
  return texture;
}

std::string extension_of(const std::string& bytes) {
  if (bytes.starts_with("\x89PNG")) return ".png";
  if (bytes.starts_with("\xFF\xD8\xFF")) return ".jpg";
  if (bytes.starts_with("\xABKTX 20")) return ".ktx2";
  return bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0 ? ".webp" : "";
}

}  // namespace

// Images that materials name, each once.
class ObjMaterials::Images {
 public:
  Images(const StreamAsset& asset, std::string stem) : asset_(asset), stem_(std::move(stem)) {}

  // Appends "map_Kd walk_0.png", if a texture has an image of a known type.
  void append_map(std::string& mtl, const char* key, const GltfJson* texture) {
    const GltfJson* const image = image_of(texture);
    const auto view = image == nullptr ? std::nullopt : asset_.view_of(*image);
    if (!view) return;
    const auto [place, is_new] = names_.try_emplace(*view, "");
    if (is_new) place->second = add(asset_.view_bytes(*view));
    if (!place->second.empty()) mtl += std::string(key) + " " + place->second + "\n";
  }
  std::vector<CompanionFile> take() { return std::move(files_); }

 private:
  const GltfJson* image_of(const GltfJson* texture) const {
    const GltfJson* const found = element("textures", member(texture, "index"));
    if (const GltfJson* const image = element("images", member(found, "source"))) return image;
    const GltfJson* const extensions = member(found, "extensions");
    for (const char* const extension : {"EXT_texture_webp", "KHR_texture_basisu"}) {
      const GltfJson* const source = member(member(extensions, extension), "source");
      if (const GltfJson* const image = element("images", source)) return image;
    }
    return nullptr;
  }
  const GltfJson* element(const char* list, const GltfJson* number) const {
    const GltfJson* const all = member(&asset_.root(), list);
    if (all == nullptr || number == nullptr || !number->is_number_unsigned()) return nullptr;
    const auto i = number->get<std::uint64_t>();
    return i < all->size() ? &(*all)[i] : nullptr;
  }
  std::string add(std::string bytes) {
    const std::string extension = extension_of(bytes);
    if (extension.empty()) return "";
    std::string name = stem_ + "_" + std::to_string(files_.size()) + extension;
    std::string begin = bytes;
    files_.push_back({name, std::move(begin), std::move(bytes)});
    return name;
  }

  const StreamAsset& asset_;
  std::string stem_;
  std::map<std::uint64_t, std::string> names_;  // key: view
  std::vector<CompanionFile> files_;
};

ObjMaterials::ObjMaterials(const SinkOptions& options) : asset_(options.asset) {
  const MeshAttributes attributes(options);
  if (attributes.material == nullptr) {
    const GltfJson* const all = member(&asset_.root(), "materials");
    has_one_ = all != nullptr && !all->empty();
    if (has_one_) used_ = {0};
    return;
  }
  const auto& values = attributes.material->values;
  used_.assign(values.begin(), values.end());
  sort_without_repetitions(used_);
}

std::string ObjMaterials::material_name(std::uint32_t number) const {
  return word_of(asset_.name_of("materials", number), "material_", number);
}

std::string ObjMaterials::part_name(std::uint32_t number) const {
  return word_of(asset_.name_of("nodes", number), "part_", number);
}

ObjTexture ObjMaterials::texture(std::uint32_t number) const {
  const GltfJson* const all = member(&asset_.root(), "materials");
  const GltfJson* const material =
      all != nullptr && number < all->size() ? &(*all)[number] : nullptr;
  for (const GltfJson* const info :
       {member(member(material, "pbrMetallicRoughness"), "baseColorTexture"),
        member(material, "emissiveTexture"), member(material, "normalTexture")}) {
    if (info != nullptr) return texture_of(info);
  }
  return texture_of(nullptr);
}

// Describes the metallic-roughness model of glTF in statements that readers of OBJ support.
std::string ObjMaterials::mtl_of(std::uint32_t number, Images& images) const {
  std::string mtl = "newmtl " + material_name(number) + "\n";
  const GltfJson* const all = member(&asset_.root(), "materials");
  if (all == nullptr || number >= all->size()) return mtl + "Kd 0.8 0.8 0.8\n";
  const GltfJson* const material = &(*all)[number];
  const GltfJson* const pbr = member(material, "pbrMetallicRoughness");
  const GltfJson* const base = member(pbr, "baseColorFactor");
  const bool has_base = base != nullptr && base->is_array() && base->size() == 4;
  // Opaque materials ignore alpha.
  const GltfJson* const mode = member(material, "alphaMode");
  const bool has_alpha = mode != nullptr && (*mode == "BLEND" || *mode == "MASK");
  if (has_base) {
    append_colour(mtl, "Kd", base);
    if (has_alpha) append_factor(mtl, "d", &(*base)[3]);
  } else {
    mtl += "Kd 1 1 1\n";
  }
  append_colour(mtl, "Ke", member(material, "emissiveFactor"));
  append_factor(mtl, "Pr", member(pbr, "roughnessFactor"));
  append_factor(mtl, "Pm", member(pbr, "metallicFactor"));
  images.append_map(mtl, "map_Kd", member(pbr, "baseColorTexture"));
  if (has_alpha) images.append_map(mtl, "map_d", member(pbr, "baseColorTexture"));
  images.append_map(mtl, "map_Ke", member(material, "emissiveTexture"));
  images.append_map(mtl, "norm", member(material, "normalTexture"));
  return mtl;
}

std::vector<CompanionFile> ObjMaterials::files(const std::string& stem) const {
  if (used_.empty()) return {};
  Images images(asset_, stem);
  std::string mtl = kMtlBegin;
  for (const std::uint32_t number : used_) mtl += mtl_of(number, images);
  std::vector<CompanionFile> files = images.take();
  files.insert(files.begin(), {stem + ".mtl", kMtlBegin, std::move(mtl)});
  return files;
}

}  // namespace rlpc
