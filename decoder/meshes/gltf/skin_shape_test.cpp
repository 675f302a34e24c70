#include "decoder/meshes/gltf/skin_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>

#include "decoder/meshes/gltf/skin_fit.h"
#include "decoder/testing/bending.h"

namespace rlpc {
namespace {

TEST(WrittenInfluences, AreTheFourLargestInProportion) {
  Skeleton skeleton;
  skeleton.influences = {
      {{7, 128}}, {{0, 1}, {1, 2}}, {{0, 1}, {1, 30}, {2, 20}, {3, 10}, {4, 60}, {5, 7}}};
  const SkinInfluences written = written_influences(skeleton, kShortWhole);
  EXPECT_EQ(written.joints, (std::vector<std::uint16_t>{7, 0, 0, 0, 1, 0, 0, 0, 4, 1, 2, 3}));
  for (std::size_t v = 0; v < 3; ++v) {
    const auto first = written.weights.begin() + static_cast<std::ptrdiff_t>(4 * v);
    EXPECT_EQ(std::accumulate(first, first + 4, 0), 65535) << v;
  }
  EXPECT_NEAR(written.weights[4], 65535.0 * 2 / 3, 1);
  EXPECT_NEAR(written.weights[9], 65535.0 * 30 / 120, 1);
}

TEST(WrittenInfluences, OfEightBitsAreNear) {
  const Bending b;
  const SkinInfluences exact = written_influences(b.skeleton, kShortWhole);
  const SkinInfluences small = written_influences(b.skeleton, kByteWhole);
  for (std::size_t v = 0; v < kVertices; ++v) {
    const auto first = small.weights.begin() + static_cast<std::ptrdiff_t>(4 * v);
    EXPECT_EQ(std::accumulate(first, first + 4, 0), 255) << v;
  }
  const double rms = rms_between(exact, small, b.maps_of(kFrames - 1), b.frames[0]);
  EXPECT_GT(rms, 0);
  EXPECT_LT(rms, 0.01);
  EXPECT_EQ(rms_between(exact, exact, b.maps_of(1), b.frames[0]), 0);
}

TEST(SkinShape, NeedsNoTargetsForWhatBonesMove) {
  const Bending b;
  const SkinInfluences influences = written_influences(b.skeleton, kShortWhole);
  const auto rest = best_rest(influences, b.maps(), b.frames);
  const PrincipalShapes shapes =
      principal_shapes(missing_moves(influences, b.maps(), rest, b.frames), 1e-4, 10);
  EXPECT_EQ(shapes.targets.cols(), 0);
  EXPECT_LT(skin_error(influences, b.maps(), rest, shapes, b.frames).largest, 1e-5);
}

TEST(SkinShape, AddsTargetsForTheRest) {
  Bending b;
  for (std::size_t f = 0; f < kFrames; ++f) {  // two shapes that come and go
    for (std::size_t i = 0; i < 3 * kVertices; ++i) {
      const auto t = static_cast<double>(f);
      const auto x = static_cast<double>(i);
      b.frames[f][i] += static_cast<float>(0.3 * std::sin(0.4 * t) * std::cos(0.1 * x) +
                                           0.1 * std::cos(0.9 * t) * std::sin(0.3 * x));
    }
  }
  const SkinInfluences influences = written_influences(b.skeleton, kShortWhole);
  const auto maps = b.maps();
  const auto rest = best_rest(influences, maps, b.frames);
  const auto moves = missing_moves(influences, maps, rest, b.frames);
  const PrincipalShapes none = principal_shapes(moves, 0.01, 0);
  EXPECT_GT(skin_error(influences, maps, rest, none, b.frames).rms, 0.1);
  const PrincipalShapes shapes = principal_shapes(moves, 0.01, 50);
  EXPECT_GT(shapes.targets.cols(), 1);
  EXPECT_LT(shapes.targets.cols(), 16);
  const SkinError error = skin_error(influences, maps, rest, shapes, b.frames);
  EXPECT_LT(error.rms, 0.0101);
  EXPECT_LT(error.kg_percent, 0.5);
  EXPECT_GT(error.largest, error.rms);
  const PrincipalShapes fewer = principal_shapes(moves, 0.01, 2);
  EXPECT_EQ(fewer.targets.cols(), 2);
}

TEST(FitPlaces, FindsThoseOfOtherFrames) {
  const Bending b;
  std::vector<JointPlaces> places = b.places;
  for (std::size_t f = 20; f < kFrames; ++f) places[f].clear();
  fit_places(b.skeleton, {}, written_influences(b.skeleton, kShortWhole), b.frames, places);
  for (std::size_t f = 0; f < kFrames; ++f) {
    ASSERT_EQ(places[f].size(), 2U) << f;
    for (std::size_t j = 0; j < 2; ++j) {
      const Eigen::Vector3d p(6, 1, 1);
      EXPECT_LT((places[f][j].moved(p) - b.places[f][j].moved(p)).norm(), 0.02) << f;
    }
  }
}

TEST(PrincipalShapes, HaveBytesAsValues) {
  std::mt19937 random(20);
  std::normal_distribution<float> normal;
  for (const float size : {0.01F, 1.0F, 500.0F}) {
    Eigen::MatrixXf moves(90, 30);
    for (float& x : moves.reshaped()) x = size * normal(random);
    const PrincipalShapes shapes = principal_shapes(moves, 0.05 * size, 100);
    ASSERT_GT(shapes.targets.cols(), 0);
    EXPECT_EQ(shapes.has_short_weights, size < 100);
    const Eigen::MatrixXf steps = shapes.weights / kWeightUnit;
    EXPECT_EQ((steps - steps.array().round().matrix()).cwiseAbs().maxCoeff() < 1e-2F,
              shapes.has_short_weights);
    for (Eigen::Index k = 0; k < shapes.targets.cols(); ++k) {
      const Eigen::VectorXf bytes = shapes.targets.col(k) / shapes.unit;
      EXPECT_NEAR(bytes.cwiseAbs().maxCoeff(), 127, 1e-3);
      EXPECT_LT((bytes - bytes.array().round().matrix()).cwiseAbs().maxCoeff(), 1e-3);
    }
    const Eigen::MatrixXf left = moves - shapes.targets * shapes.weights;
    EXPECT_LT(left.norm() / std::sqrt(30.0F * 30), 0.051F * size);
  }
}

// Tests a few to many motions, each smaller than the previous one.
TEST(PrincipalShapes, EndWhereFurtherOnesAreNotWorthTheirBytes) {
  std::mt19937 random(20);
  std::normal_distribution<float> normal;
  constexpr Eigen::Index kMotions = 30;
  Eigen::MatrixXf shapes(900, kMotions);
  Eigen::MatrixXf weights(kMotions, 60);
  for (float& x : shapes.reshaped()) x = normal(random);
  for (float& x : weights.reshaped()) x = normal(random);
  for (Eigen::Index k = 0; k < kMotions; ++k)
    shapes.col(k) *= std::pow(0.8F, static_cast<float>(k));
  const Eigen::MatrixXf moves = shapes * weights;
  const auto priced = [&](double file_bytes, double other_rms) {
    const PrincipalShapes found =
        principal_shapes(moves, 0.25 * other_rms, 100, {file_bytes, 1, other_rms});
    const Eigen::MatrixXf left = moves - found.targets * found.weights;
    EXPECT_LT(left.norm() / std::sqrt(300.0F * 60), 1.01 * other_rms);
    return found.targets.cols();
  };
  const Eigen::Index all = principal_shapes(moves, 0.25, 100).targets.cols();
  const Eigen::Index in_large_file = priced(1e7, 1);
  const Eigen::Index in_small_file = priced(1e4, 1);
  EXPECT_LE(in_large_file, all);
  EXPECT_LT(in_small_file, in_large_file);
  EXPECT_GT(priced(1e4, 0.3), in_small_file);
}

TEST(PrincipalShapes, LeaveOutVerticesThatHardlyMove) {
  Eigen::MatrixXf moves(90, 40);
  for (Eigen::Index f = 0; f < 40; ++f) {
    for (Eigen::Index i = 0; i < 90; ++i) {
      moves(i, f) = (i < 15 ? 1.0F : 0.01F) * std::sin(0.3F * static_cast<float>(f)) *
                    std::cos(static_cast<float>(i));
    }
  }
  const PrincipalShapes shapes = principal_shapes(moves, 0.1, 10);
  ASSERT_EQ(shapes.targets.cols(), 1);
  EXPECT_FALSE(shapes.targets.topRows(15).isZero(0));
  EXPECT_TRUE(shapes.targets.bottomRows(75).isZero(0));
}

}  // namespace
}  // namespace rlpc
