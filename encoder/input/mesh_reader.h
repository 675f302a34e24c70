// Reads one mesh from one file: a frame of a sequence, or the mesh of a point cache.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/input/frame_source.h"

namespace rlpc {

struct SingleMesh {
  std::vector<float> xyz;               // 3 per vertex, at least one vertex, all finite
  std::vector<Triangle> triangles;      // polygons as fans from their first corner
  std::optional<FrameRate> frame_rate;  // of a comment "frame_rate N/D" in the file
};

// Memory limits of a mesh, in addition to the text that it is read from.
struct MeshLimit {
  std::uint64_t of_all = kUsualEncoderBytes;  // for messages
  std::uint64_t of_mesh = kUsualEncoderBytes;

  // Whether a vector of the mesh may grow by one element: growing takes three times its memory.
  template <class T>
  bool leaves_room(const SingleMesh& mesh, const std::vector<T>& grows) const {
    if (grows.size() < grows.capacity()) return true;
    const auto bytes = [](const auto& all) {
      return std::uint64_t{all.capacity()} * sizeof(all[0]);
    };
    return bytes(mesh.xyz) + bytes(mesh.triangles) + 2 * bytes(grows) <= of_mesh;
  }
};

// Whether the extension of a path is that of a mesh format.
bool is_mesh_extension(const std::string& path);

// Reads a mesh in the format given by the extension, otherwise by the contents. Errors: a bad
// file; more than max_memory_bytes for the file and its mesh.
InputResult<SingleMesh> read_mesh(const std::string& path,
                                  std::uint64_t max_memory_bytes = kUsualEncoderBytes);

// The shape of a source with the triangles of `mesh`. The frame rate is `frame_rate` if given,
// otherwise that of the mesh, otherwise `usual`.
FrameSource::Shape shape_of(SingleMesh mesh, std::uint32_t num_frames,
                            const std::optional<FrameRate>& frame_rate,
                            const FrameRate& usual = {});

// The extension of `path` in lower case: ".obj" for "a/B.OBJ".
std::string lower_extension(const std::string& path);

}  // namespace rlpc
