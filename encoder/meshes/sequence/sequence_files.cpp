#include "encoder/meshes/sequence/sequence_files.h"

#include <algorithm>
#include <utility>
#include <variant>

#include "encoder/meshes/input_file.h"
#include "encoder/meshes/sequence/face_match.h"

namespace rlpc {
namespace {

// Moves the sets of a mesh to the corners of another: corner_of[c] is the one that was c.
void move_corners(const std::vector<std::uint32_t>& corner_of, SourceAttributes& attributes) {
  for (SourceAttribute& set : attributes.sets) {
    if (set.domain == AttributeDomain::kTriangle) {
      const std::vector<float> before = set.values;
      const std::size_t n = set.num_components;
      for (std::size_t i = 0; i < before.size(); ++i) {
        set.values[i] = before[n * (corner_of[3 * (i / n)] / 3) + i % n];
      }
    } else if (!set.value_of_corner.empty()) {
      const std::vector<std::uint32_t> before = set.value_of_corner;
      for (std::size_t c = 0; c < before.size(); ++c) {
        set.value_of_corner[c] = before[corner_of[c]];
      }
    }
  }
}

// Returns the corners of a face, counted from 1, as in OBJ files.
std::string corners(const std::vector<std::uint32_t>& vertices) {
  constexpr std::size_t kMax = 8;
  std::string text = "f";
  for (std::size_t k = 0; k < std::min(kMax, vertices.size()); ++k) {
    text += " " + std::to_string(std::uint64_t{vertices[k]} + 1);
  }
  return text + (vertices.size() > kMax ? " ..." : "");
}

}  // namespace

InputResult<SingleMesh> SequenceFiles::read(std::uint32_t frame, bool with_attributes) const {
  auto mesh = read_mesh(paths_[frame], max_memory_bytes_, with_attributes, false);
  if (!mesh) return mesh;
  if (auto error = fit_to_first(frame, *mesh)) return *error;
  return mesh;
}

InputError SequenceFiles::differs(std::uint32_t frame, const std::string& how) const {
  return {paths_[frame] + ": frame " + std::to_string(frame) + " (from 0) has " + how +
          "; every frame must have the vertices and faces of the first"};
}

// Gives the mesh of a frame, whose polygons are fans, the triangles of the first, in their
// order.
std::optional<InputError> SequenceFiles::fit_to_first(std::uint32_t frame,
                                                      SingleMesh& mesh) const {
  const auto counts_differ = [&](std::size_t here, std::size_t there, const char* what) {
    return differs(frame, std::to_string(here) + " " + what + ", but " + paths_[0] + " has " +
                              std::to_string(there));
  };
  if (mesh.xyz.size() / 3 != num_vertices_) {
    return counts_differ(mesh.xyz.size() / 3, num_vertices_, "vertices");
  }
  if (mesh.triangles.size() != triangles_.size()) {
    return counts_differ(mesh.triangles.size(), triangles_.size(), "triangles");
  }
  if (has_triangles_of_first(mesh.triangles)) {
    for (SourceAttribute& set : mesh.attributes.sets) first_.cuts.apply(set.value_of_corner);
    return std::nullopt;
  }
  if (2 * kMatchBytes * triangles_.size() > max_memory_bytes_) {
    return InputError{paths_[frame] + ": has faces in another order than " + paths_[0] +
                      ", and " + memory_problem(max_memory_bytes_)};
  }
  return match_with_first(frame, mesh);
}

bool SequenceFiles::has_triangles_of_first(const std::vector<Triangle>& fans) const {
  if (first_.cuts.empty()) return std::ranges::equal(fans, triangles_);
  std::vector<Triangle> cut = fans;
  first_.cuts.apply(cut);
  return std::ranges::equal(cut, triangles_);
}

std::optional<InputError> SequenceFiles::match_with_first(std::uint32_t frame,
                                                          SingleMesh& mesh) const {
  std::vector<Triangle> fans(triangles_.begin(), triangles_.end());
  first_.cuts.undo(fans);
  auto matched = match_faces({fans, first_.polygons}, {mesh.triangles, mesh.polygons});
  if (auto* const corner_of = std::get_if<std::vector<std::uint32_t>>(&matched)) {
    first_.cuts.apply(*corner_of);
    move_corners(*corner_of, mesh.attributes);
    return std::nullopt;
  }
  // One of the meshes may have been split into triangles.
  const auto split = match_faces({triangles_, {}}, {mesh.triangles, {}});
  if (const auto* const corner_of = std::get_if<std::vector<std::uint32_t>>(&split)) {
    move_corners(*corner_of, mesh.attributes);
    return std::nullopt;
  }
  const OddFace& odd = std::get<OddFace>(matched);
  return differs(frame, odd.is_of_first ? "no face " + corners(odd.vertices) + ", but " +
                                              paths_[0] + " has it"
                                        : "the face " + corners(odd.vertices) + ", but " +
                                              paths_[0] + " has no such face");
}

}  // namespace rlpc
