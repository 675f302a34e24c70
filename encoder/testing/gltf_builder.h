// Builds small glTF documents for tests.
#pragma once

#include <bit>
#include <cstdint>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <type_traits>
#include <vector>

#include "common/files/glb.h"
#include "common/json/json.h"

namespace rlpc {

// The document is `json`, which tests may modify freely; its only buffer is `bytes`.
class GltfBuilder {
 public:
  GltfBuilder() {
    json = {{"asset", {{"version", "2.0"}}},
            {"scene", 0},
            {"scenes", {{{"nodes", nlohmann::json::array()}}}}};
  }

  // Adds a buffer view and an accessor of type "VEC3" or another; T is the component type.
  template <class T>
  std::size_t add(const char* type, const std::vector<T>& values) {
    json["accessors"].push_back({{"bufferView", add_view(values)},
                                 {"componentType", component<T>()},
                                 {"count", values.size() / width(type)},
                                 {"type", type}});
    return json["accessors"].size() - 1;
  }
  // Does the same for small integers that represent -1 to 1, or 0 to 1.
  template <class T>
  std::size_t add_normalized(const char* type, const std::vector<T>& values) {
    const std::size_t accessor = add(type, values);
    json["accessors"][accessor]["normalized"] = true;
    return accessor;
  }
  template <class T>
  std::size_t add_view(const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const std::size_t offset = bytes.size();
    for (const T& value : values) put(value);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size() - offset}});
    return json["bufferViews"].size() - 1;
  }

  // Add an element and return its index.
  std::size_t add_mesh(const nlohmann::json& primitive) {
    return push("meshes", {{"primitives", {primitive}}});
  }
  std::size_t add_root(const nlohmann::json& node) {
    const std::size_t index = push("nodes", node);
    json["scenes"][0]["nodes"].push_back(index);
    return index;
  }
  std::size_t push(const char* array, const nlohmann::json& element) {
    json[array].push_back(element);
    return json[array].size() - 1;
  }
  // Adds a channel, with its own sampler, to the last animation.
  void add_channel(std::size_t node, const char* path, std::size_t input, std::size_t output,
                   const char* interpolation) {
    nlohmann::json& animation = json["animations"].back();
    animation["samplers"].push_back(
        {{"input", input}, {"output", output}, {"interpolation", interpolation}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", node}, {"path", path}}}});
  }

  std::string glb() const {
    const std::string data = padded(bytes, '\0');
    return glb_head(json_text(with_buffer()), data.size()) + data;
  }
  // Returns the document with its buffer in a separate file.
  std::string gltf(const std::string& uri) const {
    nlohmann::json whole = with_buffer();
    whole["buffers"][0]["uri"] = uri;
    return json_text(whole);
  }

  nlohmann::json json;
  std::string bytes;

 private:
  static std::string padded(std::string text, char with) {
    text.resize((text.size() + 3) / 4 * 4, with);
    return text;
  }
  static std::size_t width(const std::string& type) {
    if (type == "SCALAR") return 1;
    return type == "MAT4" ? 16 : static_cast<std::size_t>(type.back() - '0');
  }
  template <class T>
  static int component() {
    if (std::is_same_v<T, float>) return 5126;
    if (sizeof(T) == 4) return 5125;
    return 5120 + (std::is_signed_v<T> ? 0 : 1) + (sizeof(T) == 2 ? 2 : 0);
  }
  void put(float value) { put(std::bit_cast<std::uint32_t>(value)); }
  template <class T>
  void put(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) {
      bytes += static_cast<char>(static_cast<std::uint32_t>(value) >> (8 * i) & 0xFF);
    }
  }
  nlohmann::json with_buffer() const {
    nlohmann::json whole = json;
    if (!bytes.empty() && !whole.contains("buffers")) {
      whole["buffers"] = {{{"byteLength", bytes.size()}}};
    }
    return whole;
  }
};

}  // namespace rlpc
