#include "encoder/meshes/gltf/asset.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "encoder/meshes/glb_asset.h"
#include "encoder/meshes/gltf/equal_uv.h"

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

// Finds the names of extensions that occur in the document.
void find_extensions(const Json& value, std::set<std::string>& found) {
  if (!value.is_structured()) return;
  if (value.is_object() && value.contains("extensions") && value["extensions"].is_object()) {
    for (const auto& [name, unused] : value["extensions"].items()) found.insert(name);
  }
  for (const Json& member : value) find_extensions(member, found);
}

class AssetMaker {
 public:
  AssetMaker(const Json& root, const GltfModel& model, GltfFile& file, Images images,
             GltfMemory& memory)
      : root_(root), model_(model), file_(file), how_(images), memory_(memory) {}

  GltfAsset make() {
    for (const char* const key : kKept) {
      if (root_.contains(key)) out_[key] = root_[key];
    }
    // Write down the default of glTF: streams without materials get another.
    if (!out_.contains("materials")) out_["materials"] = Json::array();
    if (out_["materials"].size() == model_.num_materials && has_plain_parts()) {
      out_["materials"].push_back(Json::object());
    }
    if (how_ == Images::kNone) {
      for (const char* const key : {"textures", "samplers", "images"}) out_.erase(key);
      remove_textures(out_["materials"], [](const Json&) { return true; });
    } else {
      if (out_.contains("images")) add_images();
      check_textures();
    }
    use_first_uv(model_.equal_uv, out_["materials"]);
    // Keep equal sets for writers of glTF, which restore them.
    if (!model_.equal_uv.empty()) out_["extras"]["equal_uv"] = model_.equal_uv;
    add_parts();
    GltfAsset asset;
    if (!out_.empty()) asset.glb = glb();
    asset.notes = std::move(notes_);
    asset.files.assign(files_.begin(), files_.end());
    return asset;
  }

 private:
  void add_images() {
    Json& images = out_["images"];
    for (std::size_t i = 0; i < images.size(); ++i) {
      Json& image = images[i];
      const Image carried = image_of(i);
      is_carried_.push_back(carried.view.has_value());
      if (!carried.view) {
        notes_.push_back("texture images[" + std::to_string(i) +
                         "] is not carried: " + carried.problem);
        continue;
      }
      image.erase("uri");
      image["bufferView"] = *carried.view;
      if (!image.contains("mimeType")) image["mimeType"] = carried.type;
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
    std::vector<std::size_t> places;  // new places of images that stay
    Json images = Json::array();
    for (std::size_t i = 0; i < is_carried_.size(); ++i) {
      places.push_back(is_carried_[i] ? images.size() : kNone);
      if (is_carried_[i]) images.push_back(std::move(out_["images"][i]));
    }
    out_.erase("images");
    if (!images.empty()) out_["images"] = std::move(images);
    // Returns whether there is an image.
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

  // The bytes of an image: a part of a buffer.
  struct Range {
    std::uint32_t buffer = 0;
    std::uint64_t offset = 0;
    std::optional<std::uint64_t> size;  // none: up to the end
  };

  struct Image {
    std::optional<std::size_t> view;  // view of the asset; none: not carried
    std::string type;                 // "image/png"
    std::string problem;              // why it is not carried
  };

  // Reads the image of a URI or a view once, however many images have it.
  Image image_of(std::size_t number) {
    GltfErrors errors(file_.file.path());
    const GltfValue value = GltfValue(root_, errors)["images"][number];
    const GltfValue uri = value["uri"];
    const std::string text = uri.exists() ? uri.text() : "";
    const std::uint32_t view =
        uri.exists() || errors
            ? 0
            : value["bufferView"].index(GltfValue(root_, errors)["bufferViews"].size(),
                                        "bufferViews");
    if (errors) return {{}, "", errors.first().message};
    const auto [known, is_new] = images_.try_emplace({text, view});
    if (!is_new) return known->second;
    if (uri.exists()) {
      GltfBuffers reader({{0, text}}, file_, errors);
      known->second = carry(reader, {}, value.path(), errors);
    } else if (const auto range = range_of(view, errors)) {
      if (!buffers_) buffers_.emplace(all_buffers(), file_, buffer_errors_);
      known->second = carry(*buffers_, *range, value.path(), buffer_errors_);
    } else {
      known->second.problem = errors.first().message;
    }
    return known->second;
  }

  // Returns the range of an image; none with an error.
  std::optional<Range> range_of(std::uint32_t number, GltfErrors& errors) const {
    const GltfValue root(root_, errors);
    const GltfValue view = root["bufferViews"][number];
    const GltfValue buffers = root["buffers"];
    Range range;
    range.buffer = view["buffer"].index(buffers.size(), "buffers");
    range.offset = view["byteOffset"].integer({0, GltfValue::kMaxInteger}, 0);
    range.size = view["byteLength"].integer({1, GltfValue::kMaxInteger});
    if (errors) return std::nullopt;
    const std::uint64_t size =
        buffers[range.buffer]["byteLength"].integer({1, GltfValue::kMaxInteger});
    if (!errors && range.offset + *range.size > size) view.fail("a view within its buffer");
    return errors ? std::nullopt : std::optional(range);
  }

  std::vector<GltfBuffer> all_buffers() {
    const GltfValue all = GltfValue(root_, buffer_errors_)["buffers"];
    std::vector<GltfBuffer> buffers(all.size());
    for (std::size_t b = 0; b < buffers.size(); ++b) {
      buffers[b].size = all[b]["byteLength"].integer({1, GltfValue::kMaxInteger});
      if (all[b]["uri"].exists()) buffers[b].uri = all[b]["uri"].text();
    }
    return buffers;
  }

  // Adds an image to the asset. Other files are not carried, whatever a document says of them.
  // errors: errors of the reader; cleared.
  Image carry(GltfBuffers& reader, const Range& range, const std::string& place,
              GltfErrors& errors) {
    constexpr std::uint64_t kLongestMagic = 16;
    constexpr std::uint64_t kCopies = 4;  // while the asset is made
    Image image;
    if (reader.available(range.buffer)) {
      const std::uint64_t size = range.size.value_or(reader.size(range.buffer));
      std::string bytes(static_cast<std::size_t>(std::min(size, kLongestMagic)), '\0');
      reader.read(range.buffer, range.offset, bytes);
      image.type = type_of_image(bytes);
      if (!errors && image.type.empty()) {
        image.problem = file_.file.path() + ": " + place +
                        ": the bytes there are no image that glTF knows: PNG, JPEG, WebP, "
                        "KTX2, AVIF or DDS";
        return image;
      }
      if (!errors && memory_.take("images", kCopies * size)) {
        bytes.resize(static_cast<std::size_t>(size));
        reader.read(range.buffer, range.offset, bytes);
        if (!errors && how_ == Images::kSmaller) bytes = smaller_png(std::move(bytes));
        if (!errors) image.view = made_.add_view(bytes);
      }
    }
    if (image.view) {
      for (const std::string& path : reader.files()) files_.insert(path);
    } else if (errors) {
      image.problem = errors.first().message;
      errors = GltfErrors(file_.file.path());
      // An image with a URI is read as a buffer.
      constexpr std::string_view kBuffer = "buffers[0].uri";
      const std::size_t at = image.problem.find(kBuffer);
      if (!range.size && at != std::string::npos) {
        image.problem.replace(at, kBuffer.size(), place + ".uri");
      }
    }
    return image;
  }

  // Adds the names of the nodes that hold the parts, in the order of `part` (Table F-1).
  void add_parts() {
    std::vector<std::uint32_t> nodes;
    std::set<std::uint32_t> known;
    for (const GltfModel::Instance& instance : model_.instances) {
      if (known.insert(instance.node).second) nodes.push_back(instance.node);
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
    std::set<std::string> extensions;
    find_extensions(out_, extensions);
    for (const char* const list : {"extensionsUsed", "extensionsRequired"}) {
      if (!root_.contains(list) || !root_[list].is_array()) continue;
      for (const Json& name : root_[list]) {
        if (name.is_string() && extensions.contains(name.get_ref<const std::string&>())) {
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
  const Images how_;
  GltfMemory& memory_;
  GlbAsset made_;
  Json& out_ = made_.root;
  std::vector<bool> is_carried_;  // [image]
  std::vector<std::string> notes_;
  std::set<std::string> files_;
  std::map<std::pair<std::string, std::uint32_t>, Image> images_;  // [URI, or view]
  GltfErrors buffer_errors_{file_.file.path()};
  std::optional<GltfBuffers> buffers_;  // none before an image needs one
};

}  // namespace

GltfAsset make_gltf_asset(const nlohmann::json& root, const GltfModel& model, GltfFile& file,
                          Images images, GltfMemory& memory) {
  return AssetMaker(root, model, file, images, memory).make();
}

}  // namespace rlpc
