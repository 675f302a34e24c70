#include "decoder/meshes/asset_repair.h"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace rlpc {
namespace {

class AssetRepair {
 public:
  explicit AssetRepair(GltfJson& root) : root_(root) {}

  std::vector<std::string> repair() {
    for (const char* const list : {"materials", "textures", "samplers", "images", "nodes"}) {
      if (root_.contains(list)) repair_objects(list);
    }
    if (root_.contains("textures")) {
      for (std::size_t i = 0; i < root_["textures"].size(); ++i) {
        const std::string place = "textures[" + std::to_string(i) + "]";
        GltfJson& texture = root_["textures"][i];
        drop_reference(texture, "source", "images", place);
        drop_reference(texture, "sampler", "samplers", place);
      }
    }
    if (root_.contains("materials")) {
      for (std::size_t i = 0; i < root_["materials"].size(); ++i) {
        repair_material(root_["materials"][i], "materials[" + std::to_string(i) + "]");
      }
    }
    return std::move(broken_);
  }

 private:
  void tell(const std::string& place) {
    constexpr std::size_t kMaxTold = 5;
    if (broken_.size() < kMaxTold) broken_.push_back(place);
  }

  void repair_objects(const char* list) {
    for (std::size_t i = 0; i < root_[list].size(); ++i) {
      GltfJson& one = root_[list][i];
      if (one.is_object()) continue;
      one = GltfJson::object();
      tell(std::string(list) + "[" + std::to_string(i) + "]");
    }
  }

  bool is_index(const GltfJson& value, const char* list) const {
    return value.is_number_unsigned() && root_.contains(list) &&
           value.get<std::uint64_t>() < root_[list].size();
  }

  void drop_reference(GltfJson& object, const char* key, const char* list,
                      const std::string& place) {
    if (!object.contains(key) || is_index(object[key], list)) return;
    object.erase(key);
    tell(place + "." + key);
  }

  // Removes references to missing textures, in members whose names end in "Texture", anywhere
  // in a material. Nesting is limited where the text is read.
  void repair_material(GltfJson& value, const std::string& place) {
    if (!value.is_object()) return;
    std::vector<std::string> broken;
    for (auto& [key, member] : value.items()) {
      if (key == "extras") continue;
      if (key.ends_with("Texture") && !(member.is_object() && member.contains("index") &&
                                        is_index(member["index"], "textures"))) {
        broken.push_back(key);
      } else {
        repair_material(member, place + "." + key);
      }
    }
    for (const std::string& key : broken) {
      value.erase(key);
      tell(place + "." + key);
    }
  }

  GltfJson& root_;
  std::vector<std::string> broken_;
};

}  // namespace

std::vector<std::string> repair_asset(GltfJson& root) { return AssetRepair(root).repair(); }

}  // namespace rlpc
