#include "decoder/output/gltf/skin_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "decoder/output/gltf/bending_test.h"

namespace rlpc {
namespace {

// Of three numbers each, in degrees.
double rms_angle(std::span<const float> a, std::span<const float> b) {
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); i += 3) {
    const Eigen::Vector3d p(a[i], a[i + 1], a[i + 2]);
    const Eigen::Vector3d q(b[i], b[i + 1], b[i + 2]);
    const double angle = std::atan2(p.cross(q).norm(), p.dot(q)) * 180 / std::numbers::pi;
    squares += angle * angle;
  }
  return std::sqrt(3 * squares / static_cast<double>(a.size()));
}

// Normals of the rest shape as viewers turn them.
std::vector<float> turned(const SkinInfluences& influences, const JointMaps& maps,
                          std::span<const std::uint32_t> vertex, std::span<const float> rest) {
  std::vector<float> normals;
  for (std::size_t i = 0; i < vertex.size(); ++i) {
    const Eigen::Vector3d normal(rest[3 * i], rest[3 * i + 1], rest[3 * i + 2]);
    const Eigen::Matrix3d turn = map_of(influences, vertex[i], maps).leftCols<3>();
    for (const double x : (turn * normal).normalized()) {
      normals.push_back(static_cast<float>(x));
    }
  }
  return normals;
}

TEST(RestNormals, TurnIntoThoseThatAreWanted) {
  const Bending b;
  const SkinInfluences influences = written_influences(b.skeleton, kShortWhole);
  std::vector<std::uint32_t> vertex;  // each twice
  std::vector<float> wanted;
  for (std::uint32_t i = 0; i < 2 * kVertices; ++i) {
    vertex.push_back(i / 2);
    const Eigen::Vector3f normal(std::cos(0.7F * static_cast<float>(i)), 0.5F,
                                 std::sin(0.7F * static_cast<float>(i)));
    for (const float x : normal.normalized()) wanted.push_back(x);
  }
  const JointMaps maps = b.maps_of(kFrames - 1);
  const std::vector<float> rest = rest_normals(influences, maps, vertex, wanted);
  EXPECT_GT(rms_angle(rest, wanted), 10);
  EXPECT_LT(rms_angle(turned(influences, maps, vertex, rest), wanted), 1e-4);
}

TEST(RestNormals, StayWhereJointsSqueezeFlat) {
  SkinInfluences influences;
  influences.joints = {0, 0, 0, 0};
  influences.weights = {65535, 0, 0, 0};
  JointMap flat = JointMap::Zero();
  flat(0, 0) = flat(1, 1) = 1;
  const std::vector<std::uint32_t> vertex{0};
  const std::vector<float> wanted{0, 0.6F, 0.8F};
  const std::vector<float> rest = rest_normals(influences, {flat}, vertex, wanted);
  for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(rest[c], wanted[c], 1e-6) << c;
}

// Triangles along the tube, with a normal at each vertex.
struct Surface {
  std::vector<Triangle> triangles;
  std::vector<AttributeSet> sets = std::vector<AttributeSet>(1);

  Surface() {
    for (std::uint32_t v = 0; v + 2 < kVertices; ++v) triangles.push_back({v, v + 1, v + 2});
    sets[0].header.name = "normal";
    sets[0].header.kind = ValueKind::kSmoothing;
    sets[0].header.num_components = 0;
    sets[0].face_of_triangle.resize(triangles.size());
    std::iota(sets[0].face_of_triangle.begin(), sets[0].face_of_triangle.end(), 0U);
  }
  GltfLook look() const { return {sets, triangles, kVertices, ""}; }
};

struct Skinned {
  Bending b;
  Surface surface;
  GltfLook look = surface.look();
  SkinInfluences influences = written_influences(b.skeleton, kShortWhole);
  std::vector<JointMaps> maps = b.maps();
  std::vector<float> rest = best_rest(influences, maps, b.frames);  // as yet

  SkinNormals normals(std::size_t max_targets, std::uint64_t max_bytes = 1U << 20) const {
    return skin_normals(look, influences, maps, rest, b.frames, max_targets, max_bytes);
  }
  // RMS of the angle to those of a frame.
  double error(const SkinNormals& normals, std::size_t f) const {
    Eigen::VectorXf shown = Eigen::Map<const Eigen::VectorXf>(
        normals.rest.data(), static_cast<Eigen::Index>(normals.rest.size()));
    if (normals.moves.targets.cols() > 0) {
      shown += normals.moves.targets * normals.moves.weights.col(static_cast<Eigen::Index>(f));
    }
    const std::span<const float> values(shown.data(), normals.rest.size());
    return rms_angle(turned(influences, maps[f], look.mesh().vertex, values),
                     look.normals(b.frames[f]));
  }
};

TEST(SkinNormals, FollowBonesThatMoveEverything) {
  const Skinned skinned;
  const SkinNormals normals = skinned.normals(20);
  EXPECT_EQ(normals.moves.targets.cols(), 0);
  EXPECT_FALSE(normals.lacks_moves);
  EXPECT_LT(skinned.error(normals, 0), 1e-3);
}

TEST(SkinNormals, MoveWithWhatBonesLeave) {
  Skinned skinned;
  for (std::size_t f = 0; f < kFrames; ++f) {  // a wave that grows
    for (std::size_t v = 0; v < kVertices; ++v) {
      skinned.b.frames[f][3 * v + 2] +=
          static_cast<float>(0.01 * static_cast<double>(f) * std::cos(static_cast<double>(v)));
    }
  }
  const SkinNormals none = skinned.normals(0);
  const SkinNormals normals = skinned.normals(20);
  EXPECT_LT(skinned.error(none, 0), 1e-3);
  EXPECT_LT(skinned.error(normals, 0), 1e-3);
  EXPECT_TRUE(normals.moves.weights.col(0).isZero(0));
  EXPECT_GT(normals.moves.targets.cols(), 0);
  EXPECT_GT(skinned.error(none, kFrames - 1), 5);
  EXPECT_LT(skinned.error(normals, kFrames - 1), skinned.error(none, kFrames - 1) / 3);
  EXPECT_TRUE(skinned.normals(20, 1000).lacks_moves);
}

}  // namespace
}  // namespace rlpc
