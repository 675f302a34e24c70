#include "encoder/meshes/texels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>

#include "common/files/binary_numbers.h"
#include "common/files/glb.h"
#include "common/json/json.h"
#include "encoder/meshes/glb_asset.h"

namespace rlpc {
namespace {

using Json = nlohmann::json;

constexpr double kUnknown = std::numeric_limits<double>::infinity();
constexpr std::size_t kMaxSets = 256;  // fixed: memory

std::uint32_t u16_be(std::string_view bytes, std::size_t at) {
  return static_cast<std::uint32_t>(static_cast<std::uint8_t>(bytes[at]) << 8 |
                                    static_cast<std::uint8_t>(bytes[at + 1]));
}

double longer_side_of_png(std::string_view image) {
  constexpr std::size_t kWidth = 16;  // offset in the IHDR chunk, which comes first
  constexpr std::size_t kHeight = 20;
  if (image.size() < kHeight + 4) return kUnknown;
  return std::max(load_u32_be(image, kWidth), load_u32_be(image, kHeight));
}

// Returns the longer side from the first frame header: marker, length, precision, height,
// width.
double longer_side_of_jpeg(std::string_view image) {
  std::size_t at = 2;
  while (at + 9 <= image.size() && image[at] == '\xFF') {
    const auto marker = static_cast<std::uint8_t>(image[at + 1]);
    const bool is_table = marker == 0xC4 || marker == 0xC8 || marker == 0xCC;
    if (marker >= 0xC0 && marker <= 0xCF && !is_table) {
      return std::max(u16_be(image, at + 5), u16_be(image, at + 7));
    }
    at += marker == 0xFF ? 1 : 2 + u16_be(image, at + 2);
  }
  return kUnknown;
}

double longer_side(std::string_view image) {
  const std::string type = type_of_image(image);
  if (type == "image/png") return longer_side_of_png(image);
  return type == "image/jpeg" ? longer_side_of_jpeg(image) : kUnknown;
}

// Returns the element of a list that a member of an object names; null: there is none.
const Json& element(const Json& root, const char* list, const Json& object, const char* name) {
  static const Json kNone;
  if (!root.contains(list) || !root[list].is_array()) return kNone;
  const auto index = index_of(object, name, root[list].size());
  return index ? root[list][*index] : kNone;
}

class TexelFinder {
 public:
  TexelFinder(const Json& root, std::string_view binary) : root_(root), binary_(binary) {}

  // Finds members whose names end in "Texture": they name a texture and the set that addresses
  // it.
  void find(const Json& value) {
    if (!value.is_structured()) return;
    for (const auto& [name, member] : value.items()) {
      if (value.is_object() && name.ends_with("Texture")) add(member);
      find(member);
    }
  }
  std::vector<UvUse> uses;

 private:
  void add(const Json& info) {
    std::size_t set = index_of(info, "texCoord", SIZE_MAX).value_or(0);
    double scale = 1.0;
    if (info.is_object() && info.contains("extensions")) {
      const Json& extensions = info["extensions"];
      if (extensions.is_object() && extensions.contains("KHR_texture_transform")) {
        const Json& transform = extensions["KHR_texture_transform"];
        set = index_of(transform, "texCoord", SIZE_MAX).value_or(set);
        scale = scale_of(transform);
      }
    }
    if (set >= kMaxSets) return;
    if (uses.size() <= set) uses.resize(set + 1);
    UvUse& use = uses[set];
    use.texels =
        std::max(use.texels, scale * side_of(element(root_, "textures", info, "index")));
    use.scale = std::max(use.scale, scale);
  }

  static double scale_of(const Json& transform) {
    double largest = 1.0;
    if (!transform.is_object() || !transform.contains("scale")) return largest;
    for (const Json& scale : transform["scale"]) {
      if (scale.is_number()) largest = std::max(largest, std::abs(scale.get<double>()));
    }
    return largest;
  }

  double side_of(const Json& texture) const {
    // Extensions can name another image.
    if (!texture.is_object() || texture.contains("extensions")) return kUnknown;
    const Json& image = element(root_, "images", texture, "source");
    const Json& view = element(root_, "bufferViews", image, "bufferView");
    const std::size_t offset = index_of(view, "byteOffset", binary_.size()).value_or(0);
    const std::size_t size = index_of(view, "byteLength", binary_.size() + 1).value_or(0);
    if (offset > binary_.size() || size > binary_.size() - offset) return kUnknown;
    return longer_side(binary_.substr(offset, size));
  }

  const Json& root_;
  std::string_view binary_;
};

}  // namespace

std::vector<UvUse> uses_of_uv(std::string_view asset, std::uint64_t max_memory_bytes) {
  const auto glb = view_glb(asset);
  if (!glb) return {};
  JsonProblem ignored;
  const auto root = read_json<Json>(glb->json, max_memory_bytes, ignored);
  if (!root || !root->is_object() || !root->contains("materials")) return {};
  TexelFinder finder(*root, glb->binary);
  finder.find((*root)["materials"]);
  return finder.uses;
}

}  // namespace rlpc
