#include "encoder/codec/kinds/skinned/recover/bone_placement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/recover/bone_links.h"
#include "encoder/codec/kinds/skinned/recover/damping.h"
#include "encoder/codec/kinds/skinned/recover/point_equations.h"
#include "encoder/codec/kinds/skinned/recover/robust_error.h"
#include "encoder/codec/kinds/skinned/recover/skin_vertex.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

constexpr std::size_t kUnknowns = PlacedBones::kUnknowns;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Returns the rotations that map a cube onto itself, the identity first.
std::vector<Eigen::Matrix3d> rotations_of_cube() {
  std::vector<Eigen::Matrix3d> rotations;
  std::array<Eigen::Index, 3> axis{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d m = Eigen::Matrix3d::Zero();
      for (unsigned c = 0; c < 3; ++c) m(axis[c], c) = (signs >> c & 1U) != 0 ? -1.0 : 1.0;
      const Vec3d third = cross_matrix(m.col(0)) * m.col(1);
      if (third.dot(m.col(2)) > 0.0) rotations.push_back(m);
    }
  } while (std::next_permutation(axis.begin(), axis.end()));
  return rotations;
}

std::vector<std::uint32_t> some_of(const std::vector<std::uint32_t>& all, std::size_t max) {
  std::vector<std::uint32_t> some;
  const std::size_t count = std::min(all.size(), max);
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

// Moves a part of the rest shape, so that vertices between it and the rest are explained.
class Joining {
 public:
  // moved: the bones of the part
  Joining(const Trajectories& t, const PlacedBones& bones, std::vector<std::size_t> moved)
      : t_(&t), bones_(bones), moved_(std::move(moved)) {}

  // Fits vertices that follow two bones, from where either has them in the rest shape.
  void fit(const std::vector<std::uint32_t>& vertices, std::size_t first, std::size_t second) {
    constexpr int kRounds = 2;  // fixed: time
    const auto a = static_cast<std::uint32_t>(first);
    const auto b = static_cast<std::uint32_t>(second);
    vertices_.clear();
    for (const std::uint32_t v : vertices) {
      SkinVertex vertex(bones_, t_->of(v), {std::min(a, b), std::max(a, b)});
      SkinVertex other = vertex;
      const Vec3d place = t_->position(0, v);
      vertex.return_to({bones_.rest_of(first, place), {}, 0.0});
      other.return_to({bones_.rest_of(second, place), {}, 0.0});
      vertex.fit(bones_, kRounds);
      other.fit(bones_, kRounds);
      const bool is_better = other.fitted().squared_error < vertex.fitted().squared_error;
      vertices_.push_back(is_better ? std::move(other) : std::move(vertex));
    }
  }

  std::vector<double> errors() const {
    std::vector<double> errors;
    for (const SkinVertex& v : vertices_) {
      const auto count = 3.0 * static_cast<double>(t_->num_frames());
      errors.push_back(std::sqrt(v.fitted().squared_error / count));
    }
    return errors;
  }

  // Takes steps as long as they lower the errors.
  void improve() {
    constexpr int kMaxSteps = 20;           // fixed: time
    constexpr double kStalled = 0.999;      // fixed: part of the cost that a step may leave
    constexpr double kFirstDamping = 1e-2;  // fixed: the start may be far off
    constexpr int kRounds = 2;              // fixed: vertices change little
    const double scale = robust_scale(errors());
    double before = robust_cost(errors(), scale);
    Damping damping(kFirstDamping);
    for (int i = 0; i < kMaxSteps && !damping.is_spent(); ++i) {
      Joining next = *this;
      next.step(damping.value(), scale);
      for (SkinVertex& v : next.vertices_) v.fit(next.bones_, kRounds);
      const double after = robust_cost(next.errors(), scale);
      if (!(after < before)) {
        damping.tighten();
        continue;
      }
      *this = std::move(next);
      if (after > kStalled * before) break;
      before = after;
      damping.relax();
    }
  }

  const PlacedBones& bones() const { return bones_; }

 private:
  void step(double damping, double scale) {
    constexpr double kFloor = 1e-7;  // fixed: what nothing determines stays
    const Vec3d centre = bones_.pivot(moved_.front());
    Matrix6 a = Matrix6::Zero();
    Vector6 b = Vector6::Zero();
    const std::vector<double> errors = this->errors();
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const SkinVertex& v = vertices_[i];
      if (v.fitted().weights.size() < 2) continue;  // any place of its bone is as good
      const StepEquations e = point_equations(
          bones_, {v.part(), v.fitted().weights, v.fitted().rest, v.wanted(), true});
      add(e, centre, robust_weight(errors[i], scale), a, b);
    }
    const double floor = kFloor * a.trace();
    std::vector<double> system(kUnknowns * kUnknowns);
    for (std::size_t i = 0; i < system.size(); ++i) {
      system[i] =
          a(static_cast<Eigen::Index>(i / kUnknowns), static_cast<Eigen::Index>(i % kUnknowns));
    }
    for (std::size_t i = 0; i < kUnknowns; ++i) {
      double& own = system[i * (kUnknowns + 1)];
      own = own * (1.0 + damping) + floor;
    }
    std::vector<double> x(b.data(), b.data() + kUnknowns);
    SymmetricSystem(std::move(system), kUnknowns).solve(x);
    bones_.move_rest(moved_, small_rotation(Vec3d(x[0], x[1], x[2])), centre,
                     centre + Vec3d(x[3], x[4], x[5]));
  }

  // Adds the equations of a vertex. If a part turns about a centre and is shifted, the pivots
  // of its bones move as well.
  void add(const StepEquations& e, const Vec3d& centre, double weight, Matrix6& a,
           Vector6& b) const {
    const std::size_t count = e.unknowns.size();
    std::vector<std::pair<std::size_t, Matrix6>> derivatives;  // and the first unknown of each
    for (std::size_t p = 0; p < count; p += kUnknowns) {
      const std::size_t bone = e.unknowns[p] / kUnknowns;
      if (std::find(moved_.begin(), moved_.end(), bone) == moved_.end()) continue;
      Matrix6 d = Matrix6::Identity();
      d.block<3, 3>(3, 0) = cross_matrix(bones_.pivot(bone) - centre);
      derivatives.emplace_back(p, d);
    }
    for (const auto& [p, dp] : derivatives) {
      b += weight * (dp.transpose() * Eigen::Map<const Vector6>(&e.b[p]));
      for (const auto& [q, dq] : derivatives) {
        Matrix6 block;
        for (std::size_t i = 0; i < kUnknowns; ++i) {
          for (std::size_t j = 0; j < kUnknowns; ++j) {
            block(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) =
                e.a[(p + i) * count + q + j];
          }
        }
        a += weight * (dp.transpose() * block * dq);
      }
    }
  }

  const Trajectories* t_;
  PlacedBones bones_;
  std::vector<std::size_t> moved_;
  std::vector<SkinVertex> vertices_;
};

class Placement {
 public:
  Placement(const Trajectories& t, const BoneChains& chains, BoneSpace& space,
            PlacedBones& bones)
      : t_(t),
        chains_(chains),
        space_(space),
        bones_(bones),
        links_(t, chains, space),
        is_tried_(space.num_bones() * space.num_bones(), 0),
        part_(space.num_bones(), BoneChains::kNone) {}

  void run() {
    for (const std::size_t b : space_.order()) {
      part_[b] = parts_.size();
      parts_.push_back({b});
    }
    for (const std::size_t b : space_.order()) links_.add(bones_, b);
    for (Link link = next_link(); link.count > 0; link = next_link()) {
      is_tried_[link.first * part_.size() + link.second] = 1;
      is_tried_[link.second * part_.size() + link.first] = 1;
      join(link.first, link.second);
    }
    hang_others();
  }

 private:
  // tuned: Vertices between bones that tell how they are joined. There are six unknowns, and a
  // vertex at a hinge tells one.
  static constexpr std::size_t kFew = 8;

  struct Link {
    std::size_t first = 0;  // its bone has a place
    std::size_t second = 0;
    std::size_t count = 0;  // 0: there is none
  };

  // Returns the link with most vertices between bones that are not in one part yet.
  Link next_link() const {
    Link best;
    for (std::size_t a = 0; a < part_.size(); ++a) {
      for (std::size_t b = 0; b < part_.size(); ++b) {
        if (part_[a] == BoneChains::kNone || part_[a] == part_[b]) continue;
        const std::size_t count = links_.between(a, b).size();
        if (is_tried_[a * part_.size() + b] != 0 || count < kFew || count <= best.count)
          continue;
        best = {a, b, count};
      }
    }
    return best;
  }

  // Joins a bone, or its part, to the part of another bone, if their vertices then move
  // exactly.
  void join(std::size_t first, std::size_t second) {
    constexpr std::size_t kMany = 60;  // fixed: time; vertices for six unknowns
    constexpr double kExact = 1e-4;    // fixed: extents; a tenth of the error at KG 0.1 %
    constexpr double kShare = 0.9;     // fixed: of exact vertices; others follow more bones
    const auto vertices = some_of(links_.between(first, second), kMany);
    const bool is_hung = part_[second] == BoneChains::kNone;
    if (is_hung) {
      space_.hang(second, first);
    } else if (parts_[part_[second]].size() > parts_[part_[first]].size()) {
      std::swap(first, second);
    }
    const std::vector<std::size_t> moved =
        is_hung ? std::vector{second} : parts_[part_[second]];
    Joining best(t_, bones_, moved);
    double min = std::numeric_limits<double>::infinity();
    for (const PlacedBones& start : starts(first, second, moved, vertices)) {
      Joining joining(t_, start, moved);
      joining.fit(vertices, first, second);
      joining.improve();
      const double cost = robust_cost(joining.errors(), kExact);
      if (!(cost < min)) continue;
      min = cost;
      best = std::move(joining);
      if (is_exact(best.errors(), kExact, 1.0)) break;
    }
    if (!is_exact(best.errors(), kExact, kShare)) {
      if (is_hung) space_.let_go(second);
      return;
    }
    bones_ = best.bones();
    if (!is_hung) parts_[part_[second]].clear();
    for (const std::size_t b : moved) {
      part_[b] = part_[first];
      parts_[part_[first]].push_back(b);
    }
    if (is_hung) links_.add(bones_, second);
  }

  static bool is_exact(const std::vector<double>& errors, double exact, double share) {
    const auto count =
        std::count_if(errors.begin(), errors.end(), [&](double e) { return e < exact; });
    return static_cast<double>(count) >= share * static_cast<double>(errors.size());
  }

  // Returns where to start, the likeliest first: bones usually turn little. They are where
  // their vertices are in the first frame.
  std::vector<PlacedBones> starts(std::size_t first, std::size_t second,
                                  const std::vector<std::size_t>& moved,
                                  const std::vector<std::uint32_t>& vertices) const {
    constexpr std::size_t kLookedAt = 24;  // fixed: time; vertices by which starts are compared
    constexpr std::size_t kStarts = 7;     // fixed: time
    constexpr double kNear = 1e-3;         // fixed: extents; the error at KG 0.1 %
    Vec3d place = Vec3d::Zero();
    for (const std::uint32_t v : vertices) {
      place += t_.position(0, v) / static_cast<double>(vertices.size());
    }
    const std::vector<std::uint32_t> few = some_of(vertices, kLookedAt);
    const std::vector<Eigen::Matrix3d> rotations = rotations_of_cube();
    std::vector<PlacedBones> all(rotations.size(), bones_);
    std::vector<double> cost(rotations.size());
    for_each(rotations.size(), [&](std::size_t i) {
      PlacedBones& bones = all[i];
      const Eigen::Matrix3d turn = rotations[i] * bones.turn(first);
      const Vec3d at = bones.rest_of(first, place);
      if (part_[second] == BoneChains::kNone) {
        bones.put(second, turn, at);
      } else {
        bones.move_rest(moved, bones.turn(second).transpose() * turn,
                        bones.rest_of(second, place), at);
      }
      Joining joining(t_, bones, moved);
      joining.fit(few, first, second);
      cost[i] = robust_cost(joining.errors(), kNear);
    });
    std::vector<std::size_t> order(rotations.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin() + 1, order.end(),
                     [&](std::size_t x, std::size_t y) { return cost[x] < cost[y]; });
    std::vector<PlacedBones> best;
    for (std::size_t k = 0; k < kStarts; ++k) best.push_back(all[order[k]]);
    return best;
  }

  void hang_others() {
    for (const std::size_t b : chains_.order) {
      if (space_.has_place(b)) continue;
      const std::size_t parent = chains_.bones[b].parent;
      space_.hang(b, parent);
      bones_.put(b, bones_.turn(parent), bones_.rest_of(parent, chains_.bones[b].pivot));
    }
  }

  const Trajectories& t_;
  const BoneChains& chains_;
  BoneSpace& space_;
  PlacedBones& bones_;
  BoneLinks links_;
  std::vector<char> is_tried_;                   // [bone][bone]
  std::vector<std::size_t> part_;                // [bone]; kNone: it has no place
  std::vector<std::vector<std::size_t>> parts_;  // bones that move together
};

}  // namespace

void place_bones(const Trajectories& trajectories, const BoneChains& chains, BoneSpace& space,
                 PlacedBones& bones) {
  Placement(trajectories, chains, space, bones).run();
}

}  // namespace rlpc
