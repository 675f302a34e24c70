#include "encoder/codec/kinds/skinned/input_rig.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "encoder/codec/kinds/skinned/fit/bone_stretch.h"
#include "encoder/codec/kinds/skinned/fit/rigid_motion.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);  // fixed: no bone
constexpr double kSame = 0.125;  // fixed: grid steps, below what rounding to the grid adds

Motion motion_of(const BoneMap& map) {
  Motion motion;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      motion(static_cast<int>(i), static_cast<int>(j)) = map[i][j];
    }
  }
  return motion;
}

// Whether no number is so large that positions are lost in rounding errors, or not finite:
// files may place bones that move nothing anywhere.
bool are_moderate(const SourceRig& source, std::span<const BoneMap> maps) {
  constexpr double kLargest = 1e30;  // fixed: a guard; squares and sums stay finite
  const auto is_moderate = [](double x) { return std::abs(x) <= kLargest; };
  return std::all_of(source.rest.begin(), source.rest.end(), is_moderate) &&
         std::all_of(source.bones.begin(), source.bones.end(),
                     [&](const SourceRig::Bone& bone) {
                       return std::all_of(bone.pivot.begin(), bone.pivot.end(), is_moderate);
                     }) &&
         std::all_of(maps.begin(), maps.end(), [&](const BoneMap& map) {
           return std::all_of(map.begin(), map.end(), [&](const auto& row) {
             return std::all_of(row.begin(), row.end(), is_moderate);
           });
         });
}

Vec3d point_of(const double* xyz) { return {xyz[0], xyz[1], xyz[2]}; }

// Returns the columns in the order and with the signs that make the rotation smallest.
Eigen::Matrix3d nearest_order(const Eigen::Matrix3d& axes) {
  constexpr double kBelowTraces = -4.0;  // fixed: those of matrices of unit vectors are above
  // fixed: all orders
  constexpr std::array<std::array<int, 3>, 6> kOrders{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  Eigen::Matrix3d best = axes;
  double largest_trace = kBelowTraces;
  for (const auto& order : kOrders) {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d turned;
      for (int c = 0; c < 3; ++c) {
        turned.col(c) = ((signs >> c & 1U) != 0 ? -1.0 : 1.0) *
                        axes.col(order[static_cast<std::size_t>(c)]);
      }
      const Vec3d third = cross_matrix(turned.col(0)) * turned.col(1);
      const bool is_rotation = third.dot(turned.col(2)) > 0.0;
      if (!is_rotation || turned.trace() <= largest_trace) continue;
      largest_trace = turned.trace();
      best = turned;
    }
  }
  return best;
}

// Makes the rig of a span from that of a source, which it keeps a reference to.
class RigMaker {
 public:
  RigMaker(const SourceRig& from, std::span<const BoneMap> maps, const Grid& grid)
      : from_(from), grid_(grid), per_step_(exact_exp2(-grid.log2_step)) {
    for (const BoneMap& map : maps) maps_.push_back(motion_of(map));
  }

  Rig make(std::span<const std::uint32_t> input_vertex, int position_bits, bool may_stretch) {
    points_ = points_of_bones();
    merge_still_bones();
    drop_idle_bones();
    const double growth = may_stretch ? find_growth() : 0.0;
    place_rest_shape(std::max(growth, 1.0), position_bits);
    if (growth > 0.0) find_stretched_bones();
    Rig rig;
    for (std::size_t b = 0; b < num_bones(); ++b) {
      if (is_kept_[b]) add_bone(b, rig);
    }
    for (const std::uint32_t v : input_vertex) {
      rig.rest.push_back(on_grid(placed(point_of(&from_.rest[3 * std::size_t{v}]))));
      rig.weights.push_back(weights_of(v));
    }
    return rig;
  }

 private:
  std::size_t num_bones() const { return from_.bones.size(); }
  std::size_t num_frames() const { return maps_.size() / num_bones(); }
  const Motion& map(std::size_t frame, std::size_t bone) const {
    return maps_[frame * num_bones() + bone];
  }

  Point on_grid(const Vec3d& p) const {
    Point result;
    for (std::size_t c = 0; c < 3; ++c) {
      result[c] = p(static_cast<int>(c)) * per_step_ - static_cast<double>(grid_.origin[c]);
    }
    return result;
  }

  // Returns the points that show how a bone moves: the corners of the box of its vertices, and
  // the joints of its children.
  std::vector<std::vector<Vec3d>> points_of_bones() const {
    std::vector<std::vector<Vec3d>> points(num_bones());
    std::vector<Vec3d> min(num_bones());
    std::vector<Vec3d> max(num_bones());
    std::vector<bool> has(num_bones());
    for (std::size_t v = 0; v + 1 < from_.first_influence.size(); ++v) {
      const Vec3d p = point_of(&from_.rest[3 * v]);
      for (auto i = from_.first_influence[v]; i < from_.first_influence[v + 1]; ++i) {
        const std::size_t b = from_.influences[i].bone;
        min[b] = has[b] ? Vec3d(min[b].cwiseMin(p)) : p;
        max[b] = has[b] ? Vec3d(max[b].cwiseMax(p)) : p;
        has[b] = true;
      }
    }
    for (std::size_t b = 0; b < num_bones(); ++b) {
      if (from_.bones[b].parent >= 0) {
        points[static_cast<std::size_t>(from_.bones[b].parent)].push_back(
            point_of(from_.bones[b].pivot.data()));
      }
      for (unsigned corner = 0; has[b] && corner < 8; ++corner) {
        Vec3d p;
        for (int c = 0; c < 3; ++c) p(c) = (corner >> c & 1U) != 0 ? max[b](c) : min[b](c);
        points[b].push_back(p);
      }
    }
    return points;
  }

  // Finds, for each bone, the one that it is merged with: itself, or one above it.
  void merge_still_bones() {
    bone_of_.resize(num_bones());
    for (std::size_t b = 0; b < num_bones(); ++b) {
      bone_of_[b] = b;
      if (from_.bones[b].parent < 0) continue;
      const std::size_t parent = bone_of_[static_cast<std::size_t>(from_.bones[b].parent)];
      if (is_still(parent, b, points_[b])) bone_of_[b] = parent;
    }
  }

  // Drops bones that no vertex follows, and that join fewer than two others.
  void drop_idle_bones() {
    is_kept_.assign(num_bones(), false);
    parent_.assign(num_bones(), kNone);
    std::vector<bool> has_vertices(num_bones());
    for (const SourceRig::Influence& i : from_.influences)
      has_vertices[bone_of_[i.bone]] = true;
    // Kept bones below each bone, with none kept between.
    std::vector<std::vector<std::size_t>> children(num_bones());
    for (std::size_t b = num_bones(); b-- > 0;) {
      if (bone_of_[b] != b) continue;
      std::vector<std::size_t> highest = std::move(children[b]);
      is_kept_[b] = has_vertices[b] || highest.size() > 1;
      if (is_kept_[b]) {
        for (const std::size_t child : highest) parent_[child] = b;
        highest = {b};
      }
      if (from_.bones[b].parent < 0) continue;
      auto& above = children[bone_of_[static_cast<std::size_t>(from_.bones[b].parent)]];
      above.insert(above.end(), highest.begin(), highest.end());
    }
  }

  bool is_still(std::size_t parent, std::size_t bone, std::span<const Vec3d> points) const {
    for (std::size_t f = 0; f < num_frames(); ++f) {
      for (const Vec3d& p : points) {
        const Vec3d gap = moved(map(f, bone), p) - moved(map(f, parent), p);
        if (!(gap.norm() * per_step_ <= kSame)) return false;
      }
    }
    return true;
  }

  // Returns what a bone is moved by after its own motion.
  Eigen::Matrix3d above(std::size_t bone, std::size_t frame) const {
    if (parent_[bone] == kNone) return Eigen::Matrix3d::Identity();
    return map(frame, parent_[bone]).leftCols<3>();
  }

  // Whether an error of the map of bone b, before its parent moves it, displaces any of its
  // points by more than rounding does.
  bool shows(const Eigen::Matrix3d& error, std::size_t b, std::size_t frame) const {
    const Vec3d pivot = point_of(from_.bones[b].pivot.data());
    const Eigen::Matrix3d displacement = times_ * above(b, frame) * error;
    return std::any_of(points_[b].begin(), points_[b].end(), [&](const Vec3d& p) {
      return !((displacement * (p - pivot)).norm() * per_step_ <= kSame);
    });
  }

  // Whether maps of bone b relative to its parent, [frame], are as good as rotations.
  bool are_rotations(std::size_t b, std::span<const Eigen::Matrix3d> local) const {
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    for (std::size_t f = 0; f < local.size(); ++f) {
      rotation = rotation_of(local[f], rotation);
      if (shows(local[f] - rotation, b, f)) return false;
    }
    return true;
  }

  // Finds out whether bones stretch, and returns how much larger they become than in the rest
  // shape of the source.
  double find_growth() {
    bool are_rigid = true;
    double largest = 1.0;
    for (std::size_t b = 0; b < num_bones(); ++b) {
      if (!is_kept_[b]) continue;
      are_rigid = are_rigid && are_rotations(b, local_maps(b));
      for (std::size_t f = 0; f < num_frames(); ++f) {
        for (int c = 0; c < 3; ++c) {
          largest = std::max(largest, map(f, b).row(c).head<3>().norm());
        }
      }
    }
    return are_rigid ? 0.0 : largest;
  }

  void find_stretched_bones() {
    own_stretch_.assign(num_bones(), Stretch::kNone);
    is_stretched_.assign(num_bones(), false);
    stretch_axes_.assign(num_bones(), Eigen::Matrix3d::Identity());
    for (std::size_t b = 0; b < num_bones(); ++b) {
      if (is_kept_[b]) find_stretch(b);
    }
  }

  // Returns the linear maps of a bone relative to its parent, [frame].
  std::vector<Eigen::Matrix3d> local_maps(std::size_t b) const {
    std::vector<Eigen::Matrix3d> local{Eigen::Matrix3d::Identity()};  // before the first
    for (std::size_t f = 0; f < num_frames(); ++f) {
      const Eigen::Matrix3d whole = map(f, b).leftCols<3>();
      local.push_back(parent_[b] == kNone ? whole : quotient(above(b, f), whole, local.back()));
    }
    local.erase(local.begin());
    return local;
  }

  // Puts the rest shape where its coordinates can be coded (8.10.2), if it is not: animations
  // may be far from it. Enlarges it by `times`, or as much as there is room for.
  void place_rest_shape(double times, int position_bits) {
    constexpr double kRoom = 0.99;  // fixed: for what fitting changes
    limit_ = kRoom * exact_exp2(position_bits) / per_step_;
    middle_ = Vec3d(grid_.origin[0], grid_.origin[1], grid_.origin[2]) / per_step_;
    Vec3d min = point_of(from_.rest.data());
    Vec3d max = min;
    for (std::size_t i = 0; i < from_.rest.size(); i += 3) {
      min = min.cwiseMin(point_of(&from_.rest[i]));
      max = max.cwiseMax(point_of(&from_.rest[i]));
    }
    const Vec3d half = 0.5 * (max - min);
    times_ = std::max(1.0, std::min(times, limit_ / half.maxCoeff()));
    centre_ = 0.5 * (min + max);
    const bool fits = ((centre_ - middle_).cwiseAbs() + times_ * half).maxCoeff() <= limit_;
    if (fits && times_ == 1.0) return;
    is_placed_ = true;
    new_centre_ = fits ? centre_ : middle_;
    for (Motion& m : maps_) {
      const Vec3d image = moved(m, centre_);
      m.leftCols<3>() /= times_;
      m.col(3) = image - m.leftCols<3>() * new_centre_;
    }
  }
  // Returns the place in the rest shape of a point of that of the source.
  Vec3d placed(const Vec3d& p) const {
    return is_placed_ ? Vec3d(new_centre_ + times_ * (p - centre_)) : p;
  }

  // Finds along which axes a bone stretches relative to its parent.
  void find_stretch(std::size_t b) {
    const std::vector<Eigen::Matrix3d> local = local_maps(b);
    const std::size_t parent = parent_[b];
    is_stretched_[b] = parent != kNone && is_stretched_[parent];
    if (are_rotations(b, local)) return;
    is_stretched_[b] = true;
    std::vector<Eigen::Matrix3d> stretches;
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    bool along_rest = true;
    for (std::size_t f = 0; f < local.size(); ++f) {
      rotation = rotation_of(local[f], rotation);
      const Eigen::Matrix3d stretch = rotation.transpose() * local[f];
      stretches.push_back(0.5 * (stretch + stretch.transpose()));
      Eigen::Matrix3d rest = stretches.back();
      rest.diagonal().setZero();
      along_rest = along_rest && !shows(rotation * rest, b, f);
    }
    own_stretch_[b] = along_rest ? Stretch::kRestAxes : Stretch::kOwnAxes;
    if (!along_rest) stretch_axes_[b] = nearest_order(common_axes(stretches));
  }

  void add_bone(std::size_t b, Rig& rig) {
    place_.resize(num_bones());
    place_[b] = static_cast<std::uint32_t>(rig.bones.size());
    RigBone& bone = rig.bones.emplace_back();
    if (parent_[b] != kNone) bone.parent = static_cast<std::int32_t>(place_[parent_[b]]);
    // A pivot that cannot be coded is replaced: its bone moves any other as well.
    const Vec3d room = Vec3d::Constant(limit_);
    const Vec3d pivot = placed(point_of(from_.bones[b].pivot.data()))
                            .cwiseMax(middle_ - room)
                            .cwiseMin(middle_ + room);
    bone.pivot = on_grid(pivot);
    const bool is_stretched = !is_stretched_.empty() && is_stretched_[b];
    if (is_stretched) {
      bone.stretch = own_stretch_[b];
      bone.stretch_turn = rotation_quaternion(stretch_axes_[b]);
    }
    Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
    for (std::size_t f = 0; f < num_frames(); ++f) {
      rotation = closest_rotation(map(f, b).leftCols<3>(), rotation);
      RigPose pose{rotation_quaternion(rotation), on_grid(moved(map(f, b), pivot))};
      if (!bone.poses.empty()) keep_sign(bone.poses.back().rotation, pose.rotation);
      bone.poses.push_back(pose);
      if (is_stretched) bone.axes.push_back(images_of(map(f, b).leftCols<3>()));
    }
  }

  std::vector<RigWeight> weights_of(std::uint32_t v) const {
    std::vector<RigWeight> weights;
    double sum = 0.0;
    for (auto i = from_.first_influence[v]; i < from_.first_influence[v + 1]; ++i) {
      const std::uint32_t bone = place_[bone_of_[from_.influences[i].bone]];
      const auto weight = static_cast<double>(from_.influences[i].weight);
      const auto same = std::find_if(weights.begin(), weights.end(),
                                     [&](const RigWeight& w) { return w.bone == bone; });
      if (same == weights.end()) {
        weights.push_back({bone, weight});
      } else {
        same->weight += weight;
      }
    }
    std::stable_sort(
        weights.begin(), weights.end(),
        [](const RigWeight& a, const RigWeight& b) { return a.weight > b.weight; });
    if (weights.size() > kMaxExtraBones) weights.resize(kMaxExtraBones);
    for (const RigWeight& w : weights) sum += w.weight;
    for (RigWeight& w : weights) w.weight /= sum;
    return weights;
  }

  const SourceRig& from_;
  const Grid& grid_;
  double per_step_;
  std::vector<Motion> maps_;                // [frame][bone]
  std::vector<std::size_t> bone_of_;        // [bone], the one that it is merged with, or itself
  std::vector<bool> is_kept_;               // [bone]
  std::vector<std::size_t> parent_;         // [bone], those kept; kNone: none
  std::vector<std::uint32_t> place_;        // [bone] of the source, its index in the rig
  std::vector<std::vector<Vec3d>> points_;  // [bone]: points_of_bones()
  std::vector<Stretch> own_stretch_;        // [bone]; empty: no bone stretches
  std::vector<bool> is_stretched_;          // [bone]: by itself or with one above it
  std::vector<Eigen::Matrix3d> stretch_axes_;  // [bone]: columns
  Vec3d middle_ = Vec3d::Zero();               // of the coordinates that can be coded
  double limit_ = 0.0;                         // largest distance from it on an axis
  bool is_placed_ = false;        // the rest shape is not where that of the source is
  Vec3d centre_ = Vec3d::Zero();  // of the rest shape in the source
  Vec3d new_centre_ = Vec3d::Zero();
  double times_ = 1.0;  // as large as in the source
};

}  // namespace

std::shared_ptr<const Rig> rig_of_span(const SourceRig& source, std::span<const BoneMap> maps,
                                       const SequenceHeader& header,
                                       std::span<const std::uint32_t> input_vertex,
                                       bool may_stretch) {
  if (!are_moderate(source, maps)) return nullptr;
  auto rig = std::make_shared<Rig>(RigMaker(source, maps, header.grid)
                                       .make(input_vertex, header.position_bits, may_stretch));
  const std::size_t count = rig->bones.size();
  if (count < 2 || count > kLevels.back().max_clusters) return nullptr;
  return rig;
}

std::uint64_t pose_bytes(std::size_t num_bones) {
  // While the rig is made, maps and motions; then the rig, the same without its stretches, and
  // two candidates of the search.
  return (sizeof(BoneMap) + sizeof(Motion) + 4 * (sizeof(RigPose) + sizeof(AxisImages))) *
         num_bones;
}

}  // namespace rlpc
