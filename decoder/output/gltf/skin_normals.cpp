// What morph targets change of the normals is taken from the surface: the normals of a frame
// minus those of the same frame with bones alone. Bones turn normals as they are, and the
// surface has normals of its own, so that the two differ by several degrees where nothing is
// missing.
#include "decoder/output/gltf/skin_normals.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace rlpc {
namespace {

using Eigen::Index;

// Of the determinant of a map, relative to its columns: it is singular below.
constexpr double kSingular = 1e-6;

// The RMS that targets may leave. For 1 degree, targets of normals take 2 to 3 times the bytes,
// and bring normals nearer to those of the source by at most 0.1 degrees.
constexpr double kToleratedAngle = 2 * std::numbers::pi / 180;

constexpr float kNormalUnit = 1.0F / 127;  // normalised bytes

// A frame with bones alone.
std::vector<float> moved_by_joints(const SkinInfluences& influences, const JointMaps& maps,
                                   std::span<const float> rest) {
  std::vector<float> xyz(rest.size());
  for (std::size_t v = 0; v < rest.size() / 3; ++v) {
    const Eigen::Vector3d from(rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]);
    const Eigen::Vector3d to = map_of(influences, v, maps) * from.homogeneous();
    for (std::size_t c = 0; c < 3; ++c) {
      xyz[3 * v + c] = static_cast<float>(to[static_cast<Index>(c)]);
    }
  }
  return xyz;
}

}  // namespace

std::vector<float> rest_normals(const SkinInfluences& influences, const JointMaps& maps,
                                std::span<const std::uint32_t> vertex,
                                std::span<const float> normals) {
  std::vector<float> rest(normals.begin(), normals.end());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const Eigen::Matrix3d turn = map_of(influences, vertex[i], maps).leftCols<3>();
    const double volume = turn.colwise().norm().prod();
    if (!(std::abs(turn.determinant()) > kSingular * volume)) continue;
    const Eigen::Vector3d wanted(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
    const Eigen::Vector3d normal = (turn.inverse() * wanted).normalized();
    for (std::size_t c = 0; c < 3; ++c) {
      rest[3 * i + c] = static_cast<float>(normal[static_cast<Index>(c)]);
    }
  }
  return rest;
}

SkinNormals skin_normals(const GltfLook& look, const SkinInfluences& influences,
                         std::span<const JointMaps> maps, std::span<const float> rest,
                         ShownFrames frames, std::size_t max_targets, std::uint64_t max_bytes) {
  const std::vector<std::uint32_t>& vertex = look.mesh().vertex;
  const auto of_rest = [&](std::size_t f, std::span<const float> xyz) {
    return rest_normals(influences, maps[f], vertex, look.normals(xyz));
  };
  SkinNormals normals;
  normals.rest = of_rest(0, frames[0]);
  normals.moves.weights.resize(0, static_cast<Index>(frames.size()));
  if (max_targets == 0) return normals;
  normals.lacks_moves = normals.rest.size() * sizeof(float) * frames.size() > max_bytes;
  if (normals.lacks_moves) return normals;
  Eigen::MatrixXf moves(static_cast<Index>(normals.rest.size()),
                        static_cast<Index>(frames.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const std::vector<float> whole = of_rest(f, frames[f]);
    const std::vector<float> bones = of_rest(f, moved_by_joints(influences, maps[f], rest));
    const auto column = static_cast<Index>(f);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      const auto row = static_cast<Index>(i);
      moves(row, column) = whole[i] - bones[i] - (f > 0 ? moves(row, 0) : 0.0F);
    }
  }
  moves.col(0).setZero();
  normals.moves = principal_shapes(std::move(moves), kToleratedAngle, max_targets, kNormalUnit);
  return normals;
}

}  // namespace rlpc
