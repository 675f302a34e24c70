#include "encoder/codec/attributes/compared_normals.h"

#include <algorithm>
#include <cmath>

#include "common/codec/attributes/recon/corner_geometry.h"
#include "common/parallel/for_each.h"
#include "common/surface/local_turn.h"

namespace rlpc {
namespace {

constexpr double kDegrees = 57.29577951308232;
constexpr float kVisible = 0.01F;  // fixed: part of the largest area; smaller ones do not count

double degrees_between(const Vec3d& a, const Vec3d& b) {
  return kDegrees * angle_between(a, b);
}

}  // namespace

ComparedNormals::ComparedNormals(const ComparedMesh& mesh,
                                 std::span<const ComparedFrame> frames)
    : mesh_(mesh),
      compared_(frames),
      frames_(frames.size()),
      vertices_(sectors_of_vertices(mesh.num_vertices, mesh.triangles)),
      can_turn_(mesh.sectors.count(), true) {
  measure_areas();
  if (mesh.turns) find_surface();
  for_each(frames.size(), [&](std::size_t f) { measure(f); });
}

// Sets the weight of each sector: the areas of its triangles, relative to the largest.
void ComparedNormals::measure_areas() {
  const std::uint32_t count = mesh_.sectors.count();
  for_each(frames_.size(), [&](std::size_t f) {
    const CornerGeometry geometry(mesh_.triangles, compared_[f].positions);
    std::vector<float>& areas = frames_[f].weights;
    areas.assign(count, 0.0F);
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t) {
      const Vec3l n = geometry.triangle_normal(t);
      const Vec3d area{static_cast<double>(n[0]), static_cast<double>(n[1]),
                       static_cast<double>(n[2])};
      const auto size = static_cast<float>(std::sqrt(dot(area, area)));
      for (std::uint32_t c = 3 * t; c < 3 * t + 3; ++c)
        areas[mesh_.sectors.sector_of_corner[c]] += size;
    }
  });
  for (std::uint32_t x = 0; x < count; ++x) {
    float largest = 0.0F;
    for (const Frame& frame : frames_) largest = std::max(largest, frame.weights[x]);
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      float& weight = frames_[f].weights[x];
      const bool has_normal = !is_zero(compared_[f].normals[x]);
      weight = largest > 0.0F && has_normal ? weight / largest : 0.0F;
      if (weight < kVisible) weight = 0.0F;
    }
  }
}

void ComparedNormals::find_surface() {
  const std::span<const std::int32_t> first = compared_[0].positions;
  for (std::uint32_t v = 0; v < mesh_.num_vertices; ++v) {
    LocalTurn none;
    add_surroundings(mesh_.triangles, vertices_.corners[v], first, first, none);
    if (none.find()) continue;
    for (const std::uint32_t c : vertices_.corners[v]) {
      can_turn_[mesh_.sectors.sector_of_corner[c]] = false;
    }
  }
}

void ComparedNormals::measure(std::size_t f) {
  const ComparedFrame& compared = compared_[f];
  Frame& frame = frames_[f];
  const CornerGeometry geometry(mesh_.triangles, compared.positions);
  const ShapeNormals shape(geometry, mesh_.sectors, mesh_.edge_mates, mesh_.seams,
                           mesh_.smoothing);
  frame.smoothing.assign(mesh_.sectors.count(), 0.0F);
  for (std::uint32_t x = 0; x < mesh_.sectors.count(); ++x) {
    if (frame.weights[x] == 0.0F) continue;
    const Vec3d n = shape.normal(x);
    frame.smoothing[x] =
        static_cast<float>(is_zero(n) ? 90.0 : degrees_between(n, compared.normals[x]));
  }
  frame.turned = compared.normals;
  if (f == 0 || !mesh_.turns) return;
  const std::span<const std::int32_t> first = compared_[0].positions;
  for (std::uint32_t v = 0; v < mesh_.num_vertices; ++v) {
    LocalTurn turn;
    add_surroundings(mesh_.triangles, vertices_.corners[v], first, compared.positions, turn);
    if (!turn.find()) continue;
    for (const std::uint32_t c : vertices_.corners[v]) {
      const std::uint32_t x = mesh_.sectors.sector_of_corner[c];
      frame.turned[x] = turn.turned_back(compared.normals[x]);
    }
  }
}

Vec3d ComparedNormals::fitted(std::uint32_t x) const {
  Vec3d sum{};
  for (const Frame& frame : frames_) {
    for (std::size_t k = 0; k < 3; ++k) sum[k] += frame.weights[x] * frame.turned[x][k];
  }
  return normalised(sum);
}

std::optional<Vec3d> ComparedNormals::best_vector(std::uint32_t x) const {
  std::optional<Vec3d> best;
  double best_error = 0.0;
  const auto attempt = [&](const Vec3d& vector) {
    if (is_zero(vector)) return;
    const double error = vector_error(x, vector);
    if (best && error >= best_error) return;
    best = vector;
    best_error = error;
  };
  if (weight(x) == 0.0) return best;
  attempt(fitted(x));
  for (const Frame& frame : frames_) {
    if (frame.weights[x] > 0.0F) attempt(frame.turned[x]);
  }
  return best;
}

double ComparedNormals::weight(std::uint32_t x) const {
  double sum = 0.0;
  for (const Frame& frame : frames_) sum += frame.weights[x];
  return sum;
}

double ComparedNormals::smoothing_error(std::uint32_t x) const {
  double angles = 0.0;
  for (const Frame& frame : frames_) angles += double{frame.weights[x]} * frame.smoothing[x];
  const double sum = weight(x);
  return sum > 0.0 ? angles / sum : 0.0;
}

double ComparedNormals::vector_error(std::uint32_t x, const Vec3d& stored) const {
  double angles = 0.0;
  for (const Frame& frame : frames_) {
    if (frame.weights[x] == 0.0F) continue;
    angles += frame.weights[x] * degrees_between(stored, frame.turned[x]);
  }
  const double sum = weight(x);
  return sum > 0.0 ? angles / sum : 0.0;
}

std::vector<NormalError> ComparedNormals::errors(const std::vector<bool>& is_smooth,
                                                 std::span<const Vec3d> stored) const {
  std::vector<NormalError> errors;
  for (std::size_t f = 0; f < frames_.size(); ++f) {
    NormalError& error = errors.emplace_back();
    error.frame = compared_[f].frame;
    double weights = 0.0;
    for (std::uint32_t x = 0; x < mesh_.sectors.count(); ++x) {
      const double weight = frames_[f].weights[x];
      if (weight == 0.0) continue;
      const double off = is_smooth[x] ? frames_[f].smoothing[x]
                                      : degrees_between(stored[x], frames_[f].turned[x]);
      error.largest = std::max(error.largest, off);
      error.mean += weight * off;
      error.rms += weight * off * off;
      weights += weight;
    }
    if (weights == 0.0) continue;
    error.mean /= weights;
    error.rms = std::sqrt(error.rms / weights);
  }
  return errors;
}

}  // namespace rlpc
