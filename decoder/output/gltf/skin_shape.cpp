#include "decoder/output/gltf/skin_shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace rlpc {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Against vertices that their joints squeeze flat: what is missing there is not all added.
constexpr double kDamping = 1e-3;

Vector3d vector_at(std::span<const float> xyz, std::size_t v) {
  return {xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
}

void set_vector(std::span<float> xyz, std::size_t v, const Vector3d& p) {
  for (std::size_t c = 0; c < 3; ++c) {
    xyz[3 * v + c] = static_cast<float>(p[static_cast<Index>(c)]);
  }
}

}  // namespace

SkinInfluences written_influences(const Skeleton& skeleton, int whole) {
  SkinInfluences written;
  written.whole = whole;
  for (std::vector<SkeletonInfluence> list : skeleton.influences) {
    std::ranges::stable_sort(list, std::greater<>(), &SkeletonInfluence::weight);
    list.resize(std::min(list.size(), kJointsOfVertex));
    int total = 0;
    for (const SkeletonInfluence& influence : list) total += influence.weight;
    int left = whole;
    std::array<int, kJointsOfVertex> weights{};
    for (std::size_t k = 0; k < list.size(); ++k) {
      weights[k] = whole * list[k].weight / total;
      left -= weights[k];
    }
    weights[0] += left;  // of rounding
    list.resize(kJointsOfVertex);
    for (std::size_t k = 0; k < kJointsOfVertex; ++k) {
      written.joints.push_back(list[k].bone);
      written.weights.push_back(static_cast<std::uint16_t>(weights[k]));
    }
  }
  return written;
}

JointMap map_of(const SkinInfluences& influences, std::size_t vertex, const JointMaps& maps) {
  JointMap map = JointMap::Zero();
  for (std::size_t k = kJointsOfVertex * vertex; k < kJointsOfVertex * (vertex + 1); ++k) {
    if (influences.weights[k] == 0) continue;
    map += influences.weights[k] * (1.0 / influences.whole) * maps[influences.joints[k]];
  }
  return map;
}

double rms_between(const SkinInfluences& a, const SkinInfluences& b, const JointMaps& maps,
                   std::span<const float> xyz) {
  double squares = 0;
  for (std::size_t v = 0; v < xyz.size() / 3; ++v) {
    const JointMap apart = map_of(a, v, maps) - map_of(b, v, maps);
    squares += (apart * vector_at(xyz, v).homogeneous()).squaredNorm();
  }
  return std::sqrt(3 * squares / static_cast<double>(xyz.size()));
}

std::vector<float> best_rest(const SkinInfluences& influences, std::span<const JointMaps> maps,
                             ShownFrames frames) {
  const std::size_t num_vertices = frames[0].size() / 3;
  std::vector<float> rest(3 * num_vertices);
  for (std::size_t v = 0; v < num_vertices; ++v) {
    Matrix3d squares = Matrix3d::Zero();
    Vector3d sums = Vector3d::Zero();
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const JointMap map = map_of(influences, v, maps[f]);
      const Matrix3d turn = map.leftCols<3>();
      squares += turn.transpose() * turn;
      sums += turn.transpose() * (vector_at(frames[f], v) - map.col(3));
    }
    squares += 1e-9 * static_cast<double>(frames.size()) * Matrix3d::Identity();
    set_vector(rest, v, squares.ldlt().solve(sums));
  }
  return rest;
}

Eigen::MatrixXf missing_moves(const SkinInfluences& influences, std::span<const JointMaps> maps,
                              std::span<const float> rest, ShownFrames frames) {
  Eigen::MatrixXf moves(static_cast<Index>(rest.size()), static_cast<Index>(frames.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    for (std::size_t v = 0; v < rest.size() / 3; ++v) {
      const JointMap map = map_of(influences, v, maps[f]);
      const Matrix3d turn = map.leftCols<3>();
      const Vector3d missing = vector_at(frames[f], v) - turn * vector_at(rest, v) - map.col(3);
      const Matrix3d squares = turn.transpose() * turn + kDamping * Matrix3d::Identity();
      const Vector3d move = squares.ldlt().solve(turn.transpose() * missing);
      moves.block<3, 1>(static_cast<Index>(3 * v), static_cast<Index>(f)) = move.cast<float>();
    }
  }
  return moves;
}

SkinError skin_error(const SkinInfluences& influences, std::span<const JointMaps> maps,
                     std::span<const float> rest, const PrincipalShapes& shapes,
                     ShownFrames frames) {
  const std::size_t num_vertices = rest.size() / 3;
  const Eigen::Map<const Eigen::VectorXf> base(rest.data(), static_cast<Index>(rest.size()));
  SkinError error;
  double squares = 0;
  double spread = 0;  // about the centre of each frame
  for (std::size_t f = 0; f < frames.size(); ++f) {
    Eigen::VectorXf shape = base;
    if (shapes.targets.cols() > 0) {
      shape += shapes.targets * shapes.weights.col(static_cast<Index>(f));
    }
    const std::span<const float> xyz(shape.data(), rest.size());
    Vector3d sum = Vector3d::Zero();
    double sum_of_squares = 0;
    for (std::size_t v = 0; v < num_vertices; ++v) {
      const JointMap map = map_of(influences, v, maps[f]);
      const Vector3d wanted = vector_at(frames[f], v);
      const Vector3d shown = map.leftCols<3>() * vector_at(xyz, v) + map.col(3);
      const double square = (shown - wanted).squaredNorm();
      squares += square;
      error.largest = std::max(error.largest, std::sqrt(square));
      sum += wanted;
      sum_of_squares += wanted.squaredNorm();
    }
    spread += sum_of_squares - sum.squaredNorm() / static_cast<double>(num_vertices);
  }
  error.rms = std::sqrt(squares / static_cast<double>(num_vertices * frames.size()));
  if (spread > 0) error.kg_percent = 100 * std::sqrt(squares / spread);
  return error;
}

}  // namespace rlpc
