#include "encoder/input/gltf/asset.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>
#include <utility>

#include "encoder/input/glb_asset.h"
#include "encoder/input/gltf/equal_uv.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

constexpr const char* kKept[] = {"materials", "textures", "samplers", "images"};

// Removes references to textures, members whose names end in "Texture", if they are unwanted.
template <class IsUnwanted>
void remove_textures(Json& value, const IsUnwanted& is_unwanted) {
  if (value.is_object()) {
    for (auto it = value.begin(); it != value.end();) {
      const bool is_texture = it.key().ends_with("Texture");
      it = is_texture && is_unwanted(*it) ? value.erase(it) : std::next(it);
    }
  }
  if (!value.is_structured()) return;
  for (Json& member : value) remove_textures(member, is_unwanted);
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
    if (!out_.contains("materials")) out_["materials"] = Json::array();
    if (out_["materials"].size() == model_.num_materials && has_plain_parts()) {
      out_["materials"].push_back(Json::object());
    }
    if (!textures) {
      for (const char* const key : {"textures", "samplers", "images"}) out_.erase(key);
      remove_textures(out_["materials"], [](const Json&) { return true; });
    } else {
      if (out_.contains("images")) add_images();
      check_textures();
    }
    use_first_uv(model_.equal_uv, out_["materials"]);
    // For writers of glTF, which restore them.
    if (!model_.equal_uv.empty()) out_["extras"]["equal_uv"] = model_.equal_uv;
    add_parts();
    GltfAsset asset;
    if (!out_.empty()) asset.glb = glb();
    asset.notes = std::move(notes_);
    asset.files = std::move(files_);
    return asset;
  }

 private:
  void add_images() {
    Json& images = out_["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
      Json& image = images[i];
      auto bytes = read_image(image, "images[" + std::to_string(i) + "]");
      is_carried_.push_back(bytes.has_value());
      if (!bytes) continue;
      if (!memory_.take("images", 2 * bytes->size())) return;
      image.erase("uri");
      image["bufferView"] = made_.add_view(*bytes);
      if (!image.contains("mimeType") && !type_of_image(*bytes).empty()) {
        image["mimeType"] = type_of_image(*bytes);
      }
    }
  }

  // Whether a primitive has no material.
  bool has_plain_parts() const {
    return model_.num_materials == 0 ||
           std::any_of(model_.instances.begin(), model_.instances.end(),
                       [](const GltfModel::Instance& i) { return !i.material; });
  }

  // Leaves out images that could not be read, and textures without one.
  void check_textures() {
    constexpr std::size_t kNone = SIZE_MAX;
    std::vector<std::size_t> places;  // of images that stay
    Json images = Json::array();
    for (std::size_t i = 0; i < is_carried_.size(); ++i) {
      places.push_back(is_carried_[i] ? images.size() : kNone);
      if (is_carried_[i]) images.push_back(std::move(out_["images"][i]));
    }
    out_.erase("images");
    if (!images.empty()) out_["images"] = std::move(images);
    // True if there is an image.
    const auto renumber = [&](Json& object) {
      const auto source = index_of(object, "source", places.size());
      if (!source || places[*source] == kNone) {
        if (object.is_object()) object.erase("source");
        return false;
      }
      object["source"] = places[*source];
      return true;
    };
    const std::size_t count = out_.contains("textures") ? out_["textures"].size() : 0;
    std::vector<bool> has_image(count, false);
    for (std::size_t t = 0; t < count; ++t) {
      Json& texture = out_["textures"][t];
      has_image[t] = renumber(texture);
      if (!texture.is_object() || !texture.contains("extensions")) continue;
      Json& extensions = texture["extensions"];
      if (!extensions.is_object()) continue;
      for (auto it = extensions.begin(); it != extensions.end();) {
        const bool is_there = !it->is_object() || !it->contains("source") || renumber(*it);
        has_image[t] = has_image[t] || is_there;
        it = is_there ? std::next(it) : extensions.erase(it);
      }
      if (extensions.empty()) texture.erase("extensions");
    }
    std::size_t unknown = 0;
    remove_textures(out_["materials"], [&](const Json& info) {
      const auto texture = index_of(info, "index", count);
      if (!texture) ++unknown;
      return !texture || !has_image[*texture];
    });
    if (unknown > 0) {
      notes_.push_back("materials: left out " + std::to_string(unknown) +
                       (unknown == 1 ? " texture" : " textures") +
                       " that the file does not have (it has " + std::to_string(count) + ")");
    }
  }

  // None: a note says why.
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
    // An image with a URI is read as a buffer.
    std::string why = errors.first().message;
    constexpr std::string_view kBuffer = "buffers[0].uri";
    if (const auto at = why.find(kBuffer); value["uri"].exists() && at != std::string::npos) {
      why.replace(at, kBuffer.size(), place + ".uri");
    }
    notes_.push_back("texture " + place + " is not carried: " + why);
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
  std::vector<bool> is_carried_;  // [image]
  std::vector<std::string> notes_;
  std::vector<std::string> files_;
};

}  // namespace

GltfAsset make_gltf_asset(const nlohmann::json& root, const GltfModel& model, GltfFile& file,
                          bool textures, GltfMemory& memory) {
  return AssetMaker(root, model, file, memory).make(textures);
}

}  // namespace rlpc
