#include "encoder/meshes/sequence/face_match.h"

#include <algorithm>
#include <cstddef>

namespace rlpc {

namespace {

struct Face {
  std::size_t first_triangle = 0;
  std::uint32_t num_corners = 0;
  std::uint32_t turned = 0;  // first corner of the smallest rotation
};

// Returns the first corner of the rotation that is the smallest as a list.
std::uint32_t smallest_rotation(const std::vector<std::uint32_t>& corners) {
  const std::size_t n = corners.size();
  std::size_t a = 0;
  std::size_t b = 1;
  std::size_t same = 0;
  while (a < n && b < n && same < n) {
    const std::uint32_t x = corners[(a + same) % n];
    const std::uint32_t y = corners[(b + same) % n];
    if (x == y) {
      ++same;
      continue;
    }
    (x > y ? a : b) += same + 1;
    if (a == b) ++b;
    same = 0;
  }
  return static_cast<std::uint32_t>(std::min(a, b));
}

// The faces of a mesh, and their order by their vertices.
class SortedFaces {
 public:
  explicit SortedFaces(const FaceList& list) : list_(list) {
    std::size_t next = 0;  // polygon
    for (std::size_t t = 0; t < list.triangles.size();) {
      const bool is_polygon =
          next < list.polygons.size() && list.polygons[next].first_triangle == t;
      const std::uint32_t count = is_polygon ? list.polygons[next++].num_triangles : 1;
      Face face{t, count + 2, 0};
      face.turned = smallest_rotation(corners_of(face));
      faces_.push_back(face);
      t += count;
    }
    for (std::size_t i = 0; i < faces_.size(); ++i) {
      order_.push_back(static_cast<std::uint32_t>(i));
    }
    std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
      const int order = compare(faces_[a], *this, faces_[b]);
      return order != 0 ? order < 0 : a < b;
    });
  }

  std::size_t size() const { return faces_.size(); }
  // Returns the n-th face by its vertices.
  const Face& operator[](std::size_t n) const { return faces_[order_[n]]; }

  // Returns a vertex of a face, counted from the first corner of its smallest rotation.
  std::uint32_t vertex(const Face& face, std::uint32_t corner) const {
    return vertex_at(face, (face.turned + corner) % face.num_corners);
  }
  std::vector<std::uint32_t> corners_of(const Face& face) const {
    std::vector<std::uint32_t> corners;
    for (std::uint32_t k = 0; k < face.num_corners; ++k) corners.push_back(vertex_at(face, k));
    return corners;
  }

  // Compares by number of corners, then by vertices: below 0 if `a`, a face of this mesh, is
  // less.
  int compare(const Face& a, const SortedFaces& others, const Face& b) const {
    if (a.num_corners != b.num_corners) return a.num_corners < b.num_corners ? -1 : 1;
    for (std::uint32_t k = 0; k < a.num_corners; ++k) {
      const std::uint32_t x = vertex(a, k);
      const std::uint32_t y = others.vertex(b, k);
      if (x != y) return x < y ? -1 : 1;
    }
    return 0;
  }

 private:
  std::uint32_t vertex_at(const Face& face, std::uint32_t corner) const {
    const std::uint64_t place = place_in_fan(corner);
    return list_.triangles[face.first_triangle + place / 3][place % 3];
  }

  FaceList list_;
  std::vector<Face> faces_;
  std::vector<std::uint32_t> order_;
};

}  // namespace

std::variant<std::vector<std::uint32_t>, OddFace> match_faces(const FaceList& first,
                                                              const FaceList& other) {
  const SortedFaces a(first);
  const SortedFaces b(other);
  std::vector<std::uint32_t> corner_of(3 * first.triangles.size());
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const int order = i == a.size() ? 1 : i == b.size() ? -1 : a.compare(a[i], b, b[i]);
    if (order < 0) return OddFace{a.corners_of(a[i]), true};
    if (order > 0) return OddFace{b.corners_of(b[i]), false};
    const Face& x = a[i];
    const Face& y = b[i];
    const std::uint32_t n = x.num_corners;
    for (std::uint32_t t = 0; t + 2 < n; ++t) {
      const std::array<std::uint32_t, 3> fan{0, t + 1, t + 2};
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t corner = (fan[k] + n - x.turned + y.turned) % n;
        corner_of[3 * (x.first_triangle + t) + k] =
            static_cast<std::uint32_t>(3 * y.first_triangle + place_in_fan(corner));
      }
    }
  }
  return corner_of;
}

}  // namespace rlpc
