#include "encoder/input/gltf/attributes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>

namespace rlpc {
namespace {

using Attribute = GltfGeometry::Attribute;

// Table F-1.
std::string set_name(const std::string& semantic) {
  if (semantic == "NORMAL") return "normal";
  const std::string number = semantic.substr(semantic.rfind('_') + 1);
  return (semantic.starts_with("TEXCOORD_") ? "uv" : "colour") + number;
}

const Attribute* find(const GltfGeometry& geometry, const std::string& semantic) {
  for (const Attribute& attribute : geometry.attributes) {
    if (attribute.semantic == semantic) return &attribute;
  }
  return nullptr;
}

class AttributeCollector {
 public:
  AttributeCollector(const GltfModel& model, std::span<const Triangle> triangles,
                     const std::vector<bool>& is_mirrored, const GltfPose& first,
                     std::vector<std::string>& notes)
      : model_(model),
        triangles_(triangles),
        is_mirrored_(is_mirrored),
        first_(first),
        notes_(notes) {}

  SourceAttributes collect() {
    SourceAttributes all;
    std::set<std::string> semantics;
    for (const GltfModel::Instance& instance : model_.instances) {
      for (const Attribute& a : geometry_of(instance).attributes) semantics.insert(a.semantic);
    }
    for (const std::string& semantic : semantics) {
      if (auto set = corners(semantic)) all.sets.push_back(std::move(*set));
    }
    add_triangle_sets(all);
    if (semantics.contains("NORMAL")) add_rest_shape(all);
    return all;
  }

 private:
  const GltfGeometry& geometry_of(const GltfModel::Instance& instance) const {
    return model_.geometries[instance.geometry];
  }

  std::optional<SourceAttribute> corners(const std::string& semantic) {
    const bool is_normal = semantic == "NORMAL";
    SourceAttribute set;
    set.name = set_name(semantic);
    if (is_normal) set.kind = SourceAttribute::Kind::kNormals;
    bool is_everywhere = true;
    set.max_value = 0xFFFFFFFF;
    for (const GltfModel::Instance& instance : model_.instances) {
      const Attribute* const a = find(geometry_of(instance), semantic);
      is_everywhere = is_everywhere && a != nullptr;
      if (a == nullptr) continue;
      set.num_components = std::max(set.num_components, a->width);
      set.max_value =
          set.max_value == 0xFFFFFFFF || set.max_value == a->max_value ? a->max_value : 0;
    }
    if (!is_everywhere && is_normal) {
      notes_.emplace_back(
          "dropped all normals, as some primitives have none: every face is flat");
      return std::nullopt;
    }
    if (set.max_value != 0) set.kind = SourceAttribute::Kind::kIntegers;
    for (std::size_t i = 0; i < model_.instances.size(); ++i) {
      add_values(model_.instances[i], find(geometry_of(model_.instances[i]), semantic),
                 semantic == "NORMAL" && is_mirrored_[i] ? -1.0F : 1.0F, set);
    }
    set.value_of_corner.reserve(3 * triangles_.size());
    for (const Triangle& t : triangles_) {
      set.value_of_corner.insert(set.value_of_corner.end(), t.begin(), t.end());
    }
    return set;
  }

  // Where there are none: white, or the origin of textures.
  void add_values(const GltfModel::Instance& instance, const Attribute* attribute, float sign,
                  SourceAttribute& set) const {
    const bool is_colour = set.name.starts_with("colour");
    const float one = set.max_value == 0 ? 1.0F : static_cast<float>(set.max_value);
    // Normalised integers of several widths become numbers.
    const float scale = attribute != nullptr && set.max_value == 0 && attribute->max_value != 0
                            ? 1.0F / static_cast<float>(attribute->max_value)
                            : 1.0F;
    for (std::size_t v = 0; v < geometry_of(instance).num_vertices(); ++v) {
      for (std::uint32_t c = 0; c < set.num_components; ++c) {
        const bool is_there = attribute != nullptr && c < attribute->width;
        const float value =
            is_there ? sign * scale * attribute->values[v * attribute->width + c] : 0.0F;
        set.values.push_back(is_there ? value : is_colour ? one : 0.0F);
      }
    }
  }

  void add_triangle_sets(SourceAttributes& all) const {
    if (triangles_.empty()) return;
    SourceAttribute material{.name = "material"};
    SourceAttribute part{.name = "part"};
    for (SourceAttribute* const set : {&material, &part}) {
      set->domain = AttributeDomain::kTriangle;
      set->kind = SourceAttribute::Kind::kIntegers;
    }
    constexpr std::size_t kMost = 65535;
    std::vector<std::uint32_t> nodes;
    for (const GltfModel::Instance& instance : model_.instances) {
      if (std::find(nodes.begin(), nodes.end(), instance.node) == nodes.end()) {
        nodes.push_back(instance.node);
      }
      const auto number = std::find(nodes.begin(), nodes.end(), instance.node) - nodes.begin();
      const std::size_t m = instance.material.value_or(model_.num_materials);
      const std::size_t count = geometry_of(instance).triangles.size();
      material.values.insert(material.values.end(), count,
                             static_cast<float>(std::min(m, kMost)));
      part.values.insert(
          part.values.end(), count,
          static_cast<float>(std::min<std::size_t>(static_cast<std::size_t>(number), kMost)));
    }
    const auto is_constant = [](const SourceAttribute& set) {
      return std::all_of(set.values.begin(), set.values.end(),
                         [&](float x) { return x == set.values[0]; });
    };
    if (!is_constant(material) || material.values[0] != 0.0F) {
      if (model_.num_materials > 0) all.sets.push_back(std::move(material));
    }
    if (!is_constant(part)) all.sets.push_back(std::move(part));
  }

  // Normals belong to meshes before nodes and joints move them.
  void add_rest_shape(SourceAttributes& all) const {
    for (const GltfModel::Instance& instance : model_.instances) {
      const std::vector<float>& base = geometry_of(instance).base;
      all.rest_xyz.insert(all.rest_xyz.end(), base.begin(), base.end());
    }
    for (const Triangle& t : triangles_) {
      all.rest_of_corner.insert(all.rest_of_corner.end(), t.begin(), t.end());
    }
    all.first_normals = posed_normals(model_, first_);
  }

  const GltfModel& model_;
  std::span<const Triangle> triangles_;
  const std::vector<bool>& is_mirrored_;
  const GltfPose& first_;
  std::vector<std::string>& notes_;
};

}  // namespace

SourceAttributes gltf_attributes(const GltfModel& model, std::span<const Triangle> triangles,
                                 const std::vector<bool>& is_mirrored, const GltfPose& first,
                                 std::vector<std::string>& notes) {
  return AttributeCollector(model, triangles, is_mirrored, first, notes).collect();
}

}  // namespace rlpc
