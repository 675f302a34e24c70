// Counts the memory of a glTF document before it is allocated.
#pragma once

#include <cstdint>
#include <string>

#include "encoder/meshes/gltf/document/json.h"
#include "encoder/meshes/input_file.h"

namespace rlpc {

class GltfMemory {
 public:
  GltfMemory(std::uint64_t max_bytes, GltfErrors& errors)
      : max_bytes_(max_bytes), errors_(errors) {}

  // Counts the bytes. Returns false, with an error that names the place, if they would exceed
  // the limit.
  bool take(const std::string& place, std::uint64_t bytes) {
    if (bytes <= max_bytes_ - taken_) {
      taken_ += bytes;
      return true;
    }
    errors_.add(place, memory_problem(max_bytes_));
    return false;
  }
  void give_back(std::uint64_t bytes) { taken_ -= bytes; }
  std::uint64_t taken() const { return taken_; }

 private:
  std::uint64_t max_bytes_;
  std::uint64_t taken_ = 0;
  GltfErrors& errors_;
};

}  // namespace rlpc
