#include "decoder/meshes/stream_asset.h"

#include <algorithm>
#include <set>
#include <utility>

#include "common/files/glb.h"
#include "common/files/messages.h"
#include "common/json/json.h"
#include "decoder/meshes/asset_repair.h"

namespace rlpc {
namespace {

std::uint64_t number_in(const GltfJson& object, const char* key) {
  const bool is_number =
      object.is_object() && object.contains(key) && object[key].is_number_unsigned();
  return is_number ? object[key].get<std::uint64_t>() : 0;
}

}  // namespace

std::uint64_t asset_memory_bytes(std::string_view glb) {
  constexpr std::uint64_t kTrees = 2;   // input and output
  constexpr std::uint64_t kCopies = 5;  // copies of images on their way to files
  const auto view = view_glb(glb);
  JsonShape shape;
  if (!view || measure_json(view->json, shape)) return kCopies * glb.size();
  return kTrees * json_tree_bytes(shape, view->json.size()) + kCopies * glb.size();
}

StreamAsset::StreamAsset(const std::string& glb) {
  if (glb.empty()) return;
  problem_ = "the stream's materials are not a GLB; they are left out";
  const auto view = view_glb(glb);
  if (!view) return;
  JsonProblem problem;
  auto root = read_json<GltfJson>(view->json, UINT64_MAX, problem);
  if (!root) {
    problem_ =
        "the stream's materials are left out, as their JSON cannot be read: " + problem.message;
    return;
  }
  root_ = *std::move(root);
  binary_ = view->binary;
  const bool good = is_good();
  if (good) problem_ = "images of the stream's materials overlap; they are left out";
  if (!good || !images_fit()) {
    root_ = nullptr;
    return;
  }
  problem_.clear();
  std::string places;
  for (const std::string& place : repair_asset(root_)) {
    places += (places.empty() ? "" : ", ") + printable(place);
  }
  if (!places.empty()) {
    problem_ = "parts of the stream's materials are broken and left out: " + places;
  }
}

bool StreamAsset::is_good() const {
  if (!root_.is_object()) return false;
  constexpr const char* kArrays[] = {"materials",      "textures",          "samplers",
                                     "images",         "bufferViews",       "nodes",
                                     "extensionsUsed", "extensionsRequired"};
  return std::all_of(std::begin(kArrays), std::end(kArrays), [&](const char* key) {
    return !root_.contains(key) || root_[key].is_array();
  });
}

std::string StreamAsset::name_of(const char* list, std::uint32_t number) const {
  if (!root_.is_object() || !root_.contains(list) || number >= root_[list].size()) return "";
  const GltfJson& one = root_[list][number];
  const bool has_name = one.is_object() && one.contains("name") && one["name"].is_string();
  return has_name ? one["name"].get<std::string>() : "";
}

std::optional<std::uint64_t> StreamAsset::view_of(const GltfJson& image) const {
  if (!image.is_object() || !image.contains("bufferView")) return std::nullopt;
  const GltfJson& view = image["bufferView"];
  if (!view.is_number_unsigned() || !root_.contains("bufferViews")) return std::nullopt;
  const auto number = view.get<std::uint64_t>();
  return number < root_["bufferViews"].size() ? std::optional(number) : std::nullopt;
}

std::string StreamAsset::view_bytes(std::uint64_t view) const {
  const GltfJson& found = root_["bufferViews"][view];
  const std::uint64_t offset = number_in(found, "byteOffset");
  const std::uint64_t size = number_in(found, "byteLength");
  if (offset > binary_.size() || size > binary_.size() - offset) return "";
  return binary_.substr(offset, size);
}

bool StreamAsset::images_fit() const {
  if (!root_.is_object() || !root_.contains("images")) return true;
  std::set<std::uint64_t> views;
  std::uint64_t sum = 0;
  for (const GltfJson& image : root_["images"]) {
    const auto view = view_of(image);
    if (!view || !views.insert(*view).second) continue;
    sum += std::min<std::uint64_t>(number_in(root_["bufferViews"][*view], "byteLength"),
                                   binary_.size());
    if (sum > binary_.size()) return false;
  }
  return true;
}

}  // namespace rlpc
