// What morph targets change of the normals is taken from the surface: the normals of a frame
// minus those of the same frame with bones alone. Bones turn normals as they are, and the
// surface has normals of its own, so that the two differ by several degrees where nothing is
// missing. Where they differ by much more, as where bones turn a part of the surface over or
// squeeze it, targets make up for the whole difference.
#include "decoder/output/gltf/skin_normals.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace rlpc {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXf;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Of the determinant of a map, relative to its columns: it is singular below.
constexpr double kSingular = 1e-6;

constexpr double kDegree = std::numbers::pi / 180;

// The RMS that targets may leave. For 1 degree, targets of normals take 2 to 3 times the bytes,
// and bring normals nearer to those of the source by at most 0.1 degrees.
constexpr double kToleratedAngle = 2 * kDegree;

// Angles between what bones make of normals and what they are to be: below the first, the
// difference is that of two kinds of normals; above the second, it is an error. In between, a
// part of it is, so that nothing jumps.
constexpr double kKindsDiffer = 10 * kDegree;
constexpr double kBonesFail = 20 * kDegree;

// Vertices that targets leave by more than this in a frame get targets of their own, which
// leave less.
constexpr double kFarOff = 30 * kDegree;
constexpr double kTolerableThere = 6 * kDegree;

// Of the largest area around a vertex: normals of a frame with less do not count; a frame with
// more is as good as any to take the normal of the rest shape from.
constexpr float kVisible = 1e-4F;
constexpr float kEnough = 0.25F;

constexpr float kNormalUnit = 1.0F / 127;  // normalised bytes

// What joints make of each vertex of the stream in a frame.
class JointFrame {
 public:
  JointFrame(const SkinInfluences& influences, const JointMaps& maps, std::size_t count) {
    maps_.reserve(count);
    back_.reserve(count);
    for (std::size_t v = 0; v < count; ++v) {
      const JointMap& map = maps_.emplace_back(map_of(influences, v, maps));
      const Matrix3d turn = map.leftCols<3>();
      const double volume = turn.colwise().norm().prod();
      const bool is_singular = !(std::abs(turn.determinant()) > kSingular * volume);
      back_.push_back(is_singular ? Matrix3d::Identity() : Matrix3d(turn.inverse()));
    }
  }

  // The positions of the vertices by joints alone.
  std::vector<float> moved(std::span<const float> rest) const {
    std::vector<float> xyz(rest.size());
    for (std::size_t v = 0; v < maps_.size(); ++v) {
      const Vector3d from(rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]);
      const Vector3d to = maps_[v] * from.homogeneous();
      for (std::size_t c = 0; c < 3; ++c) {
        xyz[3 * v + c] = static_cast<float>(to[static_cast<Index>(c)]);
      }
    }
    return xyz;
  }

  // The unit vector that the joints turn into the direction of a normal of vertex v.
  Vector3f at_rest(std::uint32_t v, const float* normal) const {
    const Vector3d wanted(normal[0], normal[1], normal[2]);
    return (back_[v] * wanted).normalized().cast<float>();
  }

 private:
  std::vector<JointMap> maps_;
  std::vector<Matrix3d> back_;
};

// Of output vertices, the areas around them in a frame.
std::vector<float> areas_of(const GlbMesh& mesh, std::span<const float> xyz) {
  std::vector<float> areas(mesh.vertex.size(), 0.0F);
  const auto point = [&](std::uint32_t i) {
    const float* const p = &xyz[3 * std::size_t{mesh.vertex[i]}];
    return Vector3f(p[0], p[1], p[2]);
  };
  for (const GlbMesh::Part& part : mesh.parts) {
    for (const Triangle& t : part.triangles) {
      const Vector3f p = point(t[0]);
      const float area = (point(t[1]) - p).cross(point(t[2]) - p).norm();
      for (const std::uint32_t i : t) areas[i] += area;
    }
  }
  return areas;
}

class SkinNormalMaker {
 public:
  SkinNormalMaker(const GltfLook& look, const SkinInfluences& influences,
                  std::span<const JointMaps> maps, std::span<const float> rest,
                  ShownFrames frames)
      : look_(look),
        vertex_(look.mesh().vertex),
        influences_(influences),
        maps_(maps),
        rest_(rest),
        frames_(frames),
        largest_(vertex_.size(), 0.0F),
        best_(vertex_.size(), 0) {
    find_best_frames();
    take_rest();
  }

  const std::vector<Vector3f>& rest() const { return wanted_; }

  // What the normals of frame f have to move by: three rows for each output vertex.
  void set_moves(std::size_t f, Eigen::Ref<Eigen::VectorXf> moves) const {
    const JointFrame joints(influences_, maps_[f], rest_.size() / 3);
    const std::vector<float> whole = look_.normals(frames_[f]);
    const std::vector<float> bones = look_.normals(joints.moved(rest_));
    const std::vector<float> areas = areas_of(look_.mesh(), frames_[f]);
    for (std::size_t i = 0; i < vertex_.size(); ++i) {
      auto move = moves.segment<3>(static_cast<Index>(3 * i));
      move.setZero();
      if (!(areas[i] > kVisible * largest_[i])) continue;
      const Vector3f wanted = joints.at_rest(vertex_[i], &whole[3 * i]);
      const Vector3f by_bones = joints.at_rest(vertex_[i], &bones[3 * i]);
      move = wanted - by_bones - apart_[i];
      const Vector3f shown = wanted_[i] + move;
      const double angle = std::atan2(shown.cross(wanted).norm(), shown.dot(wanted));
      const double part = (angle - kKindsDiffer) / (kBonesFail - kKindsDiffer);
      move += static_cast<float>(std::clamp(part, 0.0, 1.0)) * (wanted - shown);
    }
  }

 private:
  // The frame that the normal of each vertex is taken from: the first one, or where that hardly
  // has a surface there, the one with the largest.
  void find_best_frames() {
    std::vector<float> first;
    for (std::size_t f = 0; f < frames_.size(); ++f) {
      std::vector<float> areas = areas_of(look_.mesh(), frames_[f]);
      for (std::size_t i = 0; i < areas.size(); ++i) {
        if (!(areas[i] > largest_[i])) continue;
        largest_[i] = areas[i];
        best_[i] = static_cast<std::uint32_t>(f);
      }
      if (f == 0) first = std::move(areas);
    }
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] >= kEnough * largest_[i]) best_[i] = 0;
    }
  }

  void take_rest() {
    wanted_.resize(vertex_.size());
    apart_.resize(vertex_.size());
    std::vector<std::uint32_t> frames = best_;
    std::ranges::sort(frames);
    const auto rest_of = std::ranges::unique(frames);
    frames.erase(rest_of.begin(), rest_of.end());
    for (const std::uint32_t f : frames) {
      const JointFrame joints(influences_, maps_[f], rest_.size() / 3);
      const std::vector<float> whole = look_.normals(frames_[f]);
      const std::vector<float> bones = look_.normals(joints.moved(rest_));
      for (std::size_t i = 0; i < vertex_.size(); ++i) {
        if (best_[i] != f) continue;
        wanted_[i] = joints.at_rest(vertex_[i], &whole[3 * i]);
        apart_[i] = wanted_[i] - joints.at_rest(vertex_[i], &bones[3 * i]);
      }
    }
  }

  const GltfLook& look_;
  const std::vector<std::uint32_t>& vertex_;
  const SkinInfluences& influences_;
  std::span<const JointMaps> maps_;
  std::span<const float> rest_;
  ShownFrames frames_;
  std::vector<float> largest_;       // [output vertex], area in any frame
  std::vector<std::uint32_t> best_;  // [output vertex], frame
  std::vector<Vector3f> wanted_;     // [output vertex], in that frame, at rest
  std::vector<Vector3f> apart_;      // from those of the surface that joints alone make
};

// Some vertices of a matrix with three rows for each.
MatrixXf rows_of(const MatrixXf& all, const std::vector<Index>& vertices) {
  MatrixXf some(static_cast<Index>(3 * vertices.size()), all.cols());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    some.middleRows<3>(static_cast<Index>(3 * i)) = all.middleRows<3>(3 * vertices[i]);
  }
  return some;
}

// Vertices that move by more than `least` in a frame. Of the others, adds the squares.
std::vector<Index> moving_vertices(const MatrixXf& moves, double least, double& other_squares) {
  std::vector<Index> vertices;
  for (Index v = 0; v < moves.rows() / 3; ++v) {
    const auto rows = moves.middleRows<3>(3 * v);
    if (std::sqrt(rows.colwise().squaredNorm().maxCoeff()) > static_cast<float>(least)) {
      vertices.push_back(v);
    } else {
      other_squares += rows.cast<double>().squaredNorm();
    }
  }
  return vertices;
}

// Adds targets that move some vertices of all.
void append(const PrincipalShapes& some, const std::vector<Index>& vertices,
            PrincipalShapes& all) {
  const Index first = all.targets.cols();
  const Index count = some.targets.cols();
  if (count == 0) return;
  all.has_short_weights = (first == 0 || all.has_short_weights) && some.has_short_weights;
  all.targets.conservativeResize(Eigen::NoChange, first + count);
  all.targets.rightCols(count).setZero();
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    all.targets.block(3 * vertices[i], first, 3, count) =
        some.targets.middleRows<3>(static_cast<Index>(3 * i));
  }
  all.weights.conservativeResize(first + count, Eigen::NoChange);
  all.weights.bottomRows(count) = some.weights;
}

// Targets for all moves, then for those that are far off all the same. Vertices that hardly
// move are left as they are.
PrincipalShapes targets_for(MatrixXf moves, std::size_t max_targets) {
  PrincipalShapes shapes;
  shapes.unit = kNormalUnit;
  shapes.targets.resize(moves.rows(), 0);
  shapes.weights.resize(0, moves.cols());
  double squares = 0;
  const std::vector<Index> vertices = moving_vertices(moves, kToleratedAngle, squares);
  MatrixXf some = rows_of(moves, vertices);
  const double places = static_cast<double>(moves.rows() / 3 * moves.cols());
  moves.resize(0, 0);
  const double some_places = static_cast<double>(some.rows() / 3 * some.cols());
  const double left = kToleratedAngle * kToleratedAngle * places - squares;
  const double rms = left > 0 && some_places > 0 ? std::sqrt(left / some_places) : 0;
  append(principal_shapes_of(some, rms, kToleratedAngle, max_targets, kNormalUnit), vertices,
         shapes);
  std::vector<Index> far = moving_vertices(some, kFarOff, squares);
  if (far.empty()) return shapes;
  MatrixXf rest = rows_of(some, far);
  for (Index& v : far) v = vertices[static_cast<std::size_t>(v)];
  const auto used = static_cast<std::size_t>(shapes.targets.cols());
  append(principal_shapes_of(rest, kTolerableThere, kTolerableThere, max_targets - used,
                             kNormalUnit),
         far, shapes);
  return shapes;
}

}  // namespace

std::vector<float> rest_normals(const SkinInfluences& influences, const JointMaps& maps,
                                std::span<const std::uint32_t> vertex,
                                std::span<const float> normals) {
  const std::size_t count = influences.joints.size() / kJointsOfVertex;
  const JointFrame joints(influences, maps, count);
  std::vector<float> rest;
  rest.reserve(normals.size());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    for (const float x : joints.at_rest(vertex[i], &normals[3 * i])) rest.push_back(x);
  }
  return rest;
}

SkinNormals skin_normals(const GltfLook& look, const SkinInfluences& influences,
                         std::span<const JointMaps> maps, std::span<const float> rest,
                         ShownFrames frames, std::size_t max_targets, std::uint64_t max_bytes) {
  const SkinNormalMaker maker(look, influences, maps, rest, frames);
  SkinNormals normals;
  for (const Vector3f& n : maker.rest()) {
    normals.rest.insert(normals.rest.end(), n.begin(), n.end());
  }
  normals.moves.weights.resize(0, static_cast<Index>(frames.size()));
  if (max_targets == 0) return normals;
  normals.lacks_moves = normals.rest.size() * sizeof(float) * frames.size() > max_bytes;
  if (normals.lacks_moves) return normals;
  MatrixXf moves(static_cast<Index>(normals.rest.size()), static_cast<Index>(frames.size()));
  for (std::size_t f = 0; f < frames.size(); ++f) {
    maker.set_moves(f, moves.col(static_cast<Index>(f)));
  }
  normals.moves = targets_for(std::move(moves), max_targets);
  return normals;
}

}  // namespace rlpc
