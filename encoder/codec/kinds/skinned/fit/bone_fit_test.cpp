#include "encoder/codec/kinds/skinned/fit/bone_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace rlpc {
namespace {

// Rotates about z, then about x.
Point turned(const Point& p, double about_z, double about_x) {
  const double c = std::cos(about_z);
  const double s = std::sin(about_z);
  const Point q{c * p[0] - s * p[1], s * p[0] + c * p[1], p[2]};
  const double cx = std::cos(about_x);
  const double sx = std::sin(about_x);
  return {q[0], cx * q[1] - sx * q[2], sx * q[1] + cx * q[2]};
}

struct Animation {
  SpanFrames frames;
  std::vector<Triangle> triangles;
};

// A tube along x of three links of length `kLink`. The second rotates about the end of the
// first, the third about the end of the second, and the whole tube moves. Weights blend across
// the joints over a distance of `blend`; 0 makes the links rigid.
constexpr double kLink = 1000.0;
constexpr std::uint32_t kSides = 8;
constexpr std::uint32_t kRings = 46;

double share_of_next_link(double x, double joint, double blend) {
  if (blend == 0.0) return x > joint ? 1.0 : 0.0;
  return std::clamp((x - joint) / blend + 0.5, 0.0, 1.0);
}

std::vector<Point> link_positions(const Point& p, double frame) {
  const double first = 0.6 * std::sin(0.4 * frame);
  const double second = 0.8 * std::sin(0.3 * frame);
  Point q = turned({p[0] - 2 * kLink, p[1], p[2]}, second, 0.3 * first);
  q = turned({q[0] + kLink, q[1], q[2]}, first, 0.5 * second);
  const Point r = turned({p[0] - kLink, p[1], p[2]}, first, 0.5 * second);
  std::vector<Point> links{p, {r[0] + kLink, r[1], r[2]}, {q[0] + kLink, q[1], q[2]}};
  for (Point& x : links) {
    x = turned(x, 0.05 * frame, 0.03 * frame);
    x[1] += 40.0 * frame;
  }
  return links;
}

Animation chain(double blend, std::uint32_t num_frames) {
  Animation a;
  a.frames.num_vertices = kRings * kSides;
  a.frames.num_frames = num_frames;
  for (std::uint32_t f = 0; f < num_frames; ++f) {
    for (std::uint32_t v = 0; v < a.frames.num_vertices; ++v) {
      const std::uint32_t ring = v / kSides;
      const double angle = 2.0 * 3.14159265358979 * (v % kSides) / kSides;
      const Point p{3.0 * kLink * ring / (kRings - 1), 150.0 * std::cos(angle),
                    200.0 * std::sin(angle)};
      const double b = share_of_next_link(p[0], kLink, blend);
      const double c = share_of_next_link(p[0], 2 * kLink, blend);
      const std::vector<Point> links = link_positions(p, f);
      for (std::size_t k = 0; k < 3; ++k) {
        a.frames.xyz.push_back((1.0 - b) * links[0][k] + (b - c) * links[1][k] +
                               c * links[2][k]);
      }
    }
  }
  for (std::uint32_t r = 0; r + 1 < kRings; ++r) {
    for (std::uint32_t s = 0; s < kSides; ++s) {
      const std::uint32_t i = r * kSides + s;
      const std::uint32_t j = r * kSides + (s + 1) % kSides;
      a.triangles.push_back({i, j, i + kSides});
      a.triangles.push_back({j, j + kSides, i + kSides});
    }
  }
  return a;
}

struct Options {
  std::size_t max_bones = 24;
  std::size_t max_influences = 3;
  double step = 0.0;
};

Rig fit_bones(const Animation& a, const Options& options) {
  BoneFit fit(a.frames, a.triangles, {.max_influences = options.max_influences});
  fit.grow(options.max_bones);
  fit.settle();
  EXPECT_LE(fit.num_bones(), options.max_bones);
  return fit.rig(fit.state(), options.max_influences, options.step);
}

double rms_error(const SpanFrames& frames, const Rig& fit) {
  double sum = 0.0;
  for (std::uint32_t f = 0; f < frames.num_frames; ++f) {
    for (std::uint32_t v = 0; v < frames.num_vertices; ++v) {
      const Point p = skinned_position(fit, f, v);
      for (std::size_t k = 0; k < 3; ++k) {
        sum += (p[k] - frames.at(f, v)[k]) * (p[k] - frames.at(f, v)[k]);
      }
    }
  }
  return std::sqrt(sum / (static_cast<double>(frames.num_frames) * frames.num_vertices));
}

double distance_of_points(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Returns the position of a point, given in rest coordinates, that moves with a bone.
Point carried(const Rig& fit, int bone, std::uint32_t frame, const Point& point) {
  Rig one;
  one.bones = {fit.bones[static_cast<std::size_t>(bone)]};
  one.rest = {point};
  one.weights = {{{0, 1.0}}};
  return skinned_position(one, frame, 0);
}

void expect_well_formed(const Animation& a, const Options& options, const Rig& fit) {
  ASSERT_GE(fit.bones.size(), 1U);
  EXPECT_LE(fit.bones.size(), options.max_bones);
  ASSERT_EQ(fit.rest.size(), a.frames.num_vertices);
  ASSERT_EQ(fit.weights.size(), a.frames.num_vertices);
  for (std::size_t b = 0; b < fit.bones.size(); ++b) {
    const RigBone& bone = fit.bones[b];
    EXPECT_LT(bone.parent, static_cast<int>(b));
    EXPECT_EQ(bone.parent < 0, b == 0);
    ASSERT_EQ(bone.poses.size(), a.frames.num_frames);
    for (std::uint32_t f = 0; f < a.frames.num_frames; ++f) {
      const auto& q = bone.poses[f].rotation;
      EXPECT_NEAR(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3], 1.0, 1e-9);
      if (f > 0) {
        const auto& p = bone.poses[f - 1].rotation;
        EXPECT_GE(p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + p[3] * q[3], 0.0);
      }
      if (!bone.pinned) continue;
      EXPECT_LT(
          distance_of_points(bone.poses[f].origin, carried(fit, bone.parent, f, bone.pivot)),
          1e-6);
    }
  }
  for (const auto& weights : fit.weights) {
    ASSERT_FALSE(weights.empty());
    EXPECT_LE(weights.size(), options.max_influences);
    double sum = 0.0;
    for (const RigWeight& w : weights) {
      EXPECT_LT(w.bone, fit.bones.size());
      EXPECT_GE(w.weight, 0.0);
      sum += w.weight;
    }
    EXPECT_NEAR(sum, 1.0, 1e-9);
  }
}

TEST(BoneFit, RecoversRigidLinksAndTheirJoints) {
  const Animation a = chain(0.0, 30);
  const Options options{.max_bones = 8, .max_influences = 3, .step = 3.0};
  const Rig fit = fit_bones(a, options);
  expect_well_formed(a, options, fit);
  ASSERT_EQ(fit.bones.size(), 3U);
  EXPECT_LT(rms_error(a.frames, fit), 0.01);
  for (std::size_t b = 1; b < 3; ++b) EXPECT_TRUE(fit.bones[b].pinned) << b;
  for (const auto& weights : fit.weights) EXPECT_EQ(weights.size(), 1U);
}

TEST(BoneFit, FollowsSmoothJoints) {
  const Animation a = chain(300.0, 90);  // more frames than the sample has
  const Options options{.max_bones = 3, .max_influences = 3, .step = 3.0};
  const Rig fit = fit_bones(a, options);
  expect_well_formed(a, options, fit);
  ASSERT_EQ(fit.bones.size(), 3U);
  EXPECT_LT(rms_error(a.frames, fit), 0.6 * options.step);
}

TEST(BoneFit, OneBoneFollowsARigidMesh) {
  const Animation a = chain(0.0, 12);
  const Options options{.max_bones = 1, .max_influences = 4, .step = 0.0};
  const Rig fit = fit_bones(a, options);
  expect_well_formed(a, options, fit);
  EXPECT_EQ(fit.bones.size(), 1U);
}

TEST(BoneFit, GivesAStaticMeshOneBone) {
  Animation a = chain(0.0, 1);
  const std::vector<double> first = a.frames.xyz;
  for (int f = 0; f < 9; ++f) {
    a.frames.xyz.insert(a.frames.xyz.end(), first.begin(), first.end());
  }
  a.frames.num_frames = 10;
  for (const double step : {0.0, 3.0}) {
    const Options options{.step = step};
    const Rig fit = fit_bones(a, options);
    expect_well_formed(a, options, fit);
    EXPECT_EQ(fit.bones.size(), 1U);
    EXPECT_LT(rms_error(a.frames, fit), 1e-6);
    for (const RigPose& pose : fit.bones[0].poses) EXPECT_NEAR(pose.rotation[0], 1.0, 1e-9);
  }
}

TEST(BoneFit, SurvivesDegenerateMeshes) {
  const auto animation = [](std::uint32_t num_vertices, std::uint32_t num_frames, auto point) {
    Animation a;
    a.frames.num_vertices = num_vertices;
    a.frames.num_frames = num_frames;
    for (std::uint32_t f = 0; f < num_frames; ++f) {
      for (std::uint32_t v = 0; v < num_vertices; ++v) {
        for (const double x : point(f, v)) a.frames.xyz.push_back(x);
      }
    }
    for (std::uint32_t v = 2; v < num_vertices; ++v) a.triangles.push_back({v - 2, v - 1, v});
    return a;
  };
  const auto vertex = [](double f, double) { return Point{10.0 * f, f * f, -f}; };
  const auto line = [](double f, double v) { return Point{100.0 * v, 3.0 * f, 7.0 * f * v}; };
  const auto bent = [](double f, double v) { return Point{v, v > 5 ? f * v : 0.0, v * v}; };
  for (const Animation& a :
       {animation(1, 5, vertex), animation(2, 5, line), animation(20, 7, line),
        animation(20, 1, bent), animation(20, 7, vertex), animation(12, 5, bent)}) {
    for (const double step : {0.0, 0.3}) {
      SCOPED_TRACE(testing::Message() << a.frames.num_vertices << " vertices, "
                                      << a.frames.num_frames << " frames");
      const Options options{.max_bones = 6, .step = step};
      const Rig fit = fit_bones(a, options);
      expect_well_formed(a, options, fit);
      EXPECT_TRUE(std::isfinite(rms_error(a.frames, fit)));
    }
  }
}

TEST(BoneFit, GrowsIncrementally) {
  const Animation a = chain(200.0, 20);
  BoneFit fit(a.frames, a.triangles, {});
  EXPECT_EQ(fit.num_bones(), 1U);
  double error = fit.rms_error();
  for (const std::size_t count : {2U, 3U}) {
    ASSERT_TRUE(fit.grow(count));
    fit.settle();
    EXPECT_EQ(fit.num_bones(), count);
    EXPECT_LT(fit.rms_error(), error);
    error = fit.rms_error();
    const Rig rig = fit.rig(fit.state(), 3, 1.0);  // does not change the fit
    EXPECT_EQ(fit.rms_error(), error);
    expect_well_formed(a, {.max_bones = count, .step = 1.0}, rig);
  }
}

TEST(BoneFit, IsDeterministic) {
  const Animation a = chain(200.0, 20);
  const Options options{.max_bones = 6, .step = 2.0};
  const Rig first = fit_bones(a, options);
  const Rig second = fit_bones(a, options);
  ASSERT_EQ(first.bones.size(), second.bones.size());
  EXPECT_EQ(first.rest, second.rest);
  for (std::size_t b = 0; b < first.bones.size(); ++b) {
    EXPECT_EQ(first.bones[b].parent, second.bones[b].parent);
    EXPECT_EQ(first.bones[b].pivot, second.bones[b].pivot);
    for (std::size_t f = 0; f < first.bones[b].poses.size(); ++f) {
      EXPECT_EQ(first.bones[b].poses[f].rotation, second.bones[b].poses[f].rotation);
      EXPECT_EQ(first.bones[b].poses[f].origin, second.bones[b].poses[f].origin);
    }
  }
}

}  // namespace
}  // namespace rlpc
