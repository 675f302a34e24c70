#include "decoder/meshes/gltf/gltf_look.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

#include "common/codec/attributes/attribute_names.h"

namespace rlpc {

GltfLook::GltfLook(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles,
                   std::uint32_t num_vertices, const std::string& asset)
    : asset_(asset) {
  Vector<const AttributeSet*> split;
  for (const AttributeSet& set : sets) {
    if (!is_drawable(set.header, triangles)) continue;
    const bool is_normal = is_normal_set(set.header) && !triangles.empty();
    const std::uint32_t width = number_components(set.header);
    const auto uv = width == 2 ? number_after(kUvPrefix, set.header.name) : std::nullopt;
    const auto colour =
        width >= 3 ? number_after(kColourPrefix, set.header.name) : std::nullopt;
    if (uv) uvs_[*uv].set = split.size();
    if (colour) colours_[*colour] = {split.size(), width, {}};
    if (is_normal || uv || colour) split.push_back(&set);
  }
  drawn_ = std::make_unique<DrawnMesh>(std::move(split), triangles, num_vertices);
  mesh_.vertex = drawn_->vertices().stream_vertex;
  for (auto* const list : {&uvs_, &colours_}) {
    for (auto& [number, values] : *list) values.numbers = drawn_->numbers(values.set);
  }
  make_parts(sets, drawn_->vertices().triangles);
}

// Makes a part of the mesh for each pair of a material and a part of the stream.
void GltfLook::make_parts(const std::vector<AttributeSet>& sets,
                          std::span<const Triangle> triangles) {
  const auto find_indices = [&](const char* name) {
    const AttributeSet* const set = find_set(sets, name);
    const bool fits = set != nullptr && set->header.domain == AttributeDomain::kTriangle &&
                      set->header.num_components == 1;
    return fits ? set : nullptr;
  };
  const AttributeSet* const material = find_indices(kMaterialName);
  const AttributeSet* const part = find_indices(kPartName);
  const std::size_t num_materials =
      asset_.root().contains("materials") ? asset_.root()["materials"].size() : 0;
  std::map<std::pair<std::uint32_t, std::optional<std::uint32_t>>, std::size_t> found;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const std::uint32_t p = part != nullptr ? part->values[t] : 0;
    const std::uint32_t m = material != nullptr ? material->values[t] : 0;
    const bool is_plain = asset_.root().is_null();
    const std::optional<std::uint32_t> number =
        m < num_materials || is_plain ? std::optional(is_plain ? 0 : m) : std::nullopt;
    const auto [place, is_new] = found.try_emplace({p, number}, mesh_.parts.size());
    if (is_new) mesh_.parts.push_back({{}, number});
    mesh_.parts[place->second].triangles.push_back(triangles[t]);
  }
  if (!mesh_.parts.empty()) return;
  const bool has_one = num_materials > 0 || asset_.root().is_null();
  mesh_.parts.push_back({{}, has_one ? std::optional<std::uint32_t>(0) : std::nullopt});
}

// Returns, by number, sets that were equal to others in the input
// (encoder/meshes/gltf/equal_uv.h).
std::map<std::uint32_t, std::uint32_t> GltfLook::equal_uvs() const {
  std::map<std::uint32_t, std::uint32_t> equal;
  constexpr std::size_t kMax = 256;
  const GltfJson& root = asset_.root();
  if (!root.is_object() || !root.contains("extras")) return equal;
  const GltfJson& extras = root["extras"];
  if (!extras.is_object() || !extras.contains("equal_uv")) return equal;
  const GltfJson& list = extras["equal_uv"];
  for (std::uint32_t n = 0; list.is_array() && n < std::min(list.size(), kMax); ++n) {
    if (!list[n].is_number_unsigned()) continue;
    const auto first = list[n].get<std::uint64_t>();
    if (first < n && !uvs_.contains(n) && uvs_.contains(static_cast<std::uint32_t>(first))) {
      equal[n] = static_cast<std::uint32_t>(first);
    }
  }
  return equal;
}

void GltfLook::add_values(GltfJson& attributes, GlbBuffers& buffers) const {
  const auto name_of = [](std::uint32_t n) { return "TEXCOORD_" + std::to_string(n); };
  std::map<std::uint32_t, std::uint32_t> accessors;
  for (const auto& [number, values] : uvs_) {
    accessors[number] = buffers.add_texture_coordinates(values.numbers);
  }
  for (const auto& [number, first] : equal_uvs()) accessors[number] = accessors[first];
  std::uint32_t next = 0;
  for (const auto& [number, accessor] : accessors) {
    // Copies fill gaps between the numbers, which glTF does not allow: materials refer to sets
    // by number.
    for (; next <= number; ++next) attributes[name_of(next)] = accessor;
  }
  next = 0;
  for (const auto& [number, values] : colours_) {
    if (number != next) break;  // a copy that fills a gap would tint the surface
    attributes["COLOR_" + std::to_string(next++)] =
        buffers.add_vertex_values(values.numbers, values.width);
  }
}

// Adds images; images of the same view share it in the file.
void GltfLook::add_images(GltfJson& images, GlbBuffers& buffers) const {
  std::map<std::uint64_t, std::uint32_t> added;
  for (GltfJson& image : images) {
    const auto view = asset_.view_of(image);
    if (!view) {
      if (image.is_object()) image.erase("bufferView");
      continue;
    }
    const auto [place, is_new] = added.try_emplace(*view, 0);
    if (is_new) place->second = buffers.add_image(asset_.view_bytes(*view));
    image["bufferView"] = place->second;
  }
}

std::vector<float> GltfLook::normals(std::span<const float> xyz) const {
  return normals(drawn_->normals(), xyz);
}

std::vector<float> GltfLook::normals(FrameNormals& normals_of_frames,
                                     std::span<const float> xyz) const {
  std::vector<float> all(3 * std::size_t{normals_of_frames.count()});
  normals_of_frames.compute(xyz, all);
  std::vector<float> normals;
  normals.reserve(3 * drawn_->normal_of_vertex().size());
  for (const std::uint32_t i : drawn_->normal_of_vertex()) {
    const auto vertex_normal = std::span(all).subspan(3 * std::size_t{i}, 3);
    normals.insert(normals.end(), vertex_normal.begin(), vertex_normal.end());
  }
  return normals;
}

void GltfLook::add_materials(GltfJson& root, GlbBuffers& buffers) const {
  const GltfJson& asset = asset_.root();
  if (asset.is_null()) {  // as from OBJ files; the default of glTF is metal and single-sided
    root["materials"] = GltfJson::array(
        {{{"doubleSided", true}, {"pbrMetallicRoughness", {{"metallicFactor", 0}}}}});
    return;
  }
  for (const char* const key : {"materials", "textures", "samplers", "images"}) {
    if (asset.contains(key)) root[key] = asset[key];
  }
  for (const char* const key : {"extensionsUsed", "extensionsRequired"}) {
    if (!asset.contains(key)) continue;
    for (const GltfJson& name : asset[key]) root[key].push_back(name);
  }
  if (root.contains("images")) add_images(root["images"], buffers);
}

}  // namespace rlpc
