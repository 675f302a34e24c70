#include "encoder/codec/attributes/smoothing_search.h"

#include <algorithm>
#include <utility>

#include "common/codec/mesh/corners.h"
#include "common/codec/mesh/indices.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

constexpr double kFlagBits = 5.0;  // tuned: Bits of a flag that is rarely set.
constexpr int kMaxPasses = 4;      // fixed: few flags change after the third

// Faces whose diagonals can be changed one by one.
class ChangingFaces {
 public:
  ChangingFaces(const SmoothingMesh& mesh, SmoothingWeight weight,
                std::span<const std::array<std::uint32_t, 2>> wanted, std::uint32_t value_bits)
      : mesh_(mesh), weight_(weight), wanted_(wanted), value_bits_(value_bits) {
    const std::size_t num_triangles = mesh.edge_mates.size() / 3;
    is_diagonal_.assign(mesh.edge_mates.size(), false);
    face_of_.resize(num_triangles);
    triangle_normals_.resize(num_triangles);
    normals_.resize(num_triangles);
    for (std::uint32_t t = 0; t < num_triangles; ++t) {
      triangle_normals_[t] = mesh.geometry.triangle_normal(t);
      face_of_[t] = t;
      normals_[t] = triangle_normals_[t];
    }
  }

  const std::vector<bool>& diagonals() const { return is_diagonal_; }
  // Changes edge c. Returns false if the face would become too large.
  bool turn(std::uint32_t c) {
    const std::uint32_t mate = mesh_.edge_mates[c];
    is_diagonal_[c] = is_diagonal_[mate] = !is_diagonal_[c];
    const std::vector<std::uint32_t> face = face_at(c / 3);
    if (face.size() > kMaxFaceTriangles) {
      is_diagonal_[c] = is_diagonal_[mate] = false;
      return false;
    }
    keep(face);
    if (!is_diagonal_[c]) keep(face_at(mate / 3));
    return true;
  }
  // Returns the triangles of the faces on both sides of edge c.
  std::vector<std::uint32_t> triangles_around(std::uint32_t c) const {
    std::vector<std::uint32_t> all = face_at(c / 3);
    if (face_of_[c / 3] != face_of_[mesh_.edge_mates[c] / 3]) {
      const std::vector<std::uint32_t> more = face_at(mesh_.edge_mates[c] / 3);
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }
  // Estimates the bits of the residual of sector x.
  double cost(std::uint32_t x) const {
    const Vec3l normal =
        sector_normal(mesh_.geometry, {face_of_, normals_}, weight_, mesh_.sectors.corners[x]);
    const OctahedronPoint point = octahedral_of(normal, value_bits_);
    std::int64_t off = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::int64_t d = point[c] - wanted_[x][c];
      off += d < 0 ? -d : d;
    }
    return 1.5 * det_log2(1.0 + static_cast<double>(off));
  }

 private:
  std::vector<std::uint32_t> face_at(std::uint32_t t) const {
    std::vector<std::uint32_t> face{t};
    for (std::size_t i = 0; i < face.size() && face.size() <= kMaxFaceTriangles; ++i) {
      for (std::uint32_t c = 3 * face[i]; c < 3 * face[i] + 3; ++c) {
        if (!is_diagonal_[c]) continue;
        const std::uint32_t u = mesh_.edge_mates[c] / 3;
        if (std::find(face.begin(), face.end(), u) == face.end()) face.push_back(u);
      }
    }
    return face;
  }
  void keep(const std::vector<std::uint32_t>& face) {
    const std::uint32_t lowest = *std::min_element(face.begin(), face.end());
    Vec3l sum{};
    for (const std::uint32_t t : face) {
      face_of_[t] = lowest;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += triangle_normals_[t][k];
    }
    normals_[lowest] = sum;
  }

  const SmoothingMesh& mesh_;
  SmoothingWeight weight_;
  std::span<const std::array<std::uint32_t, 2>> wanted_;
  std::uint32_t value_bits_;
  std::vector<bool> is_diagonal_;
  std::vector<std::uint32_t> face_of_;
  std::vector<Vec3l> triangle_normals_;
  std::vector<Vec3l> normals_;
};

class SmoothingSearch {
 public:
  SmoothingSearch(const SmoothingMesh& mesh,
                  std::span<const std::array<std::uint32_t, 2>> wanted,
                  std::uint32_t value_bits)
      : mesh_(mesh), wanted_(wanted), value_bits_(value_bits) {
    for (std::uint32_t c = 0; c < mesh.edge_mates.size(); ++c) {
      const std::uint32_t mate = mesh.edge_mates[c];
      if (mate < c && (mesh.seams.empty() || !mesh.seams[c])) edges_.push_back(c);
    }
  }

  Smoothing find(SmoothingWeight weight, bool is_likely) {
    ChangingFaces faces(mesh_, weight, wanted_, value_bits_);
    std::vector<bool> flags(mesh_.edge_mates.size(), false);
    double bits = 0.0;
    const auto set_flag = [&](std::uint32_t c, bool flag) {
      if (flags[c] != flag) bits += flag ? kFlagBits : -kFlagBits;
      flags[c] = flags[mesh_.edge_mates[c]] = flag;
    };
    for (const std::uint32_t c : edges_) {
      if (!is_likely || !mesh_.geometry.is_likely_diagonal(c, mesh_.edge_mates[c])) continue;
      if (!faces.turn(c)) set_flag(c, true);
    }
    std::vector<double> costs(mesh_.sectors.count());
    for (std::uint32_t x = 0; x < costs.size(); ++x) costs[x] = faces.cost(x);
    for (int pass = 0; pass < kMaxPasses; ++pass) {
      bool has_changed = false;
      for (const std::uint32_t c : edges_) {
        if (improve(c, flags[c], faces, costs)) {
          set_flag(c, !flags[c]);
          has_changed = true;
        }
      }
      if (!has_changed) break;
    }
    for (const double cost : costs) bits += cost;
    return {weight, faces.diagonals(), bits};
  }

  // Returns a smoothing without diagonals.
  Smoothing plain(SmoothingWeight weight) {
    const ChangingFaces faces(mesh_, weight, wanted_, value_bits_);
    Smoothing plain{weight, faces.diagonals()};
    for (std::uint32_t x = 0; x < mesh_.sectors.count(); ++x) plain.bits += faces.cost(x);
    return plain;
  }

 private:
  // Changes edge c if that saves bits.
  bool improve(std::uint32_t c, bool flag, ChangingFaces& faces, std::vector<double>& costs) {
    std::vector<std::uint32_t> sectors;
    for (const std::uint32_t t : faces.triangles_around(c)) {
      for (std::uint32_t k = 3 * t; k < 3 * t + 3; ++k) {
        sectors.push_back(mesh_.sectors.sector_of_corner[k]);
      }
    }
    sort_without_repetitions(sectors);
    double before = flag ? kFlagBits : 0.0;
    for (const std::uint32_t x : sectors) before += costs[x];
    if (before < 1.0 || !faces.turn(c)) return false;
    std::vector<double> changed;
    double after = flag ? 0.0 : kFlagBits;
    for (const std::uint32_t x : sectors) {
      changed.push_back(faces.cost(x));
      after += changed.back();
    }
    if (after > before - 0.5) {
      faces.turn(c);
      return false;
    }
    for (std::size_t i = 0; i < sectors.size(); ++i) costs[sectors[i]] = changed[i];
    return true;
  }

  const SmoothingMesh& mesh_;
  std::span<const std::array<std::uint32_t, 2>> wanted_;
  std::uint32_t value_bits_;
  std::vector<std::uint32_t> edges_;  // edges that can be diagonals; the higher of each pair
};

}  // namespace

Smoothing find_smoothing(const SmoothingMesh& mesh,
                         std::span<const std::array<std::uint32_t, 2>> wanted,
                         std::uint32_t value_bits) {
  constexpr std::array kWeights{SmoothingWeight::kAngle, SmoothingWeight::kArea,
                                SmoothingWeight::kEqual};
  SmoothingSearch search(mesh, wanted, value_bits);
  Smoothing best = search.plain(kWeights[0]);
  const auto keep_better = [&best](Smoothing other) {
    if (other.bits < best.bits) best = std::move(other);
  };
  for (const SmoothingWeight weight : kWeights) {
    keep_better(search.plain(weight));
    keep_better(search.find(weight, false));
    keep_better(search.find(weight, true));
  }
  return best;
}

}  // namespace rlpc
