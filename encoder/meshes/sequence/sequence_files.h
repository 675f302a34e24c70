// The files of a sequence of meshes, each read with the faces of the first.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/polygon_cuts.h"

namespace rlpc {

// Faces and materials of the first file of a sequence.
struct FirstMesh {
  std::vector<MeshPolygon> polygons;
  PolygonCuts cuts;
  std::string material_library;
};

class SequenceFiles {
 public:
  // triangles, num_vertices: those of the first file; the triangles must outlive the object.
  SequenceFiles(std::vector<std::string> paths, FirstMesh first,
                std::span<const Triangle> triangles, std::uint32_t num_vertices,
                std::uint64_t max_memory_bytes)
      : paths_(std::move(paths)),
        first_(std::move(first)),
        triangles_(triangles),
        num_vertices_(num_vertices),
        max_memory_bytes_(max_memory_bytes) {}

  std::size_t count() const { return paths_.size(); }
  const std::string& path(std::uint32_t frame) const { return paths_[frame]; }
  const FirstMesh& first() const { return first_; }
  std::span<const Triangle> triangles() const { return triangles_; }
  std::uint64_t max_memory_bytes() const { return max_memory_bytes_; }

  // Reads the mesh of a frame; its attributes, if wanted, are those of triangles(). Errors: a
  // bad file, or one with other vertices or faces than the first; too little memory.
  InputResult<SingleMesh> read(std::uint32_t frame, bool with_attributes) const;

 private:
  InputError differs(std::uint32_t frame, const std::string& how) const;
  std::optional<InputError> fit_to_first(std::uint32_t frame, SingleMesh& mesh) const;
  bool has_triangles_of_first(const std::vector<Triangle>& fans) const;
  std::optional<InputError> match_with_first(std::uint32_t frame, SingleMesh& mesh) const;

  std::vector<std::string> paths_;
  FirstMesh first_;
  std::span<const Triangle> triangles_;
  std::uint32_t num_vertices_;
  std::uint64_t max_memory_bytes_;
};

}  // namespace rlpc
