#include "encoder/meshes/axes_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "encoder/meshes/axes.h"
#include "encoder/testing/turned.h"

namespace rlpc {
namespace {

using Pose = std::vector<float>;

// Returns a tall body, whose extents differ, as do its upper and its lower half.
Pose body() {
  std::mt19937 random(1);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Pose pose;
  for (int v = 0; v < 200; ++v) {
    const float height = unit(random);
    pose.insert(pose.end(), {0.3F * unit(random), 0.2F * unit(random) * (2 + height), height});
  }
  return pose;
}

// Bends the upper half forwards by an angle.
Pose bent(Pose pose, float angle) {
  for (std::size_t i = 0; i < pose.size(); i += 3) {
    if (pose[i + 2] < 0) continue;
    const float y = pose[i + 1];
    const float z = pose[i + 2];
    pose[i + 1] = std::cos(angle) * y - std::sin(angle) * z;
    pose[i + 2] = std::sin(angle) * y + std::cos(angle) * z;
  }
  return pose;
}

// Rotates a pose about the x axis.
Pose rotated(Pose pose, float angle) {
  for (std::size_t i = 0; i < pose.size(); i += 3) {
    const float y = pose[i + 1];
    const float z = pose[i + 2];
    pose[i + 1] = std::cos(angle) * y - std::sin(angle) * z;
    pose[i + 2] = std::sin(angle) * y + std::cos(angle) * z;
  }
  return pose;
}

// Returns the text of the axes found; empty: none.
std::string found(const Pose& mesh, const std::vector<Pose>& frames) {
  AxesFit fit(mesh);
  for (const Pose& frame : frames) fit.add_frame(frame);
  const auto axes = fit.axes_of_mesh();
  return axes ? axes_text(*axes) : "";
}

std::vector<Pose> bending(float from, float to) {
  std::vector<Pose> frames;
  for (int f = 0; f <= 10; ++f) {
    frames.push_back(bent(body(), from + (to - from) * static_cast<float>(f) / 10.0F));
  }
  return frames;
}

TEST(AxesFit, FindsWhatTurnsFramesToTheMesh) {
  for (const std::string axes : {"x,z,-y", "x,-z,y", "x,z,y", "-x,-y,z", "-x,y,z", "y,z,x"}) {
    EXPECT_EQ(found(turned(axes, body()), bending(0.0F, 0.5F)), axes);
    // Any frame may be that of the mesh.
    EXPECT_EQ(found(turned(axes, body()), bending(-0.5F, 0.0F)), axes);
  }
}

TEST(AxesFit, IsContentWithAFrameOfTheMesh) {
  AxesFit fit(bent(body(), 0.5F));
  fit.add_frame(body());
  EXPECT_FALSE(fit.matches());
  fit.add_frame(bent(body(), 0.5F));
  EXPECT_TRUE(fit.matches());
  EXPECT_FALSE(fit.axes_of_mesh());
}

TEST(AxesFit, FindsTheAxesOfARestPose) {
  const Pose rest = bent(body(), -0.4F);
  EXPECT_EQ(found(rest, bending(0.0F, 0.5F)), "");
  EXPECT_EQ(found(turned("x,z,-y", rest), bending(0.0F, 0.5F)), "x,z,-y");
}

TEST(AxesFit, TakesARestPoseThatIsTurnedAboutTheVerticalForMotion) {
  const Pose rest = bent(body(), -0.4F);
  EXPECT_EQ(found(turned("-x,-y,z", rest), bending(0.0F, 0.5F)), "");
  EXPECT_EQ(found(turned("y,-x,z", rest), bending(0.0F, 0.5F)), "");
}

TEST(AxesFit, DependsOnNeitherPlaceNorSize) {
  Pose mesh = turned("x,z,-y", body());
  for (std::size_t i = 0; i < mesh.size(); ++i)
    mesh[i] = 100.0F * mesh[i] + (i % 3 == 1 ? 500.0F : 0.0F);
  EXPECT_EQ(found(mesh, bending(0.0F, 0.5F)), "x,z,-y");
}

TEST(AxesFit, AllowsForTurnsOfTheAnimation) {
  // Standing in the mesh, lying down most of the time: as far as axes could be apart.
  std::vector<Pose> frames;
  for (const float angle : {1.5F, 1.4F, 0.7F, 0.1F}) frames.push_back(rotated(body(), angle));
  EXPECT_EQ(found(body(), frames), "");
  // They never stand, but turn farther than standing is from the axes.
  frames.clear();
  for (const float angle : {1.5F, 1.0F, 0.5F}) frames.push_back(rotated(body(), angle));
  EXPECT_EQ(found(body(), frames), "");
  EXPECT_NE(found(body(), {frames[0]}), "");
}

TEST(AxesFit, CannotTellWhatAMeshDoesNotResemble) {
  std::mt19937 random(2);
  std::uniform_real_distribution<float> unit(-1.0F, 1.0F);
  Pose other(600);
  for (float& x : other) x = unit(random);
  EXPECT_EQ(found(other, bending(0.0F, 0.5F)), "");
}

TEST(AxesFit, PrefersTurnsToMirrorsOfFlatMeshes) {
  Pose sheet = body();
  for (std::size_t i = 1; i < sheet.size(); i += 3) sheet[i] = 0.1F;
  EXPECT_EQ(found(sheet, {sheet}), "");
  EXPECT_EQ(found(turned("x,z,-y", sheet), {sheet}), "x,z,-y");
}

TEST(AxesFit, CannotTellAxesOfOnePoint) {
  EXPECT_EQ(found({1, 2, 3}, {{1, 3, -2}}), "");
  EXPECT_EQ(found({1, 2, 3, 1, 2, 3}, {{0, 0, 0, 1, 3, -2}}), "");
}

}  // namespace
}  // namespace rlpc
