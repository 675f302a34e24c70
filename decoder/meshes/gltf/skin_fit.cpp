// Fits the joints in turn, several times, each to the residual of the others at its vertices
// (after Le and Deng 2012).
#include "decoder/meshes/gltf/skin_fit.h"

#include <cstddef>
#include <cstdint>

namespace rlpc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kMaxSweeps = 8;
constexpr double kEnoughGain = 0.98;  // ratio of the sums of squares after and before a sweep
// Weight with which a joint with too few vertices to determine its rotation keeps the old one.
constexpr double kInertia = 1e-4;

struct Member {
  std::uint32_t vertex;
  double weight;
};

Vector3d moved(const JointMap& map, const Vector3d& p) {
  return map.leftCols<3>() * p + map.col(3);
}

// Computes a rigid motion from sums over weighted pairs of points.
class RigidFit {
 public:
  void add(const Vector3d& from, const Vector3d& to, double weight) {
    weight_ += weight;
    from_ += weight * from;
    to_ += weight * to;
    products_ += weight * from * to.transpose();
    spread_ += weight * from.squaredNorm();
  }

  // Returns the map, near `before` where the pairs do not determine it.
  JointMap map(const JointMap& before) const {
    if (weight_ <= 0) return before;
    const Vector3d from = from_ / weight_;
    const Vector3d to = to_ / weight_;
    const double spread = spread_ - weight_ * from.squaredNorm();
    const Matrix3d about_centre = products_ - weight_ * from * to.transpose() +
                                  kInertia * spread * before.leftCols<3>().transpose();
    const Eigen::JacobiSVD<Matrix3d> svd(about_centre,
                                         Eigen::ComputeFullU | Eigen::ComputeFullV);
    Vector3d signs(1, 1, 1);
    if ((svd.matrixV() * svd.matrixU().transpose()).determinant() < 0) signs[2] = -1;
    JointMap map;
    map.leftCols<3>() = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
    map.col(3) = to - map.leftCols<3>() * from;
    return map;
  }

 private:
  double weight_ = 0;
  Vector3d from_ = Vector3d::Zero();
  Vector3d to_ = Vector3d::Zero();
  Matrix3d products_ = Matrix3d::Zero();
  double spread_ = 0;
};

class PoseFit {
 public:
  PoseFit(const SkinInfluences& influences, std::size_t num_joints,
          const std::vector<float>& rest)
      : members_(num_joints) {
    for (std::uint32_t v = 0; v < rest.size() / 3; ++v) {
      const float* const xyz = &rest[3 * std::size_t{v}];
      rest_.emplace_back(xyz[0], xyz[1], xyz[2]);
      for (std::size_t k = kJointsOfVertex * v; k < kJointsOfVertex * (v + 1); ++k) {
        if (influences.weights[k] == 0) continue;
        members_[influences.joints[k]].push_back(
            {v, influences.weights[k] * (1.0 / influences.whole)});
      }
    }
  }

  // Fits the maps. maps: initial guess, then result.
  void fit(const std::vector<float>& xyz, JointMaps& maps) {
    start(xyz, maps);
    double before = squares(xyz);
    for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
      for (std::size_t j = 0; j < maps.size(); ++j) fit_joint(xyz, j, maps[j]);
      const double after = squares(xyz);
      if (after > kEnoughGain * before) break;
      before = after;
    }
  }

 private:
  static Vector3d point(const std::vector<float>& xyz, std::size_t v) {
    return {xyz[3 * v], xyz[3 * v + 1], xyz[3 * v + 2]};
  }

  // Fits each joint as if it alone moved its vertices.
  void start(const std::vector<float>& xyz, JointMaps& maps) {
    places_.assign(rest_.size(), Vector3d::Zero());
    for (std::size_t j = 0; j < maps.size(); ++j) {
      RigidFit fit;
      for (const auto& [v, weight] : members_[j]) {
        fit.add(rest_[v], point(xyz, v), weight * weight * weight);
      }
      maps[j] = fit.map(maps[j]);
      for (const auto& [v, weight] : members_[j]) {
        places_[v] += weight * moved(maps[j], rest_[v]);
      }
    }
  }

  void fit_joint(const std::vector<float>& xyz, std::size_t j, JointMap& map) {
    RigidFit fit;
    for (const auto& [v, weight] : members_[j]) {
      const Vector3d missing = point(xyz, v) - places_[v];
      fit.add(rest_[v], moved(map, rest_[v]) + missing / weight, weight * weight);
    }
    const JointMap fitted = fit.map(map);
    for (const auto& [v, weight] : members_[j]) {
      places_[v] += weight * (moved(fitted, rest_[v]) - moved(map, rest_[v]));
    }
    map = fitted;
  }

  double squares(const std::vector<float>& xyz) const {
    double sum = 0;
    for (std::size_t v = 0; v < rest_.size(); ++v) {
      sum += (point(xyz, v) - places_[v]).squaredNorm();
    }
    return sum;
  }

  std::vector<std::vector<Member>> members_;  // [joint]
  std::vector<Vector3d> rest_;
  std::vector<Vector3d> places_;  // [vertex] place by the current maps
};

}  // namespace

void fit_places(const Skeleton& skeleton, const Grid& grid, const SkinInfluences& influences,
                ShownFrames frames, std::vector<JointPlaces>& places) {
  JointPlaces bind;
  for (const SkeletonBone& bone : skeleton.bones) bind.push_back(joint_place(bone.bind, grid));
  std::vector<JointMaps> known;
  std::vector<std::vector<float>> known_frames;
  for (std::size_t f = 0; f < places.size(); ++f) {
    if (places[f].empty()) continue;
    JointMaps& maps = known.emplace_back();
    for (std::size_t j = 0; j < bind.size(); ++j) {
      maps.push_back(map_of_place(places[f][j].after(bind[j].inverse())));
    }
    known_frames.push_back(frames[f]);
  }
  if (known.size() == places.size()) return;
  PoseFit fit(influences, bind.size(), best_rest(influences, known, known_frames));
  JointMaps maps = known.front();
  for (std::size_t f = 0; f < places.size(); ++f) {
    if (!places[f].empty()) continue;
    fit.fit(frames[f], maps);
    for (std::size_t j = 0; j < bind.size(); ++j) {
      const JointPlace moved{maps[j].leftCols<3>(), maps[j].col(3)};
      places[f].push_back(moved.after(bind[j]));
    }
  }
}

}  // namespace rlpc
