// Properties of PLY files that are attributes.
//
// Vertices: nx ny nz; s t, u v or texture_u texture_v; red green blue, perhaps with alpha.
// Faces: the list texcoord with u and v of each corner, material_index or texnumber, and red
// green blue if vertices have none.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "encoder/meshes/mesh_reader.h"
#include "encoder/meshes/ply/ply_header.h"

namespace rlpc {

// Purpose of a property.
struct PlyRole {
  enum class Kind : std::uint8_t {
    kSkipped,
    kPosition,
    kNormal,
    kUv,
    kColour,
    kPolygon,
    kCornerUv,  // a list
    kFaceColour,
    kMaterial,  // an integer
  };
  Kind kind = Kind::kSkipped;
  std::size_t component = 0;
  float unit = 1.0F;  // colours: the number that means 1

  bool is_list() const { return kind == Kind::kPolygon || kind == Kind::kCornerUv; }
};

class PlyAttributes {
 public:
  // Finds the role of each property of `vertex` and `face`. Without with_attributes: only
  // positions and polygons.
  void find_roles(const PlyHeader& header, bool with_attributes);
  const std::vector<PlyRole>& vertex_roles() const { return vertex_roles_; }
  const std::vector<PlyRole>& face_roles() const { return face_roles_; }

  // Returns properties and elements without a role, by name: "stress of vertex"; empty: none.
  // Call it after find_roles() with attributes.
  std::string without_role(const PlyHeader& header) const;

  // Returns the number of floats that a vertex needs besides its position.
  std::size_t floats_per_vertex() const;
  void set_num_vertices(std::size_t count);
  void set_of_vertex(std::size_t vertex, const PlyRole& role, float value);
  // Set values of the face that is being read.
  void set_of_face(const PlyRole& role, float value);
  void set_material(std::int64_t number) { material_ = number; }
  std::vector<float>& corner_uv() { return face_uv_; }

  // Ends the face, which has become a fan of so many triangles. Returns a problem, if there is
  // one.
  std::optional<std::string> end_face(std::size_t num_triangles, const SingleMesh& mesh,
                                      const MeshLimit& limit);
  // Makes the sets of the mesh, whose positions and triangles are complete. False: too much
  // memory.
  bool finish(SingleMesh& mesh, const MeshLimit& limit);

 private:
  std::uint64_t memory_bytes() const;

  std::vector<PlyRole> vertex_roles_;
  std::vector<PlyRole> face_roles_;
  std::size_t colour_width_ = 0;  // 3 or 4; 0: none
  std::size_t face_colour_width_ = 0;
  bool are_bytes_ = false;            // colours are bytes
  std::vector<float> normals_;        // [vertex][3], or empty
  std::vector<float> uv_;             // [vertex][2], or [corner of a face][2], or empty
  std::vector<float> colours_;        // [vertex][colour_width_] or [face][face_colour_width_]
  std::vector<std::uint32_t> uv_of_;  // [corner]; empty: uv_ is by vertex
  std::vector<std::uint32_t> colour_of_;  // [corner]; empty: colours_ is by vertex
  std::vector<std::uint32_t> materials_;  // [triangle]; empty: none
  bool has_corner_uv_ = false;
  bool has_bad_uv_ = false;  // a list has another length
  bool has_materials_ = false;
  bool are_materials_bad_ = false;
  // Values of the current face.
  std::vector<float> face_uv_;
  std::array<float, 4> face_colour_{};
  std::int64_t material_ = 0;
};

}  // namespace rlpc
