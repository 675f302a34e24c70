#include "decoder/meshes/gltf/skin_targets.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

constexpr Eigen::Index kTargetFrames = 99;  // the last 90 are at rest

// Makes one target of two vertices with given weights.
PrincipalShapes one_target(const Eigen::RowVectorXf& weights) {
  PrincipalShapes shapes;
  shapes.unit = 1.0F / 127;
  shapes.targets.resize(6, 1);
  shapes.targets << 1, 0, 0, 0, 1, 0;
  shapes.weights = weights;
  shapes.has_short_weights = true;
  return shapes;
}

PrincipalShapes no_target() {
  PrincipalShapes shapes;
  shapes.targets.resize(6, 0);
  shapes.weights.resize(0, kTargetFrames);
  return shapes;
}

TEST(TargetTrack, LeavesOutKeysThatInterpolationReproduces) {
  Eigen::RowVectorXf weights = Eigen::RowVectorXf::Zero(kTargetFrames);
  weights.head(8) << 0, 0.1F, 0.2F, 0.3F, 0.4F, 0.31F, 0.2F, 0.1F;
  const SkinTargets targets{one_target(weights), no_target()};
  const Clip clip{"", 0, kTargetFrames};
  const TargetTrack exact = target_track(targets, clip, 1e-4);
  EXPECT_EQ(exact.keys, (std::vector<std::uint32_t>{0, 4, 5, 6, 8, 98}));
  const std::vector<TargetTrack> tracks{target_track(targets, clip, 0.05)};
  EXPECT_EQ(tracks[0].keys, (std::vector<std::uint32_t>{0, 4, 8, 98}));
  const Eigen::MatrixXf shown = shown_weights(targets, tracks, std::vector<Clip>{clip});
  EXPECT_NEAR(shown(0, 5), 0.3, 1e-6);  // what viewers show, not 0.31
  EXPECT_NEAR(shown(0, 4), 0.4, 1e-6);
}

TEST(TargetTrack, HasKeysForNormals) {
  Eigen::RowVectorXf weights = Eigen::RowVectorXf::Zero(kTargetFrames);
  weights[4] = 0.5F;
  const SkinTargets targets{one_target(Eigen::RowVectorXf::Zero(kTargetFrames)),
                            one_target(weights)};
  const TargetTrack track = target_track(targets, {"", 1, kTargetFrames - 1}, 1e9);
  EXPECT_EQ(track.keys, (std::vector<std::uint32_t>{0, 2, 3, 4, 97}));
  EXPECT_EQ(track.weights.row(1).maxCoeff(), 0.5F);
}

TEST(SkinTargets, MovePositionsOrNormals) {
  const Eigen::RowVectorXf weights = Eigen::RowVectorXf::Constant(kTargetFrames, 0.5F);
  const GlbMesh mesh = plain_mesh(2, {});
  GlbBuffers buffers;
  const GltfJson places = targets_of({one_target(weights), no_target()}, mesh, buffers);
  ASSERT_EQ(places.size(), 1U);
  EXPECT_FALSE(places[0].contains("NORMAL"));
  const SkinTargets both{one_target(weights), one_target(0 * weights)};
  const GltfJson json = targets_of(both, mesh, buffers);
  ASSERT_EQ(json.size(), 2U);
  const auto has_bytes = [&](std::size_t target, const char* path) {
    const auto accessor = json[target][path].get<std::size_t>();
    return buffers.accessors()[accessor].contains("bufferView");
  };
  EXPECT_TRUE(has_bytes(0, "POSITION"));
  EXPECT_FALSE(has_bytes(0, "NORMAL"));  // zeros
  EXPECT_FALSE(has_bytes(1, "POSITION"));
  EXPECT_TRUE(has_bytes(1, "NORMAL"));
  EXPECT_EQ(first_weights(both), GltfJson::array({0.5, 0.0}));
}

}  // namespace
}  // namespace rlpc
