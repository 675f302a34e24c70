// Morph targets of normals follow the surface: they hold the normals of a frame minus those of
// the same frame with bones alone. Normals turned by bones and normals of the surface differ by
// several degrees even without a residual. Where they differ by much more, as where bones turn
// over or squeeze a part of the surface, targets hold the whole difference.
#include "decoder/meshes/gltf/skin_normals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/codec/mesh/indices.h"
#include "common/parallel/for_each.h"

namespace rlpc {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXf;
using Eigen::Vector3d;
using Eigen::Vector3f;

// Determinant of a map, relative to its columns, below which it counts as singular.
constexpr double kSingular = 1e-6;

constexpr double kDegree = std::numbers::pi / 180;

// RMS residual of targets. For 1 degree, targets of normals take 2 to 3 times the bytes, and
// reduce the error against the source by at most 0.1 degrees.
constexpr double kToleratedAngle = 2 * kDegree;

// Angles between normals turned by bones and wanted normals: below the first, the difference is
// due to the two kinds of normals; above the second, it is an error; in between, a part of it
// is, for continuity.
constexpr double kKindsDiffer = 10 * kDegree;
constexpr double kBonesFail = 20 * kDegree;

// Residual of a vertex in a frame above which it gets additional targets.
constexpr double kFarOff = 30 * kDegree;
constexpr double kTolerableThere = 6 * kDegree;

// Part of the largest area around a vertex: normals of frames with less do not count; frames
// with more can provide the normal of the rest shape.
constexpr float kVisible = 1e-4F;
constexpr float kEnough = 0.25F;

constexpr std::size_t kFramesTogether = 16;       // fixed: on one thread
constexpr std::size_t kTrianglesTogether = 1024;  // fixed: on one thread

constexpr float kNormalUnit = 1.0F / 127;  // normalised bytes

Matrix3d back_from(const JointMap& map) {
  const Matrix3d turn = map.leftCols<3>();
  const double volume = turn.colwise().norm().prod();
  const bool is_singular = !(std::abs(turn.determinant()) > kSingular * volume);
  return is_singular ? Matrix3d::Identity() : Matrix3d(turn.inverse());
}

// Maps of the vertices of the stream by joints in a frame.
class JointFrame {
 public:
  JointFrame(const SkinInfluences& influences, const JointMaps& maps)
      : influences_(influences), maps_(maps) {
    for (const JointMap& map : maps) back_.push_back(back_from(map));
  }

  // Returns the positions of the vertices by joints alone.
  std::vector<float> moved(std::span<const float> rest) const {
    std::vector<float> xyz(rest.size());
    for (std::size_t v = 0; v < rest.size() / 3; ++v) {
      const Vector3d from(rest[3 * v], rest[3 * v + 1], rest[3 * v + 2]);
      const Vector3d to = map_of(influences_, v, maps_) * from.homogeneous();
      for (std::size_t c = 0; c < 3; ++c) {
        xyz[3 * v + c] = static_cast<float>(to[static_cast<Index>(c)]);
      }
    }
    return xyz;
  }

  // Returns the matrix that turns normals of vertex v back to the rest shape.
  Matrix3d back(std::uint32_t v) const {
    const auto joint = only_joint(influences_, v);
    return joint ? back_[*joint] : back_from(map_of(influences_, v, maps_));
  }

 private:
  const SkinInfluences& influences_;
  const JointMaps& maps_;
  std::vector<Matrix3d> back_;  // [joint]
};

// Returns the unit vector in the direction of a normal, turned back.
Vector3f at_rest(const Matrix3d& back, const float* normal) {
  return (back * Vector3d(normal[0], normal[1], normal[2])).normalized().cast<float>();
}

// Returns the area around each output vertex in a frame.
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

// Returns whether a single joint moves a triangle.
bool is_rigid(const SkinInfluences& influences, const GlbMesh& mesh, const Triangle& t) {
  const auto joint = only_joint(influences, mesh.vertex[t[0]]);
  return joint && std::ranges::all_of(t, [&](std::uint32_t i) {
           return only_joint(influences, mesh.vertex[i]) == joint;
         });
}

// Marks all vertices that share a triangle with marked ones: the second triangle of a polygon
// counts at vertices that it does not have.
void widen(const GlbMesh& mesh, std::vector<bool>& is_marked) {
  const std::vector<bool> before = is_marked;
  for (const GlbMesh::Part& part : mesh.parts) {
    for (const Triangle& t : part.triangles) {
      const bool is_near =
          std::ranges::any_of(t, [&](std::uint32_t i) { return before[mesh.vertex[i]]; });
      for (const std::uint32_t i : t) {
        if (is_near) is_marked[mesh.vertex[i]] = true;
      }
    }
  }
}

// Triangle that a single joint moves, and the distance by which frames may move its edges
// without turning normals visibly.
struct Steady {
  Triangle vertices;  // vertices of the stream
  float square = 0.0F;
  bool is_steady = true;
};

// Returns the square of that distance. Normals may turn by half of the tolerance, as they are
// compared with those of another frame: edges may move by that part of the smallest height.
float square_of_slack(const std::array<Vector3f, 3>& p) {
  const Vector3f a = p[1] - p[0];
  const Vector3f b = p[2] - p[0];
  const float longest =
      std::sqrt(std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()}));
  if (!(longest > 0.0F)) return 0.0F;
  const float slack = static_cast<float>(kToleratedAngle / 2) * a.cross(b).norm() / longest;
  return slack * slack;
}

// Marks vertices whose normals may turn. missing: [3 * vertex][frame].
void mark_unsteady(const MatrixXf& missing, std::span<Steady> triangles) {
  for (Index f = 0; f < missing.cols(); ++f) {
    const float* const moves = missing.col(f).data();
    for (Steady& triangle : triangles) {
      if (!triangle.is_steady) continue;
      const auto move = [&](std::size_t k) -> Vector3f {
        return Eigen::Map<const Vector3f>(&moves[3 * std::size_t{triangle.vertices[k]}]);
      };
      const Vector3f a = move(1) - move(0);
      const Vector3f b = move(2) - move(0);
      const float square = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
      if (square > triangle.square) triangle.is_steady = false;
    }
  }
}

class SkinNormalMaker {
 public:
  SkinNormalMaker(const GltfLook& look, const SkinInfluences& influences,
                  std::span<const JointMaps> maps, std::span<const float> rest,
                  ShownFrames frames, const NormalVertices& vertices)
      : look_(look),
        vertex_(look.mesh().vertex),
        influences_(influences),
        maps_(maps),
        rest_(rest),
        frames_(frames),
        vertices_(vertices),
        largest_(vertex_.size(), 0.0F),
        best_(vertex_.size(), 0) {
    find_best_frames();
    take_rest();
  }

  const std::vector<Vector3f>& rest() const { return wanted_; }

  // Returns the moves of the normals in all frames: three rows per output vertex of `moving`.
  MatrixXf moves(const std::vector<Index>& moving) const {
    MatrixXf moves(static_cast<Index>(3 * moving.size()), static_cast<Index>(frames_.size()));
    for_ranges(frames_.size(), kFramesTogether, [&](std::size_t first, std::size_t end) {
      FrameNormals whole = normals_where(vertices_.is_moving);
      FrameNormals bones = normals_where(vertices_.is_bent);
      for (std::size_t f = first; f < end; ++f) {
        set_moves(f, moving, {whole, bones}, moves.col(static_cast<Index>(f)));
      }
    });
    return moves;
  }

 private:
  struct Surfaces {
    FrameNormals& whole;
    FrameNormals& bones;  // normals where several bones bend them; others turn with their joint
  };

  FrameNormals normals_where(const std::vector<bool>& is_chosen) const {
    FrameNormals some = look_.frame_normals();
    Vector<std::uint8_t> is_wanted(some.count());
    const auto normals = look_.normal_of_vertex();
    for (std::size_t i = 0; i < vertex_.size(); ++i) {
      if (is_chosen[vertex_[i]]) is_wanted[normals[i]] = 1;
    }
    some.restrict_to(std::move(is_wanted));
    return some;
  }

  void set_moves(std::size_t f, const std::vector<Index>& moving, const Surfaces& surfaces,
                 Eigen::Ref<Eigen::VectorXf> moves) const {
    moves.setZero();
    if (moving.empty()) return;
    const JointFrame joints(influences_, maps_[f]);
    const std::vector<float> whole = look_.normals(surfaces.whole, frames_[f]);
    const std::vector<float> bones = look_.normals(surfaces.bones, joints.moved(rest_));
    const std::vector<float> areas = areas_of(look_.mesh(), frames_[f]);
    const auto near = static_cast<float>(std::cos(kKindsDiffer));
    for (std::size_t k = 0; k < moving.size(); ++k) {
      const auto i = static_cast<std::size_t>(moving[k]);
      if (!(areas[i] > kVisible * largest_[i])) continue;
      auto move = moves.segment<3>(static_cast<Index>(3 * k));
      const Matrix3d back = joints.back(vertex_[i]);
      const Vector3f wanted = at_rest(back, &whole[3 * i]);
      const Vector3f by_bones = vertices_.is_bent[vertex_[i]]
                                    ? at_rest(back, &bones[3 * i])
                                    : Vector3f(wanted_[i] - apart_[i]);
      move = wanted - by_bones - apart_[i];
      const Vector3f shown = wanted_[i] + move;
      const float along = shown.dot(wanted);
      if (along > near * shown.norm()) continue;
      const double angle = std::atan2(shown.cross(wanted).norm(), along);
      const double part = (angle - kKindsDiffer) / (kBonesFail - kKindsDiffer);
      move += static_cast<float>(std::clamp(part, 0.0, 1.0)) * (wanted - shown);
    }
  }

  // Finds the frame that the normal of each vertex is taken from: the first frame or, if it has
  // almost no surface there, the frame with the largest area.
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
    sort_without_repetitions(frames);
    for (const std::uint32_t f : frames) {
      const JointFrame joints(influences_, maps_[f]);
      const std::vector<float> whole = look_.normals(frames_[f]);
      const std::vector<float> bones = look_.normals(joints.moved(rest_));
      for (std::size_t i = 0; i < vertex_.size(); ++i) {
        if (best_[i] != f) continue;
        const Matrix3d back = joints.back(vertex_[i]);
        wanted_[i] = at_rest(back, &whole[3 * i]);
        apart_[i] = wanted_[i] - at_rest(back, &bones[3 * i]);
      }
    }
  }

  const GltfLook& look_;
  const std::vector<std::uint32_t>& vertex_;
  const SkinInfluences& influences_;
  std::span<const JointMaps> maps_;
  std::span<const float> rest_;
  ShownFrames frames_;
  const NormalVertices& vertices_;
  std::vector<float> largest_;       // [output vertex], area in any frame
  std::vector<std::uint32_t> best_;  // [output vertex], frame
  std::vector<Vector3f> wanted_;     // [output vertex], normal of that frame, turned back
  std::vector<Vector3f> apart_;      // difference from the surface by joints alone
};

// Returns the rows of some vertices of a matrix with three rows per vertex.
MatrixXf rows_of(const MatrixXf& all, const std::vector<Index>& vertices) {
  MatrixXf some(static_cast<Index>(3 * vertices.size()), all.cols());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    some.middleRows<3>(static_cast<Index>(3 * i)) = all.middleRows<3>(3 * vertices[i]);
  }
  return some;
}

// Returns the vertices that move by more than `min` in a frame; adds the squares of the
// others to other_squares.
std::vector<Index> moving_vertices(const MatrixXf& moves, double min, double& other_squares) {
  std::vector<Index> vertices;
  for (Index v = 0; v < moves.rows() / 3; ++v) {
    const auto rows = moves.middleRows<3>(3 * v);
    if (std::sqrt(rows.colwise().squaredNorm().maxCoeff()) > static_cast<float>(min)) {
      vertices.push_back(v);
    } else {
      other_squares += rows.cast<double>().squaredNorm();
    }
  }
  return vertices;
}

// Adds targets that move only some vertices.
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

// Finds targets for all moves, then for large residuals. Vertices that barely move get none.
// moving: vertices of `moves`, out of `count`.
PrincipalShapes targets_for(MatrixXf moves, const std::vector<Index>& moving, Index count,
                            std::size_t max_targets) {
  PrincipalShapes shapes;
  shapes.unit = kNormalUnit;
  shapes.targets.resize(3 * count, 0);
  shapes.weights.resize(0, moves.cols());
  double squares = 0;
  std::vector<Index> vertices = moving_vertices(moves, kToleratedAngle, squares);
  MatrixXf some = rows_of(moves, vertices);
  for (Index& v : vertices) v = moving[static_cast<std::size_t>(v)];
  const double places = static_cast<double>(count * moves.cols());
  moves.resize(0, 0);
  const Index some_vertices = some.rows() / 3;
  const auto some_places = static_cast<double>(some_vertices * some.cols());
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
  const JointFrame joints(influences, maps);
  std::vector<float> rest;
  rest.reserve(normals.size());
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    for (const float x : at_rest(joints.back(vertex[i]), &normals[3 * i])) rest.push_back(x);
  }
  return rest;
}

NormalVertices normal_vertices(const GlbMesh& mesh, const SkinInfluences& influences,
                               std::span<const float> rest, const MatrixXf& missing) {
  const std::size_t count = rest.size() / 3;
  NormalVertices vertices{std::vector<bool>(count, false), std::vector<bool>(count, false)};
  const auto at = [&](auto&& xyz, std::uint32_t i) -> Vector3f {
    return Eigen::Map<const Vector3f>(&xyz[3 * std::size_t{mesh.vertex[i]}]);
  };
  std::vector<Steady> rigid;
  for (const GlbMesh::Part& part : mesh.parts) {
    for (const Triangle& t : part.triangles) {
      if (is_rigid(influences, mesh, t)) {
        const std::array<Vector3f, 3> p{at(rest, t[0]), at(rest, t[1]), at(rest, t[2])};
        rigid.push_back(
            {{mesh.vertex[t[0]], mesh.vertex[t[1]], mesh.vertex[t[2]]}, square_of_slack(p)});
        continue;
      }
      for (const std::uint32_t i : t) vertices.is_bent[mesh.vertex[i]] = true;
    }
  }
  vertices.is_moving = vertices.is_bent;
  widen(mesh, vertices.is_bent);
  for_ranges(rigid.size(), kTrianglesTogether, [&](std::size_t first, std::size_t end) {
    mark_unsteady(missing, std::span(rigid).subspan(first, end - first));
  });
  for (const Steady& triangle : rigid) {
    if (triangle.is_steady) continue;
    for (const std::uint32_t v : triangle.vertices) vertices.is_moving[v] = true;
  }
  widen(mesh, vertices.is_moving);
  return vertices;
}

SkinNormals skin_normals(const GltfLook& look, const SkinInfluences& influences,
                         std::span<const JointMaps> maps, std::span<const float> rest,
                         ShownFrames frames, const NormalVertices& vertices,
                         const NormalLimits& limits) {
  const SkinNormalMaker maker(look, influences, maps, rest, frames, vertices);
  SkinNormals normals;
  for (const Vector3f& n : maker.rest()) {
    normals.rest.insert(normals.rest.end(), n.begin(), n.end());
  }
  normals.moves.weights.resize(0, static_cast<Index>(frames.size()));
  if (limits.max_targets == 0) return normals;
  const std::vector<std::uint32_t>& vertex = look.mesh().vertex;
  std::vector<Index> moving;
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    if (vertices.is_moving[vertex[i]]) moving.push_back(static_cast<Index>(i));
  }
  normals.lacks_moves = 3 * moving.size() * sizeof(float) * frames.size() > limits.max_bytes;
  if (normals.lacks_moves) return normals;
  normals.moves = targets_for(maker.moves(moving), moving, static_cast<Index>(vertex.size()),
                              limits.max_targets);
  return normals;
}

}  // namespace rlpc
