#include "encoder/codec/kinds/skinned/recover/recovered_rig.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/mesh.h"
#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/skinned/fit/bone_fit.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"
#include "encoder/testing/skinned_limb.h"

namespace rlpc {
namespace {

// Returns the RMS of a coordinate relative to the centre of all vertices in its frame.
double extent_of(const SpanFrames& frames) {
  const std::uint32_t n = frames.num_vertices;
  double square = 0.0;
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      double centre = 0.0;
      for (std::uint32_t v = 0; v < n; ++v) centre += frames.at(f, v)[c] / n;
      for (std::uint32_t v = 0; v < n; ++v) square += std::pow(frames.at(f, v)[c] - centre, 2);
    }
  }
  return std::sqrt(square / (3.0 * frames.num_frames * n));
}

// Returns the RMS error of a coordinate of each vertex over all frames, in extents.
std::vector<double> errors_of(const SpanFrames& frames, const Rig& rig) {
  const double extent = extent_of(frames);
  std::vector<double> errors;
  for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
    double square = 0.0;
    for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
      const Point p = skinned_position(rig, f, v);
      for (std::size_t c = 0; c < 3; ++c) square += std::pow(p[c] - frames.at(f, v)[c], 2);
    }
    errors.push_back(std::sqrt(square / (3.0 * frames.num_frames)) / extent);
  }
  return errors;
}

double rms(std::span<const double> values) {
  double square = 0.0;
  for (const double x : values) square += x * x;
  return std::sqrt(square / static_cast<double>(values.size()));
}

double part_below(std::span<const double> values, double limit) {
  const auto count =
      std::count_if(values.begin(), values.end(), [&](double x) { return x <= limit; });
  return static_cast<double>(count) / static_cast<double>(values.size());
}

void expect_valid_bones(const Rig& rig, std::uint32_t num_frames) {
  ASSERT_GE(rig.bones.size(), 2U);
  for (std::size_t b = 0; b < rig.bones.size(); ++b) {
    SCOPED_TRACE(testing::Message() << "bone " << b);
    const RigBone& bone = rig.bones[b];
    EXPECT_LT(bone.parent, static_cast<int>(b));
    EXPECT_EQ(bone.parent < 0, b == 0);
    EXPECT_FALSE(bone.pinned);
    for (const double x : bone.pivot) EXPECT_TRUE(std::isfinite(x));
    ASSERT_EQ(bone.poses.size(), num_frames);
    for (std::size_t f = 0; f < num_frames; ++f) {
      const auto& q = bone.poses[f].rotation;
      const auto& p = bone.poses[f == 0 ? 0 : f - 1].rotation;
      ASSERT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-9);
      ASSERT_GE(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3], 0.0);
      for (const double x : bone.poses[f].origin) ASSERT_TRUE(std::isfinite(x));
    }
  }
}

void expect_valid(const Rig& rig, const SpanFrames& frames) {
  expect_valid_bones(rig, frames.num_frames);
  ASSERT_EQ(rig.rest.size(), frames.num_vertices);
  ASSERT_EQ(rig.weights.size(), frames.num_vertices);
  for (const Point& p : rig.rest) {
    for (const double x : p) ASSERT_TRUE(std::isfinite(x));
  }
  for (const auto& weights : rig.weights) {
    ASSERT_FALSE(weights.empty());
    ASSERT_LE(weights.size(), std::size_t{kMaxExtraBones});
    double sum = 0.0;
    double last = 1.0 + 1e-9;
    std::vector<char> is_used(rig.bones.size());
    for (const RigWeight& w : weights) {
      ASSERT_LT(w.bone, rig.bones.size());
      EXPECT_EQ(is_used[w.bone]++, 0);
      EXPECT_GT(w.weight, 0.0);
      EXPECT_LE(w.weight, last);
      last = w.weight;
      sum += w.weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
}

// Checks a rig, and that it explains as much as it claims.
void expect_honest(const RecoveredRig& found, const SpanFrames& frames) {
  expect_valid(found.rig, frames);
  const std::vector<double> errors = errors_of(frames, found.rig);
  constexpr double kExplainedError = 1e-4;  // extents
  EXPECT_GE(found.explained, part_below(errors, 0.8 * kExplainedError) - 0.01);
  EXPECT_LE(found.explained, part_below(errors, 1.2 * kExplainedError) + 0.01);
}

TEST(RecoveredRig, MovesEachVertexOfALimb) {
  for (const std::uint32_t num_frames : {40U, 80U, 150U}) {
    const SkinnedLimb limb(limb_chain(std::array{1.0, 1.0, 1.0}), {.num_frames = num_frames});
    const auto found = recover_rig(limb.frames, limb.triangles);
    ASSERT_TRUE(found.has_value());
    EXPECT_EQ(found->rig.bones.size(), 3U);
    EXPECT_GT(found->explained, 0.95);
    expect_honest(*found, limb.frames);
    EXPECT_LT(rms(errors_of(limb.frames, found->rig)), 1e-6);
  }
}

TEST(RecoveredRig, IsValidForAnyLimb) {
  constexpr std::uint32_t kLimbs = 16;
  int recovered = 0;
  for (std::uint32_t seed = 1; seed <= kLimbs; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const SkinnedLimb limb = random_limb(seed);
    const auto found = recover_rig(limb.frames, limb.triangles);
    if (!found) continue;
    expect_honest(*found, limb.frames);
    if (found->explained > 0.95) ++recovered;
  }
  EXPECT_GE(recovered, 14);  // none of the bones of another has vertices of its own
}

// The middle bone has no vertices of its own, the last one follows from it.
TEST(RecoveredRig, HasBonesThatAlwaysBlend) {
  const SkinnedLimb limb(limb_chain(std::array{1.0, 0.3, 0.2}), {.spacing = 0.05});
  const auto found = recover_rig(limb.frames, limb.triangles);
  ASSERT_TRUE(found.has_value());
  expect_honest(*found, limb.frames);
  EXPECT_EQ(found->rig.bones.size(), 3U);
  EXPECT_LT(rms(errors_of(limb.frames, found->rig)), 1e-5);
}

// Steps from the first frame find few of these.
TEST(RecoveredRig, MayBeFarFromTheFirstFrame) {
  constexpr std::uint32_t kLimbs = 8;
  int recovered = 0;
  for (std::uint32_t seed = 1; seed <= kLimbs; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const SkinnedLimb limb(limb_chain(std::array{1.0, 0.4, 1.0, 0.4, 1.0}),
                           {.seed = seed, .spacing = 0.07, .bend = 2.2});
    const auto found = recover_rig(limb.frames, limb.triangles);
    ASSERT_TRUE(found.has_value());
    expect_honest(*found, limb.frames);
    RecordProperty("explained" + std::to_string(seed), std::to_string(found->explained));
    if (found->explained > 0.99) ++recovered;
  }
  EXPECT_GE(recovered, 8);
}

TEST(RecoveredRig, DoesNotDependOnThreads) {
  const SkinnedLimb limb = random_limb(4);
  std::vector<Rig> rigs;
  for (const std::uint32_t count : {1U, 3U}) {
    ThreadPool pool(count);
    const ThreadPool::Use use(pool);
    auto found = recover_rig(limb.frames, limb.triangles);
    ASSERT_TRUE(found.has_value());
    rigs.push_back(std::move(found->rig));
  }
  const Rig& a = rigs[0];
  const Rig& b = rigs[1];
  EXPECT_EQ(a.rest, b.rest);
  const auto is_same_weight = [](const RigWeight& x, const RigWeight& y) {
    return x.bone == y.bone && x.weight == y.weight;
  };
  for (std::size_t v = 0; v < a.weights.size(); ++v) {
    EXPECT_TRUE(std::equal(a.weights[v].begin(), a.weights[v].end(), b.weights[v].begin(),
                           b.weights[v].end(), is_same_weight));
  }
  const auto is_same_pose = [](const RigPose& x, const RigPose& y) {
    return x.rotation == y.rotation && x.origin == y.origin;
  };
  ASSERT_EQ(a.bones.size(), b.bones.size());
  for (std::size_t i = 0; i < a.bones.size(); ++i) {
    EXPECT_EQ(a.bones[i].parent, b.bones[i].parent);
    EXPECT_EQ(a.bones[i].pivot, b.bones[i].pivot);
    EXPECT_TRUE(std::equal(a.bones[i].poses.begin(), a.bones[i].poses.end(),
                           b.bones[i].poses.begin(), b.bones[i].poses.end(), is_same_pose));
  }
}

// Pieces of a mesh, of which the second turns like the first but goes its own way.
TEST(RecoveredRig, MovesPiecesThatTurnAlike) {
  std::vector<LimbBone> bones = limb_chain(std::array{1.0, 1.0});
  bones.push_back({.along = {1.0, 0.0, 0.0}, .from = {0.0, 2.0, 0.0}, .turns_like = 0});
  const SkinnedLimb limb(bones, {.seed = 3});
  const auto found = recover_rig(limb.frames, limb.triangles);
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->rig.bones.size(), 3U);
  EXPECT_GT(found->explained, 0.95);
  expect_honest(*found, limb.frames);
}

class NotSkinned : public testing::Test {
 protected:
  static constexpr std::uint32_t kFrames = 40;

  // Expects no rig for a mesh with the triangles of the limb.
  template <typename Position>
  void expect_none(const Position& position, std::uint32_t num_frames = kFrames) const {
    const SpanFrames frames = cached_frames(limb_.frames.num_vertices, num_frames, position);
    EXPECT_FALSE(recover_rig(frames, limb_.triangles).has_value());
  }

  const SkinnedLimb limb_{limb_chain(std::array{1.0, 1.0, 1.0}), {.num_frames = kFrames}};
};

TEST_F(NotSkinned, RandomMotion) {
  LimbRandom random(5);
  expect_none([&](std::uint32_t, std::uint32_t v) -> Vec3d {
    return limb_.rest[v] + random.vector(0.2);
  });
}

TEST_F(NotSkinned, Waves) {
  expect_none([&](std::uint32_t f, std::uint32_t v) {
    Vec3d p = limb_.rest[v];
    for (int k = 1; k <= 12; ++k) {
      const double phase = limb_.rest[v].dot(Vec3d(2.1 * k, 1.3 * k, -1.7 * k));
      p += 0.1 / k *
           Vec3d(std::sin(0.2 * k * f + phase), std::cos(0.3 * f - 1.1 * phase),
                 std::sin(0.17 * k * f + 0.7 * phase));
    }
    return p;
  });
}

TEST_F(NotSkinned, NoiseOnALimb) {
  LimbRandom random(6);
  expect_none([&](std::uint32_t f, std::uint32_t v) -> Vec3d {
    return limb_.position(f, v) + random.vector(1e-3);
  });
}

TEST_F(NotSkinned, FewFrames) {
  const auto position = [&](std::uint32_t f, std::uint32_t v) { return limb_.position(f, v); };
  expect_none(position, 1);
  expect_none(position, 15);
  EXPECT_TRUE(recover_rig(limb_.frames, limb_.triangles).has_value());
}

TEST_F(NotSkinned, StillOrRigid) {
  expect_none([&](std::uint32_t, std::uint32_t v) { return limb_.rest[v]; });
  expect_none([&](std::uint32_t f, std::uint32_t v) {
    return moved(limb_.motions[1][f], limb_.rest[v]);
  });
}

TEST_F(NotSkinned, OnePlace) {
  expect_none([](std::uint32_t f, std::uint32_t) { return Vec3d(f, 2.0, 3.0); });
  expect_none([](std::uint32_t, std::uint32_t) { return Vec3d(0.0, 0.0, 0.0); });
}

TEST_F(NotSkinned, NoTriangles) {
  EXPECT_FALSE(recover_rig(limb_.frames, {}).has_value());
  EXPECT_FALSE(recover_rig(SpanFrames{0, kFrames, {}}, {}).has_value());
}

// A translation alone tells no bone from another.
TEST_F(NotSkinned, PiecesThatMoveApart) {
  const std::uint32_t half = limb_.frames.num_vertices / 2;
  std::vector<Triangle> triangles;
  for (const Triangle& t : limb_.triangles) {
    if ((t[0] < half) == (t[1] < half) && (t[1] < half) == (t[2] < half))
      triangles.push_back(t);
  }
  const SpanFrames frames =
      cached_frames(2 * half, kFrames, [&](std::uint32_t f, std::uint32_t v) -> Vec3d {
        return limb_.rest[v] + (v < half ? 0.02 : -0.03) * Vec3d(f, std::sin(0.2 * f), 0.0);
      });
  EXPECT_FALSE(recover_rig(frames, triangles).has_value());
}

}  // namespace
}  // namespace rlpc
