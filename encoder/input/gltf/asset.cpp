#include "encoder/input/gltf/asset.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "encoder/input/glb_asset.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

constexpr const char* kKept[] = {"materials", "textures", "samplers", "images"};

// Removes every reference to a texture: members whose names end in "Texture".
void remove_textures(Json& value) {
  if (value.is_object()) {
    for (auto it = value.begin(); it != value.end();) {
      it = it.key().ends_with("Texture") ? value.erase(it) : std::next(it);
    }
  }
  if (!value.is_structured()) return;
  for (Json& member : value) remove_textures(member);
}

// Names of extensions that occur in the document.
void find_extensions(const Json& value, std::vector<std::string>& found) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("extensions") && value["extensions"].is_object()) {
    for (const auto& [name, unused] : value["extensions"].items()) found.push_back(name);
  }
  for (const Json& member : value) find_extensions(member, found);
}

class AssetMaker {
 public:
  AssetMaker(const Json& root, const GltfModel& model, GltfFile& file, GltfMemory& memory)
      : root_(root), model_(model), file_(file), memory_(memory) {}

  GltfAsset make(bool textures) {
    for (const char* const key : kKept) {
      if (root_.contains(key)) out_[key] = root_[key];
    }
    // What glTF has by default, written down: streams without materials get another.
    if (!out_.contains("materials")) out_["materials"] = Json::array({Json::object()});
    if (!textures) {
      for (const char* const key : {"textures", "samplers", "images"}) out_.erase(key);
      if (out_.contains("materials")) remove_textures(out_["materials"]);
    } else if (out_.contains("images")) {
      add_images();
    }
    add_parts();
    GltfAsset asset;
    if (!out_.empty()) asset.glb = glb();
    asset.notes = std::move(notes_);
    return asset;
  }

 private:
  void add_images() {
    Json& images = out_["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
      Json& image = images[i];
      auto bytes = read_image(image, "images[" + std::to_string(i) + "]");
      if (!bytes) continue;
      if (!memory_.take("images", 2 * bytes->size())) return;
      image.erase("uri");
      image["bufferView"] = made_.add_view(*bytes);
      if (!image.contains("mimeType") && !type_of_image(*bytes).empty()) {
        image["mimeType"] = type_of_image(*bytes);
      }
    }
  }

  // None: it is left as it is, and a note says why.
  std::optional<std::string> read_image(const Json& image, const std::string& place) {
    GltfErrors errors(file_.file.path());
    const GltfValue value(image, errors);
    std::vector<GltfBuffer> buffers;
    std::uint64_t offset = 0;
    std::optional<std::uint64_t> size;
    std::uint32_t number = 0;
    if (value["uri"].exists()) {
      buffers.push_back({0, value["uri"].text()});
    } else {
      const GltfValue root(root_, errors);
      const GltfValue all = root["buffers"];
      for (std::size_t b = 0; b < all.size(); ++b) {
        GltfBuffer& buffer = buffers.emplace_back();
        buffer.size = all[b]["byteLength"].integer({1, GltfValue::kMaxInteger});
        if (all[b]["uri"].exists()) buffer.uri = all[b]["uri"].text();
      }
      const std::size_t count = root["bufferViews"].size();
      const auto view_number = value["bufferView"].index_if_any(count, "bufferViews");
      if (view_number) {
        const GltfValue view = root["bufferViews"][*view_number];
        number = view["buffer"].index(buffers.size(), "buffers");
        offset = view["byteOffset"].integer({0, GltfValue::kMaxInteger}, 0);
        size = view["byteLength"].integer({1, GltfValue::kMaxInteger});
        if (!errors && offset + *size > buffers[number].size) {
          view.fail("a view within its buffer");
        }
      } else {
        value.fail("uri or bufferView");
      }
    }
    std::string bytes;
    if (!errors) {
      GltfBuffers reader(std::move(buffers), file_, errors);
      if (reader.available(number)) {
        bytes.resize(static_cast<std::size_t>(size.value_or(reader.size(number))));
        reader.read(number, offset, bytes);
        for (const std::string& path : reader.files()) files_.push_back(path);
      }
    }
    if (!errors) return bytes;
    notes_.push_back("texture " + place + " is not carried: " + errors.first().message);
    return std::nullopt;
  }

  // Names of the nodes that hold the parts, in the order of `part` (Table F-1).
  void add_parts() {
    std::vector<std::uint32_t> nodes;
    for (const GltfModel::Instance& instance : model_.instances) {
      if (std::find(nodes.begin(), nodes.end(), instance.node) == nodes.end()) {
        nodes.push_back(instance.node);
      }
    }
    bool has_name = false;
    Json parts = Json::array();
    for (const std::uint32_t node : nodes) {
      Json part = Json::object();
      const Json& source = root_["nodes"][node];
      if (source.contains("name") && source["name"].is_string()) {
        part["name"] = source["name"];
        has_name = true;
      }
      parts.push_back(std::move(part));
    }
    if (has_name) out_["nodes"] = std::move(parts);
  }

  std::string glb() {
    std::vector<std::string> extensions;
    find_extensions(out_, extensions);
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
      if (!root_.contains(list) || !root_[list].is_array()) continue;
      for (const Json& name : root_[list]) {
        if (name.is_string() && std::find(extensions.begin(), extensions.end(),
                                          name.get<std::string>()) != extensions.end()) {
          out_[list].push_back(name);
        }
      }
    }
    Json about = {{"version", "2.0"}};
    const Json& asset = root_["asset"];
    for (const char* const key : {"copyright", "generator"}) {
      if (asset.contains(key)) about[key] = asset[key];
    }
    return made_.glb(std::move(about));
  }

  const Json& root_;
  const GltfModel& model_;
  GltfFile& file_;
  GltfMemory& memory_;
  GlbAsset made_;
  Json& out_ = made_.root;
  std::vector<std::string> notes_;
  std::vector<std::string> files_;
};

}  // namespace

GltfAsset make_gltf_asset(const nlohmann::json& root, const GltfModel& model, GltfFile& file,
                          bool textures, GltfMemory& memory) {
  return AssetMaker(root, model, file, memory).make(textures);
}

}  // namespace rlpc
