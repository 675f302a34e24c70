#include "encoder/codec/kinds/skinned/recover/chain_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <span>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/recover/damping.h"
#include "encoder/codec/kinds/skinned/recover/point_equations.h"
#include "encoder/codec/kinds/skinned/recover/robust_error.h"
#include "encoder/codec/math/symmetric_system.h"

namespace rlpc {
namespace {

constexpr std::size_t kTogether = 32;  // fixed: vertices of a pass
constexpr double kExact = 1e-4;        // fixed: extents; a tenth of the error at KG 0.1 %

// A point that should move alike with two bones.
class JointPoint {
 public:
  JointPoint(const PlacedBones& bones, const BoneChains::Joint& joint)
      : at_(bones.rest_of(joint.first, joint.at)),
        ends_{RigWeight{static_cast<std::uint32_t>(joint.first), 1.0},
              RigWeight{static_cast<std::uint32_t>(joint.second), -1.0}},
        part_(bones.space().part({std::min(ends_[0].bone, ends_[1].bone),
                                  std::max(ends_[0].bone, ends_[1].bone)})) {}

  FollowingPoint point() const { return {part_, ends_, at_, {}, false}; }

  // Returns the squared distance between the places to which the bones move it.
  double gap(const PlacedBones& bones) const {
    const std::vector<double> x = moved(bones);
    const std::vector<double> gx = times(part_.gram, x);
    double sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * gx[i];
    return std::max(sum, 0.0);  // negative only by rounding
  }

  // Moves it to where the distance is least.
  void fit(const PlacedBones& bones) {
    constexpr double kPull = 1e-6;    // fixed: of a hinge, the nearest point of the axis
    constexpr double kStill = 1e-12;  // fixed: bones that turn less together share all points
    std::vector<double> turns(part_.size() * 3, 0.0);
    for (const RigWeight& end : ends_) {
      add_block(end.weight * bones.turn(end.bone), part_.place(end.bone), 0, 3, turns);
    }
    std::vector<double> left = times(part_.gram, moved(bones));
    for (double& value : left) value = -value;
    NormalEquations e = normal_equations(part_.gram, turns, left, 3);
    const double trace = e.a[0] + e.a[4] + e.a[8];
    for (std::size_t i = 0; i < 3; ++i) e.a[4 * i] += kPull * trace + kStill;
    SymmetricSystem(std::move(e.a), 3).solve(e.b);
    at_ += Vec3d(e.b[0], e.b[1], e.b[2]);
  }

 private:
  std::vector<double> moved(const PlacedBones& bones) const {
    std::vector<double> x(part_.size(), 0.0);
    for (const RigWeight& end : ends_) bones.add_moved(part_, end.bone, at_, end.weight, x);
    return x;
  }

  Vec3d at_;  // in the rest shape
  std::array<RigWeight, 2> ends_;
  BoneSpace::Part part_;
};

class ChainFit {
 public:
  ChainFit(const Trajectories& t, const BoneChains& chains, PlacedBones& bones)
      : t_(t), bones_(bones) {
    for (const auto& list : chains.candidates) {
      std::vector<std::uint32_t>& kept = candidates_.emplace_back();
      for (const std::uint32_t b : list) {
        if (bones.space().has_place(b)) kept.push_back(b);
      }
    }
    for (const BoneChains::Joint& joint : chains.joints) joints_.emplace_back(bones, joint);
  }

  Skin run() {
    look_at_some();
    place_bones();
    return fit_all();
  }

 private:
  static constexpr int kRounds = 4;  // fixed: of a fit from anew; the error then falls slowly

  SkinVertex vertex(std::uint32_t v) const {
    return SkinVertex(bones_, t_.of(v), candidates_[v]);
  }
  double rms(double squared_error) const {
    return std::sqrt(squared_error / (3.0 * static_cast<double>(t_.num_frames())));
  }
  double rms(const SkinVertex& vertex) const { return rms(vertex.fitted().squared_error); }

  void look_at_some() {
    constexpr std::size_t kSome = 3000;  // fixed: time and memory
    const std::size_t n = t_.num_vertices();
    const std::size_t count = std::min(n, kSome);
    for (std::size_t i = 0; i < count; ++i) {
      looked_at_.push_back(static_cast<std::uint32_t>(i * n / count));
    }
    std::vector<std::optional<SkinVertex>> made(count);
    for_ranges(count, kTogether, [&](std::size_t first, std::size_t end) {
      for (std::size_t i = first; i < end; ++i) {
        made[i].emplace(vertex(looked_at_[i]));
        made[i]->fit(bones_, kRounds);
      }
    });
    for (auto& v : made) vertices_.push_back(std::move(*v));
  }

  // Improves the bones and offers others to vertices that are explained badly, in turn.
  void place_bones() {
    constexpr int kMaxTurns = 4;        // fixed: time; two or three are usual
    constexpr double kProgress = 0.95;  // fixed: part of the bad vertices that a turn may leave
    double allowed = static_cast<double>(vertices_.size());
    for (int turn = 0; turn < kMaxTurns; ++turn) {
      sample_.clear();
      for (std::size_t i = 0; i < vertices_.size(); ++i) {
        if (vertices_[i].may_blend()) sample_.push_back(i);
      }
      if (sample_.empty()) break;
      improve();
      std::vector<std::size_t> all(vertices_.size());
      std::iota(all.begin(), all.end(), std::size_t{0});
      fit(all, kRounds);
      std::vector<std::size_t> bad;
      for (const std::size_t i : all) {
        if (rms(vertices_[i]) > kExact) bad.push_back(i);
      }
      if (bad.empty() || static_cast<double>(bad.size()) > allowed) break;
      allowed = kProgress * static_cast<double>(bad.size());
      for_ranges(bad.size(), kTogether, [&](std::size_t first, std::size_t end) {
        for (std::size_t k = first; k < end; ++k) vertices_[bad[k]].widen(bones_);
      });
      fit(bad, kRounds);
    }
  }

  void fit(std::span<const std::size_t> which, int rounds) {
    for_ranges(which.size(), kTogether, [&](std::size_t first, std::size_t end) {
      for (std::size_t k = first; k < end; ++k) vertices_[which[k]].fit(bones_, rounds);
    });
  }

  std::vector<double> errors() const {  // of the sample
    std::vector<double> errors;
    for (const std::size_t i : sample_) errors.push_back(rms(vertices_[i]));
    return errors;
  }

  double cost(double scale) const {
    std::vector<double> gaps;
    for (const JointPoint& joint : joints_) gaps.push_back(rms(joint.gap(bones_)));
    return robust_cost(errors(), scale) + kJoint * robust_cost(gaps, scale);
  }

  // Takes steps as long as they lower the cost.
  void improve() {
    constexpr int kMaxSteps = 40;  // fixed: time
    constexpr int kScaled = 5;     // fixed: steps with one scale
    constexpr int kFitted = 2;     // fixed: rounds after a step; vertices change little
    constexpr double kFirstDamping = 1e-2;  // fixed: the start may be far off
    // tuned: Part of the cost that the steps with one scale may leave, or no more are taken.
    constexpr double kStalled = 0.995;
    double now = robust_scale(errors());
    double start = cost(now);
    double before = start;
    Damping damping(kFirstDamping);
    for (int i = 1; i <= kMaxSteps && !damping.is_spent(); ++i) {
      const PlacedBones bones = bones_;
      const std::vector<JointPoint> joints = joints_;
      std::vector<SkinVertex::Fit> fits;
      for (const std::size_t k : sample_) fits.push_back(vertices_[k].fitted());
      step(damping.value(), now);
      fit(sample_, kFitted);
      for (JointPoint& joint : joints_) joint.fit(bones_);
      const double after = cost(now);
      if (after < before) {
        before = after;
        damping.relax();
      } else {
        bones_ = bones;
        joints_ = joints;
        for (std::size_t k = 0; k < sample_.size(); ++k) {
          vertices_[sample_[k]].return_to(std::move(fits[k]));
        }
        damping.tighten();
      }
      if (i % kScaled != 0) continue;
      if (before > kStalled * start) break;
      now = robust_scale(errors());
      start = before = cost(now);
    }
  }

  void step(double damping, double scale) {
    const std::size_t n = PlacedBones::kUnknowns * bones_.space().num_bones();
    std::vector<double> system(n * n, 0.0);
    std::vector<double> right(n, 0.0);
    const auto add = [&](const StepEquations& e, double error, double weight) {
      weight *= robust_weight(error, scale);
      const std::size_t count = e.unknowns.size();
      for (std::size_t p = 0; p < count; ++p) {
        right[e.unknowns[p]] += weight * e.b[p];
        for (std::size_t q = 0; q < count; ++q) {
          system[e.unknowns[p] * n + e.unknowns[q]] += weight * e.a[p * count + q];
        }
      }
    };
    constexpr std::size_t kHeld = 64;  // fixed: memory; vertices whose equations are held
    std::array<StepEquations, kHeld> equations;
    for (std::size_t begin = 0; begin < sample_.size(); begin += kHeld) {
      const std::size_t count = std::min(kHeld, sample_.size() - begin);
      for_each(count, [&](std::size_t i) {
        const SkinVertex& v = vertices_[sample_[begin + i]];
        equations[i] = {};
        if (v.fitted().weights.size() < 2) return;  // any place of its bone is as good
        equations[i] = point_equations(
            bones_, {v.part(), v.fitted().weights, v.fitted().rest, v.wanted(), true});
      });
      for (std::size_t i = 0; i < count; ++i) {
        add(equations[i], rms(vertices_[sample_[begin + i]]), 1.0);
      }
    }
    for (const JointPoint& joint : joints_) {
      add(point_equations(bones_, joint.point()), rms(joint.gap(bones_)), kJoint);
    }
    constexpr double kFloor = 1e-7;  // fixed: what nothing determines stays
    double mean = 0.0;
    for (std::size_t i = 0; i < n; ++i) mean += system[i * n + i] / static_cast<double>(n);
    for (std::size_t i = 0; i < n; ++i) {
      system[i * n + i] = system[i * n + i] * (1.0 + damping) + kFloor * mean;
    }
    SymmetricSystem(std::move(system), n).solve(right);
    bones_.move(right);
  }

  Skin fit_all() const {
    const std::size_t n = t_.num_vertices();
    Skin skin{std::vector<Vec3d>(n), std::vector<std::vector<RigWeight>>(n), 0};
    std::vector<double> error(n);
    const auto take = [&](std::uint32_t v, const SkinVertex& vertex) {
      skin.rest[v] = vertex.fitted().rest;
      skin.weights[v] = vertex.fitted().weights;
      error[v] = rms(vertex);
    };
    std::vector<bool> is_fitted(n);
    for (std::size_t i = 0; i < looked_at_.size(); ++i) {
      take(looked_at_[i], vertices_[i]);
      is_fitted[looked_at_[i]] = true;
    }
    for_ranges(n, kTogether, [&](std::size_t first, std::size_t end) {
      for (std::size_t k = first; k < end; ++k) {
        if (is_fitted[k]) continue;
        const auto v = static_cast<std::uint32_t>(k);
        SkinVertex made = vertex(v);
        made.fit(bones_, kRounds);
        if (rms(made) > kExact) {
          made.widen(bones_);
          made.fit(bones_, kRounds);
        }
        take(v, made);
      }
    });
    skin.num_exact = static_cast<std::size_t>(
        std::count_if(error.begin(), error.end(), [](double e) { return e <= kExact; }));
    return skin;
  }

  // tuned: A joint counts as so many vertices.
  static constexpr double kJoint = 5.0;

  const Trajectories& t_;
  PlacedBones& bones_;
  std::vector<std::vector<std::uint32_t>> candidates_;  // [vertex]
  std::vector<std::uint32_t> looked_at_;                // vertices, ascending
  std::vector<SkinVertex> vertices_;                    // those
  std::vector<std::size_t> sample_;                     // indices of these
  std::vector<JointPoint> joints_;
};

}  // namespace

Skin fit_chains(const Trajectories& trajectories, const BoneChains& chains,
                PlacedBones& bones) {
  return ChainFit(trajectories, chains, bones).run();
}

}  // namespace rlpc
