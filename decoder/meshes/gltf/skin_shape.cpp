#include "decoder/meshes/gltf/skin_shape.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Damping for vertices that their joints squeeze flat, which get only a part of the residual.
constexpr double kDamping = 1e-3;

constexpr std::size_t kVerticesTogether = 256;  // fixed: on one thread

Vector3d vector_at(std::span<const float> xyz, std::size_t v) {
  return {xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
}

// Solves for the addition at rest that a map turns into the residual.
class MoveSolver {
 public:
  explicit MoveSolver(const JointMap& map) {
    const Matrix3d turn = map.leftCols<3>();
    const Matrix3d squares = turn.transpose() * turn + kDamping * Matrix3d::Identity();
    back_ = squares.ldlt().solve(turn.transpose());
  }
  Vector3d at_rest(const Vector3d& missing) const { return back_ * missing; }

 private:
  Matrix3d back_;
};

void set_vector(std::span<float> xyz, std::size_t v, const Vector3d& p) {
  for (std::size_t c = 0; c < 3; ++c) {
    xyz[3 * v + c] = static_cast<float>(p[static_cast<Index>(c)]);
  }
}

struct FrameError {
  double squares = 0;  // sum of squared distances
  double largest_square = 0;
  double spread = 0;  // sum of squared distances from the centre
};

// Returns the error of a frame. xyz: its rest shape; wanted: its positions.
FrameError frame_error(const SkinInfluences& influences, const JointMaps& maps,
                       std::span<const float> xyz, std::span<const float> wanted) {
  FrameError error;
  const std::size_t num_vertices = xyz.size() / 3;
  Vector3d sum = Vector3d::Zero();
  double sum_of_squares = 0;
  for (std::size_t v = 0; v < num_vertices; ++v) {
    const JointMap map = map_of(influences, v, maps);
    const Vector3d place = vector_at(wanted, v);
    const Vector3d shown = map.leftCols<3>() * vector_at(xyz, v) + map.col(3);
    const double square = (shown - place).squaredNorm();
    error.squares += square;
    error.largest_square = std::max(error.largest_square, square);
    sum += place;
    sum_of_squares += place.squaredNorm();
  }
  error.spread = sum_of_squares - sum.squaredNorm() / static_cast<double>(num_vertices);
  return error;
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
    weights[0] += left;  // rounding error
    list.resize(kJointsOfVertex);
    for (std::size_t k = 0; k < kJointsOfVertex; ++k) {
      written.joints.push_back(list[k].bone);
      written.weights.push_back(static_cast<std::uint16_t>(weights[k]));
    }
  }
  return written;
}

std::optional<std::size_t> only_joint(const SkinInfluences& influences, std::size_t vertex) {
  const std::size_t first = kJointsOfVertex * vertex;
  if (influences.weights[first] != influences.whole) return std::nullopt;
  return influences.joints[first];
}

JointMap map_of(const SkinInfluences& influences, std::size_t vertex, const JointMaps& maps) {
  if (const auto joint = only_joint(influences, vertex)) return maps[*joint];
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
  // Sums that all vertices of a single joint share.
  std::vector<Matrix3d> squares_of_joint(maps[0].size(), Matrix3d::Zero());
  for (std::size_t j = 0; j < squares_of_joint.size(); ++j) {
    for (const JointMaps& frame_maps : maps) {
      const Matrix3d turn = frame_maps[j].leftCols<3>();
      squares_of_joint[j] += turn.transpose() * turn;
    }
  }
  for_ranges(num_vertices, kVerticesTogether, [&](std::size_t first, std::size_t end) {
    for (std::size_t v = first; v < end; ++v) {
      const auto joint = only_joint(influences, v);
      Matrix3d squares = joint ? squares_of_joint[*joint] : Matrix3d::Zero();
      Vector3d sums = Vector3d::Zero();
      for (std::size_t f = 0; f < frames.size(); ++f) {
        const JointMap map = map_of(influences, v, maps[f]);
        const Matrix3d turn = map.leftCols<3>();
        if (!joint) squares += turn.transpose() * turn;
        sums += turn.transpose() * (vector_at(frames[f], v) - map.col(3));
      }
      squares += 1e-9 * static_cast<double>(frames.size()) * Matrix3d::Identity();
      set_vector(rest, v, squares.ldlt().solve(sums));
    }
  });
  return rest;
}

Eigen::MatrixXf missing_moves(const SkinInfluences& influences, std::span<const JointMaps> maps,
                              std::span<const float> rest, ShownFrames frames) {
  Eigen::MatrixXf moves(static_cast<Index>(rest.size()), static_cast<Index>(frames.size()));
  for_each(frames.size(), [&](std::size_t f) {
    const std::vector<MoveSolver> joint_solvers(maps[f].begin(), maps[f].end());
    for (std::size_t v = 0; v < rest.size() / 3; ++v) {
      const JointMap map = map_of(influences, v, maps[f]);
      const Vector3d missing =
          vector_at(frames[f], v) - map.leftCols<3>() * vector_at(rest, v) - map.col(3);
      const auto joint = only_joint(influences, v);
      const Vector3d move =
          joint ? joint_solvers[*joint].at_rest(missing) : MoveSolver(map).at_rest(missing);
      moves.block<3, 1>(static_cast<Index>(3 * v), static_cast<Index>(f)) = move.cast<float>();
    }
  });
  return moves;
}

SkinError skin_error(const SkinInfluences& influences, std::span<const JointMaps> maps,
                     std::span<const float> rest, const PrincipalShapes& shapes,
                     ShownFrames frames) {
  const auto num_vertices = static_cast<double>(rest.size()) / 3.0;
  std::vector<FrameError> errors(frames.size());
  for_each(frames.size(), [&](std::size_t f) {
    Eigen::VectorXf shape =
        Eigen::Map<const Eigen::VectorXf>(rest.data(), static_cast<Index>(rest.size()));
    if (shapes.targets.cols() > 0) {
      shape += shapes.targets * shapes.weights.col(static_cast<Index>(f));
    }
    errors[f] = frame_error(influences, maps[f], {shape.data(), rest.size()}, frames[f]);
  });
  SkinError error;
  double squares = 0;
  double spread = 0;
  for (const FrameError& frame_error : errors) {
    squares += frame_error.squares;
    spread += frame_error.spread;
    error.largest = std::max(error.largest, std::sqrt(frame_error.largest_square));
  }
  error.rms = std::sqrt(squares / (num_vertices * static_cast<double>(frames.size())));
  if (spread > 0) error.kg_percent = 100 * std::sqrt(squares / spread);
  return error;
}

}  // namespace rlpc
