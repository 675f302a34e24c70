#include "encoder/meshes/gltf/attributes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "common/codec/attributes/attribute_names.h"

namespace rlpc {
namespace {

using Attribute = GltfGeometry::Attribute;

// Returns the name of a set in Table F-1.
std::string set_name(const std::string& semantic) {
  if (semantic == "NORMAL") return kNormalName;
  const std::string number = semantic.substr(semantic.rfind('_') + 1);
  return (semantic.starts_with("TEXCOORD_") ? kUvPrefix : kColourPrefix) + number;
}

const Attribute* find(const GltfGeometry& geometry, const std::string& semantic) {
  for (const Attribute& attribute : geometry.attributes) {
    if (attribute.semantic == semantic) return &attribute;
  }
  return nullptr;
}

// Returns the normal of a face, of length 1, or zero.
GltfVec3 face_normal(const std::array<GltfVec3, 3>& corner) {
  GltfVec3 a{};
  GltfVec3 b{};
  for (std::size_t c = 0; c < 3; ++c) {
    a[c] = corner[1][c] - corner[0][c];
    b[c] = corner[2][c] - corner[0][c];
  }
  GltfVec3 n{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  const double length = std::sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
  for (double& x : n) x = length > 0.0 ? x / length : 0.0;
  return n;
}

class AttributeCollector {
 public:
  AttributeCollector(const GltfModel& model, std::span<const Triangle> triangles,
                     const GltfPose& first, const SampledPoses& sampled)
      : model_(model),
        triangles_(triangles),
        is_mirrored_(sampled.is_mirrored),
        first_(first),
        sampled_(sampled) {}

  SourceAttributes collect() {
    SourceAttributes all;
    std::set<std::string> semantics;
    for (const GltfModel::Instance& instance : model_.instances) {
      for (const Attribute& a : geometry_of(instance).attributes) semantics.insert(a.semantic);
    }
    for (const std::string& semantic : semantics) {
      all.sets.push_back(corners(semantic));
    }
    add_triangle_sets(all);
    if (semantics.contains("NORMAL")) add_rest_shape(all);
    return all;
  }

 private:
  const GltfGeometry& geometry_of(const GltfModel::Instance& instance) const {
    return model_.geometries[instance.geometry];
  }

  SourceAttribute corners(const std::string& semantic) {
    const bool is_normal = semantic == "NORMAL";
    SourceAttribute set;
    set.name = set_name(semantic);
    if (is_normal) set.kind = SourceAttribute::Kind::kNormals;
    set.max_value = 0xFFFFFFFF;
    for (const GltfModel::Instance& instance : model_.instances) {
      const Attribute* const a = find(geometry_of(instance), semantic);
      if (a == nullptr) continue;
      set.num_components = std::max(set.num_components, a->width);
      set.max_value =
          set.max_value == 0xFFFFFFFF || set.max_value == a->max_value ? a->max_value : 0;
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
    if (is_normal) add_flat_normals(set);
    return set;
  }

  // Calls a function with the index of each instance without normals, and that of its first
  // triangle.
  template <class Function>
  void for_flat_instances(Function&& function) const {
    std::size_t first = 0;
    for (std::size_t i = 0; i < model_.instances.size(); ++i) {
      const GltfGeometry& geometry = geometry_of(model_.instances[i]);
      if (find(geometry, "NORMAL") == nullptr) function(i, first);
      first += geometry.triangles.size();
    }
  }

  // xyz: positions of the vertices of an instance.
  void append_face_normals(std::size_t instance, std::size_t first_triangle,
                           std::span<const float> xyz, std::vector<float>& normals) const {
    const GltfModel::Instance& placed = model_.instances[instance];
    for (std::size_t t = 0; t < geometry_of(placed).triangles.size(); ++t) {
      std::array<GltfVec3, 3> corner{};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t v = triangles_[first_triangle + t][k] - placed.first_vertex;
        for (std::size_t c = 0; c < 3; ++c) corner[k][c] = xyz[3 * v + c];
      }
      const GltfVec3 n = face_normal(corner);
      for (const double x : n) normals.push_back(static_cast<float>(x));
    }
  }

  // Adds a value for each face of primitives without normals, which are flat (glTF 2.0,
  // 3.7.2.1).
  void add_flat_normals(SourceAttribute& set) const {
    for_flat_instances([&](std::size_t i, std::size_t first) {
      const GltfGeometry& geometry = geometry_of(model_.instances[i]);
      const auto value = static_cast<std::uint32_t>(set.num_values());
      append_face_normals(i, first, geometry.base, set.values);
      for (std::size_t c = 0; c < 3 * geometry.triangles.size(); ++c) {
        set.value_of_corner[3 * first + c] = value + static_cast<std::uint32_t>(c / 3);
      }
    });
  }

  // Adds values; instances without any get white, or the origin of textures.
  void add_values(const GltfModel::Instance& instance, const Attribute* attribute, float sign,
                  SourceAttribute& set) const {
    const bool is_colour = set.name.starts_with(kColourPrefix);
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
    SourceAttribute material{.name = kMaterialName};
    SourceAttribute part{.name = kPartName};
    for (SourceAttribute* const set : {&material, &part}) {
      set->domain = AttributeDomain::kTriangle;
      set->kind = SourceAttribute::Kind::kIntegers;
    }
    constexpr std::size_t kMax = 65535;
    std::map<std::uint32_t, std::size_t> numbers;  // [node]
    for (const GltfModel::Instance& instance : model_.instances) {
      const std::size_t number =
          numbers.try_emplace(instance.node, numbers.size()).first->second;
      const std::size_t m = instance.material.value_or(model_.num_materials);
      const std::size_t count = geometry_of(instance).triangles.size();
      material.values.insert(material.values.end(), count,
                             static_cast<float>(std::min(m, kMax)));
      part.values.insert(part.values.end(), count, static_cast<float>(std::min(number, kMax)));
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

  // Adds the rest shape: normals belong to meshes before nodes and joints move them.
  void add_rest_shape(SourceAttributes& all) const {
    for (const GltfModel::Instance& instance : model_.instances) {
      const std::vector<float>& base = geometry_of(instance).base;
      all.rest_xyz.insert(all.rest_xyz.end(), base.begin(), base.end());
    }
    for (const Triangle& t : triangles_) {
      all.rest_of_corner.insert(all.rest_of_corner.end(), t.begin(), t.end());
    }
    all.first_normals = all_normals(first_);
    for (const SampledPoses::Later& later : sampled_.later) {
      all.later_normals.push_back({later.frame, all_normals(later.pose)});
    }
  }

  // Returns normals of vertices, then of the triangles of flat instances.
  std::vector<float> all_normals(const GltfPose& pose) const {
    std::vector<float> normals = posed_normals(model_, pose);
    PosedModel posed(model_, pose);
    for_flat_instances([&](std::size_t i, std::size_t first) {
      std::vector<float> xyz(geometry_of(model_.instances[i]).base.size());
      posed.positions(model_.instances[i], xyz);
      append_face_normals(i, first, xyz, normals);
    });
    return normals;
  }

  const GltfModel& model_;
  std::span<const Triangle> triangles_;
  const std::vector<bool>& is_mirrored_;
  const GltfPose& first_;
  const SampledPoses& sampled_;
};

}  // namespace

SourceAttributes gltf_attributes(const GltfModel& model, std::span<const Triangle> triangles,
                                 const GltfPose& first, const SampledPoses& sampled) {
  return AttributeCollector(model, triangles, first, sampled).collect();
}

}  // namespace rlpc
