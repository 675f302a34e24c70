#include "decoder/output/gltf/gltf_look.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>

namespace rlpc {
namespace {

// Of a set that vertices have; empty: none.
std::string semantic_of(const AttributeHeader& header) {
  const std::string& name = header.name;
  const auto number_after = [&](const char* word) -> std::optional<std::string> {
    const std::string prefix = word;
    if (!name.starts_with(prefix) || name.size() == prefix.size()) return std::nullopt;
    const std::string digits = name.substr(prefix.size());
    const bool is_number =
        std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    return is_number ? std::optional(digits) : std::nullopt;
  };
  if (const auto n = number_after("uv"); n && header.num_components == 2) {
    return "TEXCOORD_" + *n;
  }
  if (const auto n = number_after("colour"); n && header.num_components >= 3) {
    return "COLOR_" + *n;
  }
  return "";
}

}  // namespace

GltfLook::GltfLook(const std::vector<AttributeSet>& sets, std::span<const Triangle> triangles,
                   std::uint32_t num_vertices, const std::string& asset)
    : asset_(asset) {
  Vector<const AttributeSet*> split;
  std::vector<std::string> semantics;
  for (const AttributeSet& set : sets) {
    if (!is_drawable(set.header, triangles)) continue;
    const bool is_normal = is_normal_set(set.header) && !triangles.empty();
    const std::string semantic = is_normal ? "NORMAL" : semantic_of(set.header);
    if (semantic.empty()) continue;
    split.push_back(&set);
    semantics.push_back(semantic);
  }
  drawn_ = std::make_unique<DrawnMesh>(std::move(split), triangles, num_vertices);
  mesh_.vertex = drawn_->vertices().stream_vertex;
  for (std::size_t s = 0; s < semantics.size(); ++s) {
    if (semantics[s] == "NORMAL") continue;
    const std::uint32_t width = number_components(drawn_->sets()[s]->header);
    values_.push_back({semantics[s], width, drawn_->numbers(s)});
  }
  make_parts(sets, drawn_->vertices().triangles);
}

// A part of the mesh for each pair of a material and a part of the stream.
void GltfLook::make_parts(const std::vector<AttributeSet>& sets,
                          std::span<const Triangle> triangles) {
  const auto of_triangles = [&](const char* name) {
    const AttributeSet* const set = find_set(sets, name);
    const bool fits = set != nullptr && set->header.domain == AttributeDomain::kTriangle &&
                      set->header.num_components == 1;
    return fits ? set : nullptr;
  };
  const AttributeSet* const material = of_triangles("material");
  const AttributeSet* const part = of_triangles("part");
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

void GltfLook::add_values(GltfJson& attributes, GlbBuffers& buffers) const {
  for (const Values& values : values_) {
    attributes[values.semantic] = values.semantic.starts_with("TEXCOORD")
                                      ? buffers.add_texture_coordinates(values.numbers)
                                      : buffers.add_vertex_values(values.numbers, values.width);
  }
}

// Images of the same view share it here, too.
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
  std::vector<float> all(3 * std::size_t{drawn_->normals().count()});
  drawn_->normals().compute(xyz, all);
  std::vector<float> normals;
  normals.reserve(3 * drawn_->normal_of_vertex().size());
  for (const std::uint32_t i : drawn_->normal_of_vertex()) {
    const auto of_vertex = std::span(all).subspan(3 * std::size_t{i}, 3);
    normals.insert(normals.end(), of_vertex.begin(), of_vertex.end());
  }
  return normals;
}

void GltfLook::add_materials(GltfJson& root, GlbBuffers& buffers) const {
  const GltfJson& asset = asset_.root();
  if (asset.is_null()) {  // of OBJ files, say: glTF's own default is metal, seen from the front
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
