#include "decoder/meshes/gltf/skin_normals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "decoder/testing/bending.h"

namespace rlpc {
namespace {

// Returns the RMS angle between vectors of three numbers, in degrees.
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

// Turns normals of the rest shape as viewers do.
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
  std::vector<float> rest =
      best_rest(influences, maps, b.frames);  // shape of the initial frames

  SkinNormals normals(std::size_t max_targets, std::uint64_t max_bytes = 1U << 20) const {
    const NormalVertices vertices = normal_vertices(
        look.mesh(), influences, rest, missing_moves(influences, maps, rest, b.frames));
    return skin_normals(look, influences, maps, rest, b.frames, vertices,
                        {max_targets, max_bytes});
  }
  // Returns the RMS angle to the normals of a frame.
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

// A sheet that one joint turns, and noise on its positions.
struct Noisy {
  static constexpr std::uint32_t kRow = 12;
  Skeleton skeleton;
  std::vector<Triangle> triangles;
  std::vector<float> rest;
  std::vector<JointMaps> maps;
  std::vector<std::vector<float>> frames;

  explicit Noisy(double noise) {
    constexpr std::int64_t kOne = std::int64_t{1} << 30;
    skeleton.bones = {{-1, {{{{kOne, 0, 0}, {0, kOne, 0}, {0, 0, kOne}}}, {0, 0, 0}}}};
    std::mt19937 random(1);
    const auto any = [&] { return static_cast<double>(random()) / 4294967296.0 - 0.5; };
    for (std::uint32_t v = 0; v < kRow * kRow; ++v) {
      skeleton.influences.push_back({{0, 16}});
      const double x = v % kRow + 0.5 * any();
      const std::uint32_t row = v / kRow;
      const double y = row + 0.5 * any();
      for (const double c : {x, y, std::sin(x) + 0.3 * any()}) {
        rest.push_back(static_cast<float>(c));
      }
      if (v % kRow + 1 == kRow || v / kRow + 1 == kRow) continue;
      triangles.push_back({v, v + 1, v + kRow});
      triangles.push_back({v + 1, v + kRow + 1, v + kRow});
    }
    for (std::size_t f = 0; f < 12; ++f) {
      JointMap& map = maps.emplace_back(1)[0];
      map.leftCols<3>() = Bending::turn(0.5 * static_cast<double>(f)).toRotationMatrix();
      map.col(3) = Eigen::Vector3d(1, 2, 3);
      std::vector<float>& xyz = frames.emplace_back();
      for (std::size_t v = 0; v < rest.size() / 3; ++v) {
        const double strength = noise * static_cast<double>(v % kRow) / kRow;
        const Eigen::Vector3d p(rest[3 * v] + strength * any(),
                                rest[3 * v + 1] + strength * any(),
                                rest[3 * v + 2] + strength * any());
        for (const double x : map* p.homogeneous()) xyz.push_back(static_cast<float>(x));
      }
    }
  }
};

// A steady vertex has, in each frame, the normal that its joint turns there.
TEST(NormalVertices, AreSteadyWhereNormalsTurnWithTheirJoint) {
  const Noisy noisy(0.02);
  std::vector<AttributeSet> sets(1);
  sets[0].header.name = "normal";
  sets[0].header.kind = ValueKind::kSmoothing;
  sets[0].header.num_components = 0;
  sets[0].face_of_triangle.resize(noisy.triangles.size());
  std::iota(sets[0].face_of_triangle.begin(), sets[0].face_of_triangle.end(), 0U);
  const GltfLook look(sets, noisy.triangles, Noisy::kRow * Noisy::kRow, "");
  const SkinInfluences influences = written_influences(noisy.skeleton, kByteWhole);
  const NormalVertices vertices =
      normal_vertices(look.mesh(), influences, noisy.rest,
                      missing_moves(influences, noisy.maps, noisy.rest, noisy.frames));
  std::size_t num_steady = 0;
  for (std::size_t f = 0; f < noisy.frames.size(); ++f) {
    const std::vector<float> at_rest = look.normals(noisy.rest);
    const std::vector<float> normals = look.normals(noisy.frames[f]);
    const auto& vertex = look.mesh().vertex;
    for (std::size_t i = 0; i < vertex.size(); ++i) {
      if (vertices.is_moving[vertex[i]]) continue;
      ++num_steady;
      const std::vector<float> by_joint = turned(influences, noisy.maps[f], {&vertex[i], 1},
                                                 std::span(at_rest).subspan(3 * i, 3));
      EXPECT_LT(rms_angle(std::span(normals).subspan(3 * i, 3), by_joint), 1.0)
          << f << " " << i;
    }
  }
  EXPECT_GT(num_steady, 12 * 24);
  EXPECT_LT(num_steady, 12 * 120);
  for (std::size_t v = 0; v < vertices.is_bent.size(); ++v) EXPECT_FALSE(vertices.is_bent[v]);
}

}  // namespace
}  // namespace rlpc
