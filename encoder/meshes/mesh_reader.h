// Reads one mesh from one file: a frame of a sequence, or the mesh of a point cache.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/frame_source.h"
#include "encoder/meshes/polygon_cuts.h"

namespace rlpc {

struct SingleMesh {
  std::vector<float> xyz;  // 3 per vertex, at least one vertex, all finite
  // Differences of the numbers in the file from the floats in xyz; 0 beyond its size.
  std::vector<double> left{};
  std::vector<Triangle> triangles;
  std::vector<MeshPolygon> polygons{};  // only those of more than one triangle, in order
  PolygonCuts cuts{};                   // polygons whose triangles are not a fan
  std::optional<FrameRate> frame_rate;  // comment "frame_rate N/D" in the file
  SourceAttributes attributes{};
  SourceMaterials materials{};
  std::string asset{};                        // see FrameSource::asset()
  std::string material_library{};             // .mtl files as an OBJ file names them, by line
  std::vector<std::string> material_files{};  // files that have been read, and their images
  std::vector<std::string> notes{};           // about dropped data

  // Returns the memory of members that grow while a file is read.
  std::uint64_t memory_bytes() const {
    return std::uint64_t{xyz.capacity()} * sizeof(float) +
           std::uint64_t{left.capacity()} * sizeof(double) +
           std::uint64_t{triangles.capacity()} * sizeof(Triangle) +
           std::uint64_t{polygons.capacity()} * sizeof(MeshPolygon) + cuts.memory_bytes() +
           attributes.memory_bytes();
  }
};

// Parts of a mesh to read, and its memory limits, in addition to the text that it is read from.
struct MeshLimit {
  std::uint64_t total_bytes = kUsualEncoderBytes;  // for messages
  std::uint64_t mesh_bytes = kUsualEncoderBytes;
  bool with_attributes = true;  // otherwise they are skipped, not checked
  bool cuts_polygons = true;    // otherwise all are fans from their first corner

  // Whether a vector may grow by one element: growing takes three times its memory. holds: has
  // memory_bytes(), which include the vector.
  template <class Holder, class T>
  bool leaves_room(const Holder& holds, const std::vector<T>& grows) const {
    if (grows.size() < grows.capacity()) return true;
    return holds.memory_bytes() + 2 * std::uint64_t{grows.capacity()} * sizeof(T) <= mesh_bytes;
  }
  // Adds the last triangles of a mesh, from `first` on, as one face. Returns false if that
  // takes too much memory.
  bool add_face(SingleMesh& mesh, std::size_t first) const {
    const std::size_t count = mesh.triangles.size() - first;
    if (count < 2) return true;
    if (!leaves_room(mesh, mesh.polygons)) return false;
    mesh.polygons.push_back({first, static_cast<std::uint32_t>(count)});
    return true;
  }
  // Whether `bytes` more bytes may be held.
  template <class Holder>
  bool leaves_room_for(const Holder& holds, std::uint64_t bytes) const {
    return holds.memory_bytes() + bytes <= mesh_bytes;
  }
};

// Whether the extension of a path is that of a mesh format.
bool is_mesh_extension(const std::string& path);

// Reads a mesh in the format given by the extension, otherwise by the contents. Errors: a bad
// file; more than max_memory_bytes for the file and its mesh.
InputResult<SingleMesh> read_mesh(const std::string& path,
                                  std::uint64_t max_memory_bytes = kUsualEncoderBytes,
                                  bool with_attributes = true, bool cuts_polygons = true);

// Returns the shape of a source with triangles, attributes and notes of `mesh`. The frame rate
// is `frame_rate` if given, otherwise that of the mesh, otherwise `usual`.
FrameSource::Shape shape_of(SingleMesh mesh, std::uint32_t num_frames,
                            const std::optional<FrameRate>& frame_rate,
                            const FrameRate& usual = {});

// Returns the extension of `path` in lower case: ".obj" for "a/B.OBJ".
std::string lower_extension(const std::string& path);

}  // namespace rlpc
