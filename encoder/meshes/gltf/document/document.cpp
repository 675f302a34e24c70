#include "encoder/meshes/gltf/document/document.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rlpc {

namespace {

using std::to_string;

// Whether an extension does not affect positions, or is KHR_mesh_quantization, which is
// supported.
bool is_supported(const std::string& extension) {
  static const char* const kHarmless[] = {
      "KHR_mesh_quantization", "KHR_materials_", "KHR_texture_", "EXT_texture_",
      "MSFT_texture_",         "KHR_lights_",    "EXT_lights_",  "KHR_xmp"};
  return std::any_of(std::begin(kHarmless), std::end(kHarmless),
                     [&](const char* prefix) { return extension.starts_with(prefix); });
}

void check_extensions(const GltfValue& required) {
  for (std::size_t i = 0; i < required.size(); ++i) {
    const std::string name = required[i].text();
    if (is_supported(name)) continue;
    const bool compression = name.find("compression") != name.npos;
    required[i].fail(std::string("no extension that changes the mesh; export the file again ") +
                     (compression ? "without compression of meshes" : "without it"));
  }
}

// Returns extensions without which the file can be read, but looks different.
std::vector<std::string> left_out(const GltfValue& used) {
  std::vector<std::string> found;
  for (std::size_t i = 0; i < used.size(); ++i) {
    const std::string name = used[i].text();
    for (const char* const known :
         {"EXT_mesh_gpu_instancing", "KHR_node_visibility", "MSFT_lod"}) {
      if (name == known) found.push_back(name);
    }
  }
  return found;
}

// Returns contents that a stream does not carry, in the words of users.
std::vector<std::string> dropped(const GltfValue& root) {
  std::vector<std::string> found;
  const GltfValue meshes = root["meshes"];
  bool has_tangents = false;
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const GltfValue primitives = meshes[m]["primitives"];
    for (std::size_t p = 0; p < primitives.size(); ++p) {
      const GltfValue attributes = primitives[p]["attributes"];
      has_tangents |= attributes["TANGENT"].exists();
    }
  }
  // Viewers compute tangents from normals and texture coordinates; those of one pose are
  // useless.
  if (has_tangents) found.emplace_back("tangents");
  const std::pair<const char*, const char*> arrays[] = {{"skins", "skeleton (not its motion)"},
                                                        {"cameras", "cameras"}};
  for (const auto& [name, what] : arrays) {
    if (root[name].size() > 0) found.emplace_back(what);
  }
  const GltfValue extensions = root["extensions"];
  if (extensions["KHR_lights_punctual"].exists()) found.emplace_back("lights");
  if (extensions["KHR_materials_variants"].exists())
    found.emplace_back("variants of materials");
  return found;
}

void check_version(const GltfValue& asset) {
  const std::string version = asset["version"].text();
  if (!version.starts_with("2.")) asset["version"].fail("\"2.0\"");
  if (asset["minVersion"].text("2.0") != "2.0") asset["minVersion"].fail("\"2.0\"");
}

// Sizes of the arrays that indices refer to.
struct Counts {
  explicit Counts(const GltfValue& root)
      : accessors(root["accessors"].size()),
        materials(root["materials"].size()),
        meshes(root["meshes"].size()),
        nodes(root["nodes"].size()),
        skins(root["skins"].size()) {}
  std::size_t accessors;
  std::size_t materials;
  std::size_t meshes;
  std::size_t nodes;
  std::size_t skins;
};

// Returns the accessors of NAME_0, NAME_1 and so on, without gaps.
std::vector<std::uint32_t> numbered(const GltfValue& attributes, const std::string& name,
                                    const Counts& counts) {
  std::vector<std::uint32_t> found;
  while (true) {
    const GltfValue next = attributes[name + to_string(found.size())];
    if (!next.exists()) return found;
    found.push_back(next.index(counts.accessors, "accessors"));
  }
}

GltfPrimitive read_primitive(const GltfValue& value, const Counts& counts) {
  GltfPrimitive primitive;
  primitive.path = value.path();
  primitive.mode = static_cast<GltfMode>(value["mode"].integer({0, 6}, 4));
  primitive.indices = value["indices"].index_if_any(counts.accessors, "accessors");
  const GltfValue attributes = value["attributes"];
  primitive.positions = attributes["POSITION"].index(counts.accessors, "accessors");
  primitive.is_compressed = value["extensions"]["KHR_draco_mesh_compression"].exists();
  primitive.joints = numbered(attributes, "JOINTS_", counts);
  primitive.weights = numbered(attributes, "WEIGHTS_", counts);
  if (primitive.joints.size() != primitive.weights.size()) {
    attributes.fail("as many sets of JOINTS_ (" + to_string(primitive.joints.size()) +
                    ") as of WEIGHTS_ (" + to_string(primitive.weights.size()) + ")");
  }
  const auto normals = attributes["NORMAL"].index_if_any(counts.accessors, "accessors");
  if (normals) primitive.attributes.push_back({"NORMAL", *normals});
  for (const std::string name : {"TEXCOORD_", "COLOR_"}) {
    for (const std::uint32_t accessor : numbered(attributes, name, counts)) {
      const std::size_t number = static_cast<std::size_t>(
          std::count_if(primitive.attributes.begin(), primitive.attributes.end(),
                        [&](const GltfAttribute& a) { return a.semantic.starts_with(name); }));
      primitive.attributes.push_back({name + to_string(number), accessor});
    }
  }
  primitive.tangents = attributes["TANGENT"].index_if_any(counts.accessors, "accessors");
  primitive.material = value["material"].index_if_any(counts.materials, "materials");
  const GltfValue targets = value["targets"];
  for (std::size_t i = 0; i < targets.size(); ++i) {
    primitive.targets.push_back(
        targets[i]["POSITION"].index_if_any(counts.accessors, "accessors"));
    primitive.normal_targets.push_back(
        targets[i]["NORMAL"].index_if_any(counts.accessors, "accessors"));
  }
  return primitive;
}

GltfMesh read_mesh(const GltfValue& value, const Counts& counts) {
  GltfMesh mesh;
  const GltfValue primitives = value["primitives"];
  if (!primitives.exists()) primitives.fail("an array of primitives");
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    const GltfValue targets = primitives[i]["targets"];
    if (i == 0) mesh.num_targets = targets.size();
    if (targets.size() != mesh.num_targets) {
      targets.fail(to_string(mesh.num_targets) + " targets, as the first primitive has");
    }
    // Nothing is visible without positions.
    if (!primitives[i]["attributes"]["POSITION"].exists()) continue;
    mesh.primitives.push_back(read_primitive(primitives[i], counts));
  }
  mesh.weights =
      value["weights"].numbers(mesh.num_targets, std::vector<double>(mesh.num_targets));
  return mesh;
}

GltfNode read_node(const GltfValue& value, const Counts& counts,
                   const std::vector<GltfMesh>& meshes, const GltfErrors& errors) {
  GltfNode node;
  node.mesh = value["mesh"].index_if_any(counts.meshes, "meshes");
  node.skin = value["skin"].index_if_any(counts.skins, "skins");
  const GltfValue children = value["children"];
  for (std::size_t i = 0; i < children.size(); ++i) {
    node.children.push_back(children[i].index(counts.nodes, "nodes"));
  }
  const std::vector<double> t = value["translation"].numbers(3, {0, 0, 0});
  const std::vector<double> r = value["rotation"].numbers(4, {0, 0, 0, 1});
  const std::vector<double> s = value["scale"].numbers(3, {1, 1, 1});
  const double length = std::sqrt(r[0] * r[0] + r[1] * r[1] + r[2] * r[2] + r[3] * r[3]);
  if (length == 0 || !std::isfinite(length)) value["rotation"].fail("a unit quaternion");
  node.translation = {t[0], t[1], t[2]};
  node.rotation = {r[0] / length, r[1] / length, r[2] / length, r[3] / length};
  node.scale = {s[0], s[1], s[2]};
  if (value["matrix"].exists()) {
    node.matrix = affine_of_columns(value["matrix"].numbers(16, std::vector<double>(16)));
  }
  if (node.mesh && !errors && value["weights"].exists()) {
    node.weights = value["weights"].numbers(meshes[*node.mesh].num_targets, {});
  }
  return node;
}

GltfSkin read_skin(const GltfValue& value, const Counts& counts) {
  GltfSkin skin;
  const GltfValue joints = value["joints"];
  if (joints.size() == 0) joints.fail("an array of nodes");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    skin.joints.push_back(joints[i].index(counts.nodes, "nodes"));
  }
  skin.inverse_bind = value["inverseBindMatrices"].index_if_any(counts.accessors, "accessors");
  return skin;
}

GltfAnimation::Sampler read_sampler(const GltfValue& value, const Counts& counts) {
  GltfAnimation::Sampler sampler;
  sampler.input = value["input"].index(counts.accessors, "accessors");
  sampler.output = value["output"].index(counts.accessors, "accessors");
  const std::string name = value["interpolation"].text("LINEAR");
  if (name == "STEP") {
    sampler.interpolation = GltfInterpolation::kStep;
  } else if (name == "CUBICSPLINE") {
    sampler.interpolation = GltfInterpolation::kCubicSpline;
  } else if (name != "LINEAR") {
    value["interpolation"].fail("\"LINEAR\", \"STEP\" or \"CUBICSPLINE\"");
  }
  return sampler;
}

GltfAnimation read_animation(const GltfValue& value, const Counts& counts) {
  static const std::map<std::string, GltfPath> kPaths{{"translation", GltfPath::kTranslation},
                                                      {"rotation", GltfPath::kRotation},
                                                      {"scale", GltfPath::kScale},
                                                      {"weights", GltfPath::kWeights}};
  GltfAnimation animation;
  animation.name = value["name"].text("");
  const GltfValue samplers = value["samplers"];
  for (std::size_t i = 0; i < samplers.size(); ++i) {
    animation.samplers.push_back(read_sampler(samplers[i], counts));
  }
  std::map<std::pair<std::uint32_t, GltfPath>, std::string> known;
  const GltfValue channels = value["channels"];
  for (std::size_t i = 0; i < channels.size(); ++i) {
    const GltfValue target = channels[i]["target"];
    const std::string path = target["path"].text();
    if (!target["node"].exists() || path == "pointer") {  // for extensions
      const GltfValue extension = target["extensions"]["KHR_animation_pointer"];
      animation.pointers.push_back(extension["pointer"].text(""));
      continue;
    }
    const auto found = kPaths.find(path);
    if (found == kPaths.end()) {
      target["path"].fail("\"translation\", \"rotation\", \"scale\" or \"weights\"");
      continue;
    }
    GltfAnimation::Channel channel;
    channel.sampler = channels[i]["sampler"].index(samplers.size(), "samplers");
    channel.node = target["node"].index(counts.nodes, "nodes");
    channel.path = found->second;
    const auto [first, is_new] = known.try_emplace({channel.node, channel.path}, target.path());
    if (!is_new) target.fail("another node or path than " + first->second + " has");
    animation.channels.push_back(channel);
  }
  return animation;
}

std::optional<std::vector<std::uint32_t>> read_scene(const GltfValue& root,
                                                     const Counts& counts) {
  const GltfValue scenes = root["scenes"];
  const auto chosen = root["scene"].index_if_any(scenes.size(), "scenes");
  if (scenes.size() == 0) return std::nullopt;
  std::vector<std::uint32_t> scene;
  const GltfValue nodes = scenes[chosen.value_or(0)]["nodes"];
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    scene.push_back(nodes[i].index(counts.nodes, "nodes"));
  }
  return scene;
}

template <class Read>
auto read_all(const GltfValue& values, const Read& read) {
  std::vector<decltype(read(values))> all;
  for (std::size_t i = 0; i < values.size(); ++i) all.push_back(read(values[i]));
  return all;
}

}  // namespace

GltfDocument read_gltf_document(const GltfValue& root, GltfErrors& errors) {
  GltfDocument document;
  check_version(root["asset"]);
  check_extensions(root["extensionsRequired"]);
  document.extensions_left_out = left_out(root["extensionsUsed"]);
  document.dropped = dropped(root);
  const Counts counts(root);
  document.num_materials = counts.materials;
  for (const char* const list : {"images", "textures", "samplers"}) {
    (void)root[list].size();  // an error unless it is a list
  }
  document.buffers = read_all(root["buffers"], [](const GltfValue& value) {
    GltfBuffer buffer;
    buffer.size = value["byteLength"].integer({1, GltfValue::kMaxInteger});
    if (value["uri"].exists()) buffer.uri = value["uri"].text();
    return buffer;
  });
  document.accessors = read_gltf_accessors(root, document.buffers, errors);
  document.meshes = read_all(root["meshes"],
                             [&](const GltfValue& value) { return read_mesh(value, counts); });
  document.nodes = read_all(root["nodes"], [&](const GltfValue& value) {
    return read_node(value, counts, document.meshes, errors);
  });
  document.skins =
      read_all(root["skins"], [&](const GltfValue& value) { return read_skin(value, counts); });
  document.animations = read_all(root["animations"], [&](const GltfValue& value) {
    return read_animation(value, counts);
  });
  document.scene = read_scene(root, counts);
  return document;
}

}  // namespace rlpc
