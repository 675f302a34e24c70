#include "encoder/codec/kinds/skinned/fit/skin_sums.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace rlpc {
namespace {

constexpr std::size_t kVertices = 9;
constexpr std::size_t kSumFrames = 7;

class Random {
 public:
  explicit Random(unsigned seed) : random_(seed) {}
  double value() { return static_cast<double>(random_()) / 1e9 - 2.0; }
  Vec3d point() { return {value(), value(), value()}; }
  std::vector<Vec3d> positions() {
    std::vector<Vec3d> result;
    for (std::size_t i = 0; i < kVertices * kSumFrames; ++i) result.push_back(point());
    return result;
  }
  BoneMotions motions(std::size_t count) {
    BoneMotions result(count);
    for (auto& bone : result) {
      for (std::size_t f = 0; f < kSumFrames; ++f) {
        Motion m;
        m.leftCols<3>() = rotation_matrix(normalised({2.5, value(), value(), value()}));
        m.col(3) = point();
        bone.push_back(m);
      }
    }
    return result;
  }

 private:
  std::mt19937 random_;
};

void expect_same(const SkinSums& a, const SkinSums& b, std::size_t num_bones) {
  const Vec3d rest{0.5, -1.0, 2.0};
  for (std::size_t v = 0; v < kVertices; ++v) {
    EXPECT_EQ(a.single_rest(v), b.single_rest(v));
    EXPECT_EQ(a.closest_bones(v, rest, num_bones + 1), b.closest_bones(v, rest, num_bones + 1));
    for (std::size_t i = 0; i < num_bones; ++i) {
      const std::vector<std::size_t> two{i, (i + 1) % num_bones};
      EXPECT_EQ(a.gram(v, two, rest), b.gram(v, two, rest));
    }
  }
}

TEST(SkinSums, GiveTheErrorsOfVertices) {
  Random random(1);
  const std::vector<Vec3d> positions = random.positions();
  const BoneMotions motions = random.motions(3);
  const SkinSums sums(positions, motions);
  const Vec3d rest = random.point();
  for (std::size_t v = 0; v < kVertices; ++v) {
    for (std::size_t b = 0; b < motions.size(); ++b) {
      double error = 0.0;
      for (std::size_t f = 0; f < kSumFrames; ++f) {
        error += (moved(motions[b][f], rest) - positions[v * kSumFrames + f]).squaredNorm();
      }
      EXPECT_NEAR(sums.rigid_error(v, b, rest), error, 1e-9);
    }
  }
}

TEST(SkinSums, AreUnchangedByAddingAndRemovingOtherBones) {
  Random random(2);
  const std::vector<Vec3d> positions = random.positions();
  BoneMotions motions = random.motions(6);
  SkinSums sums(positions, {motions[0], motions[1]});
  for (std::size_t b = 2; b < motions.size(); ++b) sums.add_bone(motions[b]);
  expect_same(sums, {positions, motions}, motions.size());
  for (const std::ptrdiff_t gone : {5, 2, 0}) {
    motions.erase(motions.begin() + gone);
    sums.remove_bone(static_cast<std::size_t>(gone));
    expect_same(sums, {positions, motions}, motions.size());
  }
  motions = random.motions(4);
  sums.set_motions(motions);
  expect_same(sums, {positions, motions}, motions.size());
}

TEST(SkinSums, CanChangeTheirVertices) {
  Random random(3);
  const BoneMotions motions = random.motions(2);
  SkinSums sums({}, motions);
  const std::vector<Vec3d> positions = random.positions();
  sums.set_positions(positions);
  expect_same(sums, {positions, motions}, motions.size());
}

}  // namespace
}  // namespace rlpc
