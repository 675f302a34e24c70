#include "encoder/codec/kinds/skinned/recover/trajectory_span.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/codec/kinds/skinned/recover/trajectories.h"
#include "encoder/codec/spans/span_frames.h"
#include "encoder/testing/random_points.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kFrames = 60;
constexpr std::uint32_t kVertices = 20;  // of a patch; there are twice as many in all

// Returns a rotation about an axis by nearly its length, if that is small.
Eigen::Matrix3d turned(const Vec3d& axis) {
  return rotation_matrix(normalised({1.0, 0.5 * axis(0), 0.5 * axis(1), 0.5 * axis(2)}));
}

// Returns smooth rotations about axes that change, the identity in the first frame.
Rotations smooth_rotations(RandomPoints& random) {
  const Vec3d size = 0.8 * random.point() + Vec3d(0.6, 0.6, 0.6);
  const Vec3d phase = 3.0 * random.point();
  const Vec3d rate = 0.1 * random.point() + Vec3d(0.25, 0.25, 0.25);
  Rotations result;
  Eigen::Matrix3d first;
  for (std::uint32_t f = 0; f < kFrames; ++f) {
    Vec3d turn;
    for (Eigen::Index c = 0; c < 3; ++c) turn(c) = size(c) * std::sin(phase(c) + rate(c) * f);
    if (f == 0) first = turned(turn);
    result.push_back(turned(turn) * first.transpose());
  }
  return result;
}

// Bones in a chain. Each turns about a joint on the bone before; the first one moves freely.
struct Chain {
  std::vector<Rotations> rotations;       // [bone], relative to the first frame
  std::vector<std::vector<Vec3d>> moves;  // [bone][frame]: x moves to rotation * x + this
};

Chain chain_of(const std::vector<Rotations>& rotations, RandomPoints& random) {
  Chain chain{rotations, {std::vector<Vec3d>(kFrames)}};
  for (Vec3d& move : chain.moves[0]) move = random.point();
  for (std::size_t b = 1; b < rotations.size(); ++b) {
    const Vec3d joint = random.point();
    std::vector<Vec3d> moves;
    for (std::size_t f = 0; f < kFrames; ++f) {
      moves.push_back((rotations[b - 1][f] - rotations[b][f]) * joint + chain.moves[b - 1][f]);
    }
    chain.moves.push_back(moves);
  }
  return chain;
}

Chain random_chain(std::size_t num_bones, RandomPoints& random) {
  std::vector<Rotations> rotations;
  for (std::size_t b = 0; b < num_bones; ++b) rotations.push_back(smooth_rotations(random));
  return chain_of(rotations, random);
}

// Returns the frames of a patch that follows a chain by linear blend skinning, with weights
// that vary. Before each vertex of the patch there is one that moves as it likes.
SpanFrames skinned_frames(const Chain& chain, bool is_flat, RandomPoints& random) {
  std::vector<Vec3d> rest;
  std::vector<std::vector<double>> weights;
  for (std::uint32_t v = 0; v < kVertices; ++v) {
    rest.push_back(random.point());
    if (is_flat) rest.back()(2) = 0.5;
    std::vector<double>& w = weights.emplace_back();
    for (std::size_t b = 0; b < chain.moves.size(); ++b) {
      w.push_back(0.05 + std::abs(random.value()));
    }
    const double sum = std::accumulate(w.begin(), w.end(), 0.0);
    for (double& x : w) x /= sum;
  }
  SpanFrames frames{.num_vertices = 2 * kVertices, .num_frames = kFrames, .xyz = {}};
  for (std::size_t f = 0; f < kFrames; ++f) {
    for (std::size_t v = 0; v < kVertices; ++v) {
      Vec3d p = Vec3d::Zero();
      for (std::size_t b = 0; b < chain.moves.size(); ++b) {
        p += weights[v][b] * (chain.rotations[b][f] * rest[v] + chain.moves[b][f]);
      }
      const Vec3d place(5000, -300, 20);  // grid units
      const Vec3d free = 1000.0 * random.point() + place;
      p = 1000.0 * p + place;
      frames.xyz.insert(frames.xyz.end(), {free(0), free(1), free(2), p(0), p(1), p(2)});
    }
  }
  return frames;
}

std::vector<std::uint32_t> patch() {
  std::vector<std::uint32_t> vertices;
  for (std::uint32_t i = 0; i < kVertices; ++i) vertices.push_back(2 * i + 1);
  return vertices;
}

RotationColumns columns_of(const std::vector<Rotations>& rotations) {
  std::vector<const Rotations*> all;
  all.reserve(rotations.size());
  for (const Rotations& r : rotations) all.push_back(&r);
  return orthonormal_columns(all);
}

Rotations perturbed(Rotations rotations, double size, RandomPoints& random) {
  for (Eigen::Matrix3d& r : rotations) r = turned(size * random.point()) * r;
  return rotations;
}

double greatest_difference(const Rotations& a, const Rotations& b) {
  double greatest = 0.0;
  for (std::size_t f = 0; f < a.size(); ++f) {
    greatest = std::max(greatest, (a[f] - b[f]).cwiseAbs().maxCoeff());
  }
  return greatest;
}

// Returns the sums of the positions of the patch, relative to their mean, times the
// combination.
Rotations combined(const Trajectories& t, const std::vector<Vec3d>& combination) {
  Rotations result;
  for (std::size_t f = 0; f < t.num_frames(); ++f) {
    Vec3d mean = Vec3d::Zero();
    for (const std::uint32_t v : patch()) mean += t.position(f, v) / kVertices;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t i = 0; i < kVertices; ++i) {
      sum += (t.position(f, patch()[i]) - mean) * combination[i].transpose();
    }
    result.push_back(sum);
  }
  return result;
}

// The span of a patch that follows one, two or three bones.
class SkinnedPatch : public testing::TestWithParam<std::size_t> {
 protected:
  RandomPoints random_{static_cast<unsigned>(GetParam())};
  Chain chain_ = random_chain(GetParam(), random_);
  SpanFrames frames_ = skinned_frames(chain_, false, random_);
  Trajectories trajectories_{frames_, kFrames};
  TrajectorySpan span_{trajectories_, patch(), kExactMotion};
};

TEST_P(SkinnedPatch, SpansTheRotationsOfItsBones) {
  EXPECT_EQ(span_.rank(), 3 * GetParam());
  for (const Rotations& r : chain_.rotations) EXPECT_LT(span_.distance(r), 1e-5);
  for (int i = 0; i < 5; ++i) EXPECT_GT(span_.distance(smooth_rotations(random_)), 1e-2) << i;
}

TEST_P(SkinnedPatch, IsExplainedByAllOfItsBones) {
  EXPECT_LT(span_.unexplained(columns_of(chain_.rotations)), 1e-7);
  EXPECT_GT(span_.unexplained({}), 1e-2);  // by no columns
  for (std::size_t b = 0; b < GetParam(); ++b) {
    std::vector<Rotations> others = chain_.rotations;
    others[b] = smooth_rotations(random_);
    EXPECT_GT(span_.unexplained(columns_of(others)), 1e-4) << b;
    if (GetParam() == 1) continue;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(b));
    EXPECT_GT(span_.unexplained(columns_of(others)), 1e-4) << b;
  }
}

TEST_P(SkinnedPatch, ShowsTheRotationOfABoneNearby) {
  for (const Rotations& r : chain_.rotations) {
    const Rotations start = perturbed(r, 0.05, random_);
    EXPECT_GT(span_.distance(start), 1e-3);
    const TrajectorySpan::Found found = span_.rotation_near(start);
    EXPECT_LT(found.error, 1e-8);
    EXPECT_LT(span_.distance(found.rotation), 1e-5);
    ASSERT_EQ(found.rotation.size(), kFrames);
    EXPECT_LT((found.rotation[0] - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_LT(greatest_difference(found.rotation, r), 1e-5);
    ASSERT_EQ(found.combination.size(), kVertices);
    const Rotations sums = combined(trajectories_, found.combination);
    EXPECT_LT(greatest_difference(sums, found.rotation), 1e-6);
  }
}

INSTANTIATE_TEST_SUITE_P(Bones, SkinnedPatch, testing::Values(1, 2, 3));

// Vertices that do not follow bones have no rotation in their span.
TEST(TrajectorySpan, HasNoRotationOfFreeVertices) {
  RandomPoints random(4);
  SpanFrames frames{.num_vertices = 2 * kVertices, .num_frames = kFrames, .xyz = {}};
  for (std::size_t i = 0; i < 6 * kFrames * kVertices; ++i)
    frames.xyz.push_back(random.value());
  const Trajectories t(frames, kFrames);
  const TrajectorySpan span(t, patch(), kExactMotion);
  EXPECT_EQ(span.rank(), kVertices - 1);
  for (int i = 0; i < 3; ++i) {
    const Rotations start = smooth_rotations(random);
    EXPECT_GT(span.distance(start), 1e-2) << i;
    EXPECT_GT(span.rotation_near(start).error, 1e-4) << i;
  }
}

// A flat rigid patch shows two columns of the rotation: it is near, but cannot be found.
TEST(TrajectorySpan, HasTwoColumnsOfAFlatPatch) {
  RandomPoints random(5);
  const Chain chain = random_chain(1, random);
  const SpanFrames frames = skinned_frames(chain, true, random);
  const Trajectories t(frames, kFrames);
  const TrajectorySpan span(t, patch(), kExactMotion);
  EXPECT_EQ(span.rank(), 2U);
  EXPECT_LT(span.distance(chain.rotations[0]), 1e-5);
  EXPECT_GT(span.distance(smooth_rotations(random)), 1e-2);
  EXPECT_LT(span.unexplained(columns_of(chain.rotations)), 1e-7);
  EXPECT_GT(span.rotation_near(chain.rotations[0]).error, 1e-2);
}

// Motion below the tolerance is left out, and motion above is not.
TEST(TrajectorySpan, LeavesOutMotionBelowTheTolerance) {
  RandomPoints random(6);
  const Chain chain = random_chain(1, random);
  SpanFrames frames = skinned_frames(chain, false, random);
  for (double& x : frames.xyz) x += 0.01 * random.value();  // about 1e-5 extents
  const Trajectories t(frames, kFrames);
  EXPECT_EQ(TrajectorySpan(t, patch(), 1e-4).rank(), 3U);
  EXPECT_EQ(TrajectorySpan(t, patch(), 1e-7).rank(), kVertices - 1);
}

TEST(TrajectorySpan, IsEmptyForOneVertex) {
  RandomPoints random(7);
  const SpanFrames frames = skinned_frames(random_chain(2, random), false, random);
  const Trajectories t(frames, kFrames);
  const std::vector<std::uint32_t> one{3};
  const TrajectorySpan span(t, one, kExactMotion);
  EXPECT_EQ(span.rank(), 0U);
  EXPECT_EQ(span.unexplained({}), 0.0);
}

TEST(OrthonormalColumns, AreOrthonormal) {
  RandomPoints random(8);
  const RotationColumns columns =
      columns_of({smooth_rotations(random), smooth_rotations(random)});
  ASSERT_EQ(columns.count, 6U);
  ASSERT_EQ(columns.values.size(), 3 * kFrames * 6);
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = 0; b < 6; ++b) {
      double sum = 0.0;
      for (std::size_t row = 0; row < 3 * kFrames; ++row) {
        sum += columns.values[row * 6 + a] * columns.values[row * 6 + b];
      }
      EXPECT_NEAR(sum, a == b ? 1.0 : 0.0, 1e-9);
    }
  }
}

// Two bones that are joined by a hinge share the column along its axis.
TEST(OrthonormalColumns, LeaveOutSharedColumns) {
  RandomPoints random(9);
  const Rotations one = smooth_rotations(random);
  const Vec3d axis = random.point().normalized();
  Rotations hinged;
  for (std::size_t f = 0; f < kFrames; ++f) {
    hinged.push_back(one[f] * turned(std::sin(0.2 * static_cast<double>(f)) * axis));
  }
  EXPECT_EQ(columns_of({one}).count, 3U);
  EXPECT_EQ(columns_of({one, perturbed(one, 1e-6, random)}).count, 3U);
  EXPECT_EQ(columns_of({one, perturbed(one, 1e-3, random)}).count, 6U);
  EXPECT_EQ(columns_of({one, hinged}).count, 5U);

  const SpanFrames frames = skinned_frames(chain_of({one, hinged}, random), false, random);
  const Trajectories t(frames, kFrames);
  const TrajectorySpan both(t, patch(), kExactMotion);
  EXPECT_EQ(both.rank(), 5U);
  EXPECT_LT(both.unexplained(columns_of({one, hinged})), 1e-7);

  // One shared column does not make a rotation near.
  const SpanFrames rigid_frames = skinned_frames(chain_of({one}, random), false, random);
  const Trajectories rigid(rigid_frames, kFrames);
  EXPECT_GT(TrajectorySpan(rigid, patch(), kExactMotion).distance(hinged), 1e-2);
}

}  // namespace
}  // namespace rlpc
