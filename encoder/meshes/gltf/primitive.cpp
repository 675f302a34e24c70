#include "encoder/meshes/gltf/primitive.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace rlpc {

namespace {

using std::to_string;

class GeometryReader {
 public:
  GeometryReader(const GltfPrimitive& primitive, GltfValues& values, GltfErrors& errors)
      : primitive_(primitive), values_(values), errors_(errors) {}

  GltfGeometry read(std::size_t num_joints, std::optional<std::size_t> relief_uv) {
    GltfGeometry geometry;
    geometry.base = values_.floats(primitive_.positions, "VEC3", GltfValues::Integers::kToo);
    geometry.targets = targets(primitive_.targets);
    if (num_joints > 0 && !errors_) read_influences(num_joints, geometry);
    if (!errors_) geometry.triangles = triangles(corners(geometry.num_vertices()));
    for (const GltfAttribute& attribute : primitive_.attributes) {
      if (!errors_ && has_count(attribute.accessor)) read_attribute(attribute, geometry);
      if (attribute.semantic == "NORMAL")
        geometry.normal_targets = targets(primitive_.normal_targets);
    }
    if (relief_uv && primitive_.tangents && !errors_) compare(*relief_uv, geometry);
    return geometry;
  }

 private:
  // Checks that there is one element per vertex.
  bool has_count(std::uint32_t accessor) {
    const std::uint64_t count = values_.accessor(primitive_.positions).count;
    if (values_.accessor(accessor).count == count) return true;
    errors_.expected(gltf_accessor_path(accessor) + ".count",
                     to_string(values_.accessor(accessor).count),
                     to_string(count) + ", one for each vertex of " + primitive_.path);
    return false;
  }

  // Counts deltas: a growing vector takes three times its memory, here and below.
  bool takes_deltas(std::uint32_t accessor) {
    const GltfAccessor& a = values_.accessor(accessor);
    const std::uint64_t count = a.base ? a.count : a.sparse ? a.sparse->count : 0;
    return values_.memory().take(primitive_.path, 3 * sizeof(GltfDelta) * count);
  }

  std::vector<GltfGeometry::Target> targets(
      const std::vector<std::optional<std::uint32_t>>& accessors) {
    std::vector<GltfGeometry::Target> read;
    for (std::size_t t = 0; t < accessors.size() && !errors_; ++t) {
      const std::optional<std::uint32_t> target = accessors[t];
      if (!target || !has_count(*target) || !takes_deltas(*target)) continue;
      std::vector<GltfDelta> deltas = values_.deltas(*target);
      if (!deltas.empty()) read.push_back({t, std::move(deltas)});
    }
    return read;
  }

  void read_attribute(const GltfAttribute& attribute, GltfGeometry& geometry) {
    const GltfAccessor& accessor = values_.accessor(attribute.accessor);
    if (!values_.memory().take(primitive_.path,
                               3 * sizeof(float) * accessor.width * accessor.count)) {
      return;
    }
    const bool is_colour = attribute.semantic.starts_with("COLOR_");
    const bool has_three =
        attribute.semantic == "NORMAL" || (is_colour && accessor.type == "VEC3");
    const char* const type = has_three ? "VEC3" : is_colour ? "VEC4" : "VEC2";
    GltfGeometry::Attribute read;
    read.semantic = attribute.semantic;
    read.width = accessor.width;
    read.values = values_.floats(attribute.accessor, type, GltfValues::Integers::kToo);
    if (is_colour && accessor.normalized) {
      read.max_value = accessor.component == GltfComponent::kU8 ? 255 : 65535;
      for (float& x : read.values) x = std::round(x * static_cast<float>(read.max_value));
    } else if (is_colour) {
      // Clamp colours (glTF 2.0, 3.7.2.1): others would make the steps of all colours larger.
      for (float& x : read.values) {
        const float clamped = std::clamp(x, 0.0F, 1.0F);
        if (clamped != x) ++geometry.num_clamped;
        x = clamped;
      }
    }
    geometry.attributes.push_back(std::move(read));
  }

  // Compares the tangents, which are left out, with those that viewers compute instead.
  void compare(std::size_t relief_uv, GltfGeometry& geometry) {
    const auto values_of = [&](const std::string& semantic) {
      const auto found = std::find_if(geometry.attributes.begin(), geometry.attributes.end(),
                                      [&](const auto& a) { return a.semantic == semantic; });
      return found == geometry.attributes.end() ? std::span<const float>() : found->values;
    };
    const auto normals = values_of("NORMAL");
    const auto uv = values_of("TEXCOORD_" + to_string(relief_uv));
    if (normals.empty() || uv.empty() || !has_count(*primitive_.tangents)) return;
    constexpr std::uint64_t kCornerBytes = 96;  // a sum of the comparison
    const std::uint64_t bytes = 4 * sizeof(float) * geometry.num_vertices() +
                                3 * kCornerBytes * geometry.triangles.size();
    if (!values_.memory().take(primitive_.path, bytes)) return;
    const std::vector<float> tangents =
        values_.floats(*primitive_.tangents, "VEC4", GltfValues::Integers::kToo);
    if (!errors_) {
      geometry.tangents =
          compare_tangents({geometry.triangles, geometry.base, normals, uv, tangents});
    }
    values_.memory().give_back(bytes);
  }

  void read_influences(std::size_t num_joints, GltfGeometry& geometry) {
    const std::uint64_t vertex_bytes =
        3 * (sizeof(std::uint64_t) + 4 * primitive_.joints.size() * sizeof(GltfInfluence));
    if (!values_.memory().take(primitive_.path, vertex_bytes * geometry.num_vertices())) return;
    if (primitive_.joints.empty()) {
      errors_.expected(primitive_.path + ".attributes", "no JOINTS_0 and WEIGHTS_0",
                       "them, as a node has a skin with this mesh");
    }
    std::vector<std::vector<std::uint32_t>> joints;
    std::vector<std::vector<float>> weights;
    for (std::size_t set = 0; set < primitive_.joints.size() && !errors_; ++set) {
      if (!has_count(primitive_.joints[set]) || !has_count(primitive_.weights[set])) return;
      joints.push_back(values_.integers(primitive_.joints[set], "VEC4"));
      weights.push_back(
          values_.floats(primitive_.weights[set], "VEC4", GltfValues::Integers::kToo));
      if (errors_) return;
      check_influences(set, num_joints, joints.back(), weights.back());
    }
    if (errors_) return;
    for (std::size_t v = 0; v < geometry.num_vertices(); ++v) {
      const std::size_t first = geometry.influences.size();
      geometry.first_influence.push_back(first);
      for (std::size_t set = 0; set < joints.size(); ++set) {
        for (std::size_t i = 4 * v; i < 4 * v + 4; ++i) {
          if (weights[set][i] == 0) continue;
          geometry.influences.push_back({joints[set][i], weights[set][i]});
        }
      }
      // A vertex without any weight follows its first joint, as in viewers.
      if (geometry.influences.size() == first) {
        geometry.influences.push_back({joints[0][4 * v], 1.0F});
      }
    }
    geometry.first_influence.push_back(geometry.influences.size());
  }

  void check_influences(std::size_t set, std::size_t num_joints,
                        const std::vector<std::uint32_t>& joints,
                        const std::vector<float>& weights) {
    const auto element = [](std::uint32_t accessor, std::size_t i) {
      return gltf_accessor_path(accessor) + ", element " + to_string(i / 4);
    };
    for (std::size_t i = 0; i < joints.size() && !errors_; ++i) {
      if (joints[i] >= num_joints) {
        errors_.expected(element(primitive_.joints[set], i), "joint " + to_string(joints[i]),
                         "joints below " + to_string(num_joints) + ", those of the skin");
      }
      if (weights[i] < 0) {
        errors_.expected(element(primitive_.weights[set], i), to_string(weights[i]),
                         "weights of 0 or more");
      }
    }
  }

  // Returns the vertices in the order of the index list.
  std::vector<std::uint32_t> corners(std::uint32_t num_vertices) {
    if (!primitive_.indices) {
      std::vector<std::uint32_t> all(num_vertices);
      std::iota(all.begin(), all.end(), 0U);
      return all;
    }
    const std::uint32_t accessor = *primitive_.indices;
    std::vector<std::uint32_t> corners = values_.integers(accessor, "SCALAR");
    const auto wrong = std::find_if(corners.begin(), corners.end(),
                                    [&](std::uint32_t v) { return v >= num_vertices; });
    if (wrong != corners.end()) {
      errors_.expected(
          gltf_accessor_path(accessor) + ", element " + to_string(wrong - corners.begin()),
          "vertex " + to_string(*wrong),
          "vertices below " + to_string(num_vertices) + ", those of " + primitive_.path);
    }
    return corners;
  }

  std::vector<Triangle> triangles(const std::vector<std::uint32_t>& c) {
    std::vector<Triangle> triangles;
    const std::uint64_t max = primitive_.mode == GltfMode::kTriangles ? c.size() / 3 : c.size();
    if (!values_.memory().take(primitive_.path, 3 * sizeof(Triangle) * max)) return triangles;
    if (primitive_.mode == GltfMode::kTriangles) {
      if (c.size() % 3 != 0) {
        errors_.expected(
            gltf_accessor_path(primitive_.indices.value_or(primitive_.positions)) + ".count",
            to_string(c.size()), "a multiple of 3 for triangles");
        return triangles;
      }
      for (std::size_t i = 0; i < c.size(); i += 3) {
        triangles.push_back({c[i], c[i + 1], c[i + 2]});
      }
      return triangles;
    }
    const bool strip = primitive_.mode == GltfMode::kTriangleStrip;
    for (std::size_t i = 0; i + 2 < c.size(); ++i) {
      triangles.push_back(strip ? Triangle{c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]}
                                : Triangle{c[i + 1], c[i + 2], c[0]});
    }
    return triangles;
  }

  const GltfPrimitive& primitive_;
  GltfValues& values_;
  GltfErrors& errors_;
};

}  // namespace

GltfGeometry read_gltf_geometry(const GltfPrimitive& primitive, std::size_t num_joints,
                                std::optional<std::size_t> relief_uv, GltfValues& values,
                                GltfErrors& errors) {
  return GeometryReader(primitive, values, errors).read(num_joints, relief_uv);
}

void morph(std::span<const float> base, std::span<const GltfGeometry::Target> targets,
           std::span<const double> weights, std::vector<double>& out) {
  out.assign(base.begin(), base.end());
  for (const auto& [number, deltas] : targets) {
    const double weight = weights[number];
    if (weight == 0) continue;
    for (const GltfDelta& delta : deltas) {
      double* const p = &out[3 * std::size_t{delta.vertex}];
      for (std::size_t c = 0; c < 3; ++c) p[c] += weight * delta.move[c];
    }
  }
}

void place(const std::vector<double>& positions, const Affine& node, std::span<double> out) {
  for (std::size_t i = 0; i < positions.size(); i += 3) {
    const GltfVec3 p = node({positions[i], positions[i + 1], positions[i + 2]});
    for (std::size_t c = 0; c < 3; ++c) out[i + c] = p[c];
  }
}

void place_by_joints(const GltfGeometry& geometry, const std::vector<double>& positions,
                     const std::vector<Affine>& joints, std::span<double> out) {
  for (std::size_t v = 0; v < geometry.num_vertices(); ++v) {
    const GltfVec3 p{positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]};
    GltfVec3 sum{};
    double total = 0.0;  // may differ from 1 for integer or rounded weights
    for (auto i = geometry.first_influence[v]; i < geometry.first_influence[v + 1]; ++i) {
      const GltfInfluence& influence = geometry.influences[static_cast<std::size_t>(i)];
      const GltfVec3 moved = joints[influence.joint](p);
      for (std::size_t c = 0; c < 3; ++c) sum[c] += influence.weight * moved[c];
      total += influence.weight;
    }
    for (std::size_t c = 0; c < 3; ++c) out[3 * v + c] = sum[c] / total;
  }
}

}  // namespace rlpc
