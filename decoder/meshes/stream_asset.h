// Asset of a stream (7.16): materials, textures and names of parts, a GLB without geometry. Its
// contents are untrusted.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// JSON whose members keep their order, and whose numbers are 32-bit floats, written as short as
// possible.
using GltfJson = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                      std::int64_t, std::uint64_t, float>;

// Returns an upper bound of the memory that an asset takes while a file with it is written: its
// JSON as trees and as text again, its images, and `glb`. Cost: linear in `glb`.
std::uint64_t asset_memory_bytes(std::string_view glb);

class StreamAsset {
 public:
  // glb: may be empty. Takes asset_memory_bytes() at most, users included.
  explicit StreamAsset(const std::string& glb);

  // Returns an object whose used members are arrays; null without an asset.
  const GltfJson& root() const { return root_; }
  // Returns a message on the parts that are not used, and why; empty if all are.
  const std::string& problem() const { return problem_; }
  // Returns the name of a material, or of a part (a node); empty if it has none.
  std::string name_of(const char* list, std::uint32_t number) const;
  // Returns the number of the buffer view of an image; none if it has none.
  std::optional<std::uint64_t> view_of(const GltfJson& image) const;
  // Returns the bytes of a view; empty if it does not exist.
  std::string view_bytes(std::uint64_t view) const;

 private:
  bool is_good() const;
  // Returns whether the views of all images together are no larger than the asset, so that a
  // small stream cannot make large files.
  bool images_fit() const;

  GltfJson root_;
  std::string binary_;
  std::string problem_;
};

}  // namespace rlpc
