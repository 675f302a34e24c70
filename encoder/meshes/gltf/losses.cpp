#include "encoder/meshes/gltf/losses.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "encoder/meshes/gltf/document/json.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

// Returns the elements of an array; none of other values.
const Json& elements(const Json& value, const char* key) {
  static const Json kNone = Json::array();
  const Json& found = gltf_member(value, key);
  return found.is_array() ? found : kNone;
}

std::string joined(const std::vector<std::string>& names) {
  constexpr std::size_t kMax = 5;
  std::string text;
  for (std::size_t i = 0; i < names.size() && i < kMax; ++i) {
    text += (i > 0 ? ", " : "") + names[i];
  }
  return text + (names.size() > kMax ? ", ..." : "");
}

std::string counted(std::size_t count, const std::string& one, const std::string& many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

// Whether a set is read: sets with numbers are, if all lower numbers exist.
bool is_read(const std::string& name, const Json& attributes) {
  if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") return true;
  for (const char* const set : {"TEXCOORD_", "COLOR_", "JOINTS_", "WEIGHTS_"}) {
    if (!name.starts_with(set)) continue;
    for (std::size_t i = 0; attributes.contains(set + std::to_string(i)); ++i) {
      if (name == set + std::to_string(i)) return true;
    }
  }
  return false;
}

class LossFinder {
 public:
  LossFinder(const Json& root, const GltfModel& model) : root_(root), model_(model) {}

  std::vector<std::string> find() {
    add_attributes();
    add_targets();
    add_scenes();
    add_empty_nodes();
    for (const auto& [key, value] : root_.items()) {
      const bool is_kept =
          key == "materials" || key == "textures" || key == "images" || key == "samplers";
      if (!is_kept) walk(key, value);
    }
    add_asset();
    add_extras(root_, "the document");
    add_extensions(root_);
    for (const std::string& name : extensions_) found_.push_back("extension " + name);
    if (!extras_.empty()) {
      found_.push_back("extras of " + joined({extras_.begin(), extras_.end()}));
    }
    return std::move(found_);
  }

 private:
  void add_attributes() {
    std::set<std::string> names;
    std::set<std::string> target_names;
    std::size_t without_positions = 0;
    for (const Json& mesh : elements(root_, "meshes")) {
      for (const Json& primitive : elements(mesh, "primitives")) {
        const Json& attributes = gltf_member(primitive, "attributes");
        if (!attributes.is_object()) continue;
        if (!attributes.contains("POSITION")) ++without_positions;
        for (const auto& [name, unused] : attributes.items()) {
          if (!is_read(name, attributes)) names.insert(gltf_quoted(name));
        }
        for (const Json& target : elements(primitive, "targets")) {
          if (!target.is_object()) continue;
          for (const auto& [name, unused] : target.items()) {
            if (name != "POSITION" && name != "NORMAL") target_names.insert(gltf_quoted(name));
          }
        }
      }
    }
    if (!names.empty()) found_.push_back("attributes " + joined({names.begin(), names.end()}));
    if (!target_names.empty()) {
      found_.push_back("attributes " + joined({target_names.begin(), target_names.end()}) +
                       " of morph targets");
    }
    if (without_positions > 0) {
      found_.push_back(counted(without_positions, "primitive", "primitives") +
                       " without positions");
    }
  }

  // Whether a track changes a target, from key to key or between them.
  static bool moves(const GltfTrack& track, std::size_t target) {
    const bool is_cubic = track.interpolation == GltfInterpolation::kCubicSpline;
    const std::size_t row = track.width;
    if (target >= row) return false;
    const std::size_t first = is_cubic ? row : 0;
    for (std::size_t i = 0; (i + 1) * row <= track.values.size(); ++i) {
      const float value = track.values[i * row + target];
      const bool is_tangent = is_cubic && i % 3 != 1;
      if (is_tangent ? value != 0.0F : value != track.values[first + target]) return true;
    }
    return false;
  }

  void add_targets() {
    std::vector<std::string> names;
    bool some_move = false;
    std::set<std::uint32_t> known;
    for (const GltfModel::Instance& instance : model_.instances) {
      const auto mesh = model_.nodes[instance.node].mesh;
      if (!mesh || !known.insert(*mesh).second) continue;
      for (std::size_t t = 0; t < model_.weights[*mesh].size(); ++t) {
        if (is_moved(*mesh, t)) {
          some_move = true;
        } else {
          names.push_back(target_name(*mesh, t));
        }
      }
    }
    if (!names.empty()) {
      const bool has_other_clips = elements(root_, "animations").size() > model_.clips.size();
      found_.push_back(counted(names.size(), "morph target", "morph targets") +
                       (has_other_clips ? " that the chosen animations do not move ("
                                        : " that no animation moves (") +
                       joined(names) + ")");
    }
    if (some_move) found_.emplace_back("morph targets (not their motion)");
  }

  bool is_moved(std::uint32_t mesh, std::size_t target) const {
    for (const GltfClip& clip : model_.clips) {
      for (const GltfClip::Channel& channel : clip.channels) {
        if (channel.path == GltfPath::kWeights && model_.nodes[channel.node].mesh == mesh &&
            moves(channel.track, target)) {
          return true;
        }
      }
    }
    return false;
  }

  std::string target_name(std::uint32_t mesh, std::size_t target) const {
    const Json& names = elements(gltf_member(root_["meshes"][mesh], "extras"), "targetNames");
    if (target < names.size() && names[target].is_string()) {
      const std::string name = names[target].get<std::string>();
      return gltf_quoted(name).size() == name.size() + 2 ? name : gltf_quoted(name);
    }
    return "number " + std::to_string(target);
  }

  void add_scenes() {
    const std::size_t scenes = elements(root_, "scenes").size();
    if (scenes > 1) {
      found_.push_back(counted(scenes - 1, "other scene", "other scenes"));
    }
    std::set<std::uint32_t> shown;
    for (const std::uint32_t node : model_.scene.with_mesh)
      shown.insert(*model_.nodes[node].mesh);
    const std::size_t meshes = elements(root_, "meshes").size();
    if (meshes > shown.size()) {
      found_.push_back(counted(meshes - shown.size(), "mesh", "meshes") + " outside the scene");
    }
  }

  // Adds nodes without content, which programs use as places to attach something to.
  void add_empty_nodes() {
    std::set<std::uint32_t> joints;
    for (const GltfModel::Skin& skin : model_.skins) {
      joints.insert(skin.joints.begin(), skin.joints.end());
    }
    std::vector<std::string> names;
    const Json& nodes = elements(root_, "nodes");
    for (std::uint32_t n = 0; n < nodes.size() && n < model_.nodes.size(); ++n) {
      if (!model_.nodes[n].children.empty() || model_.nodes[n].mesh || joints.contains(n))
        continue;
      const Json& parent_extensions = gltf_member(nodes[n], "extensions");
      const bool is_light = !gltf_member(parent_extensions, "KHR_lights_punctual").is_null();
      if (is_light || !gltf_member(nodes[n], "camera").is_null()) continue;
      const auto parent = model_.scene.parent[n];
      if (parent && joints.contains(*parent)) continue;  // the end of a bone
      const Json& name = gltf_member(nodes[n], "name");
      names.push_back(name.is_string() ? gltf_quoted(name.get<std::string>())
                                       : "number " + std::to_string(n));
    }
    if (!names.empty()) {
      found_.push_back(counted(names.size(), "empty node", "empty nodes") + " (" +
                       joined(names) + ")");
    }
  }

  // Adds who made the file, and under which terms.
  void add_asset() {
    const Json& asset = gltf_member(root_, "asset");
    if (!asset.is_object()) return;
    std::vector<std::string> names;
    for (const auto& [key, unused] : asset.items()) {
      // The generator is noted separately: nearly every file has one.
      static const std::set<std::string_view> kOthers{"version", "minVersion", "generator",
                                                      "extras", "extensions"};
      if (kOthers.contains(key)) continue;
      names.push_back(key == "copyright" ? key : gltf_quoted(key));
    }
    if (!names.empty()) found_.push_back("asset information (" + joined(names) + ")");
  }

  // Finds extensions and extras anywhere in a value. kind: the array of the document it is in.
  void walk(const std::string& kind, const Json& value) {
    std::vector<const Json*> open{&value};
    while (!open.empty()) {
      const Json& next = *open.back();
      open.pop_back();
      if (next.is_object()) {
        add_extensions(next);
        add_extras(next, kind);
        for (const auto& [key, part] : next.items()) {
          if (key != "extensions" && key != "extras" && part.is_structured()) {
            open.push_back(&part);
          }
        }
      } else if (next.is_array()) {
        for (const Json& part : next) {
          if (part.is_structured()) open.push_back(&part);
        }
      }
    }
  }

  // Whether an extension is read, named elsewhere, or without effect on what is read.
  bool is_named_elsewhere(const std::string& name) const {
    static const std::set<std::string_view> kKnown{
        "KHR_mesh_quantization", "KHR_animation_pointer", "EXT_meshopt_compression",
        "KHR_meshopt_compression", "KHR_draco_mesh_compression"};
    if (kKnown.contains(name)) return true;
    // The list of the document names these.
    if (name == "KHR_lights_punctual" || name == "KHR_materials_variants") {
      return !gltf_member(gltf_member(root_, "extensions"), name.c_str()).is_null();
    }
    // The document names these as used.
    if (name != "EXT_mesh_gpu_instancing" && name != "KHR_node_visibility" &&
        name != "MSFT_lod") {
      return false;
    }
    const Json& used = elements(root_, "extensionsUsed");
    return std::any_of(used.begin(), used.end(), [&](const Json& x) { return x == name; });
  }

  void add_extensions(const Json& value) {
    const Json& extensions = gltf_member(value, "extensions");
    if (!extensions.is_object()) return;
    for (const auto& [name, unused] : extensions.items()) {
      if (!is_named_elsewhere(name)) extensions_.insert(gltf_quoted(name));
    }
  }

  void add_extras(const Json& value, const std::string& kind) {
    const Json& extras = gltf_member(value, "extras");
    if (extras.is_null()) return;
    // Names of morph targets are read, and the frame rate that rlpcdec writes.
    const char* const read = kind == "meshes"  ? "targetNames"
                             : kind == "asset" ? "frame_rate"
                                               : "";
    if (extras.is_object() && extras.size() == (extras.contains(read) ? 1U : 0U)) return;
    extras_.insert(kind);
  }

  const Json& root_;
  const GltfModel& model_;
  std::vector<std::string> found_;
  std::set<std::string> extensions_;
  std::set<std::string> extras_;  // kinds of values with extras
};

}  // namespace

std::vector<std::string> gltf_losses(const nlohmann::json& root, const GltfModel& model) {
  return LossFinder(root, model).find();
}

std::string pointer_target(const std::string& pointer) {
  const auto has = [&](std::string_view part) { return pointer.find(part) != pointer.npos; };
  if (pointer.empty()) return "";
  if (pointer.starts_with("/materials/")) return "materials";
  if (pointer.starts_with("/cameras/")) return "cameras";
  if (has("KHR_lights")) return "lights";
  if (has("KHR_node_visibility")) return "visibility";
  if (pointer.starts_with("/nodes/")) return "nodes (by KHR_animation_pointer)";
  if (pointer.starts_with("/meshes/")) return "meshes (by KHR_animation_pointer)";
  return gltf_quoted(pointer);
}

}  // namespace rlpc
