// A GLB without geometry in the making: the asset of a stream (7.16).
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace rlpc {

class GlbAsset {
 public:
  // The document without asset, bufferViews and buffers.
  nlohmann::json root = nlohmann::json::object();

  // Adds bytes to the binary chunk; returns the number of their view.
  std::size_t add_view(const std::string& bytes);
  std::size_t binary_bytes() const { return binary_.size(); }
  // Returns the whole file; `asset` has at least a version.
  std::string glb(nlohmann::json asset);

 private:
  nlohmann::json views_ = nlohmann::json::array();
  std::string binary_;
};

// Returns "image/png" or another type of glTF and its extensions, by the first bytes; empty:
// another type.
std::string type_of_image(std::string_view bytes);

// Returns a member of an object that is a whole number below a limit; none: it is missing, or
// anything else.
std::optional<std::size_t> index_of(const nlohmann::json& object, const char* name,
                                    std::size_t limit);

}  // namespace rlpc
