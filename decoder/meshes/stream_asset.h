// The asset of a stream (7.16): materials, textures and names of parts, a GLB without geometry.
// Nothing in it has been checked before.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Members stay in order, and numbers are 32-bit floats, as short as they can be.
using GltfJson = nlohmann::basic_json<nlohmann::ordered_map, std::vector, std::string, bool,
                                      std::int64_t, std::uint64_t, float>;

// Returns an upper bound of the memory that the asset of a stream takes in a file that is
// written: its text as trees and as text again, its images, and the bytes given. Cost: linear
// in them.
std::uint64_t asset_memory_bytes(std::string_view glb);

class StreamAsset {
 public:
  // glb: empty: none. Takes asset_memory_bytes() at most, users included.
  explicit StreamAsset(const std::string& glb);

  // An object, of which the members that are used are arrays; null: none.
  const GltfJson& root() const { return root_; }
  // What of it is not used, and why; empty: all of it is.
  const std::string& problem() const { return problem_; }
  // The name of a material, or of a part (a node); empty: it has none.
  std::string name_of(const char* list, std::uint32_t number) const;
  // The number of the buffer view of an image; none: it has none.
  std::optional<std::uint64_t> view_of(const GltfJson& image) const;
  // The bytes of a view; empty if it is not there.
  std::string view_bytes(std::uint64_t view) const;

 private:
  bool is_good() const;
  // Whether the views of all images are together no larger than the asset: a small stream
  // cannot make large files.
  bool images_fit() const;

  GltfJson root_;
  std::string binary_;
  std::string problem_;
};

}  // namespace rlpc
