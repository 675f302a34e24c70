// Data of an OBJ file besides positions: texture coordinates, normals and colours, materials,
// objects and groups.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "encoder/meshes/mesh_reader.h"

namespace rlpc {

// Indices as in "f v/vt/vn", from 0 or kNoValue.
struct ObjCorner {
  std::uint32_t vertex = 0;
  std::uint32_t uv = 0;
  std::uint32_t normal = 0;
};

class ObjAttributes {
 public:
  // Returns the memory of everything that was added, besides memory_bytes() of the mesh.
  std::uint64_t memory_bytes() const;

  // Return vectors to add the values of a line to; check each for room before.
  std::vector<float>& uv() { return uv_; }            // [value][2]
  std::vector<float>& normals() { return normals_; }  // [value][3]
  std::int64_t num_uv() const { return static_cast<std::int64_t>(uv_.size() / 2); }
  std::int64_t num_normals() const { return static_cast<std::int64_t>(normals_.size() / 3); }

  // Adds the colour of the vertex with this index; vertices without one are white. False: too
  // much memory.
  bool add_colour(std::size_t vertex, const std::array<float, 3>& colour,
                  const MeshLimit& limit, std::uint64_t other_bytes);
  // Adds the triangle with this index. False: too much memory.
  bool add_triangle(std::size_t triangle, const std::array<ObjCorner, 3>& corners,
                    const MeshLimit& limit, std::uint64_t other_bytes);
  // Set the material, object and group of the triangles that follow.
  void set_material(const std::string& name) { material_ = number_of(name, materials_); }
  void set_object(std::string name);
  void set_group(std::string name);

  // Makes the sets of the mesh, whose positions and triangles are complete. Indices must have
  // been checked. False: too much memory.
  bool finish(SingleMesh& mesh, const MeshLimit& limit);

 private:
  using Numbers = std::map<std::string, std::uint32_t>;
  // Material and part of the triangles from first_triangle on.
  struct Run {
    std::size_t first_triangle = 0;
    std::uint32_t material = 0;
    std::uint32_t part = 0;
  };

  std::uint32_t number_of(const std::string& name, Numbers& numbers);
  std::vector<std::uint32_t> numbers_of(std::uint32_t Run::*what, std::uint32_t if_none,
                                        std::size_t num_triangles) const;

  std::vector<float> uv_;
  std::vector<float> normals_;
  std::vector<float> colours_;            // [vertex][3]; empty before the first
  std::vector<std::uint32_t> uv_of_;      // [corner]; empty before the first uv of a corner
  std::vector<std::uint32_t> normal_of_;  // [corner]; empty before the first normal of a corner
  Numbers materials_;
  Numbers parts_;
  std::uint64_t name_bytes_ = 0;
  std::string object_;
  std::string group_;
  std::optional<std::uint32_t> material_;
  std::optional<std::uint32_t> part_;  // none: to be derived from object and group
  std::vector<Run> runs_;
};

}  // namespace rlpc
