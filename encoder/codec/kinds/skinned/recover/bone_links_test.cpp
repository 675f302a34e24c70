#include "encoder/codec/kinds/skinned/recover/bone_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "encoder/codec/kinds/skinned/recover/bone_rotations.h"
#include "encoder/testing/skinned_limb.h"

namespace rlpc {
namespace {

// Links of a limb whose first and third bone have vertices of their own.
class LinksOfLimb {
 public:
  explicit LinksOfLimb(double bend)
      : limb(limb_chain(std::array{1.0, 0.5, 1.0}), {.spacing = 0.05, .bend = bend}),
        trajectories(limb.frames, limb.frames.num_frames),
        rings(vertex_rings(limb.rest.size(), limb.triangles)),
        rotations(find_bone_rotations(trajectories, rings)),
        chains(connect_bones(trajectories, rings, rotations)),
        space(trajectories, rotations, chains),
        bones(space, chains),
        links(trajectories, chains, space) {
    for (const std::size_t b : space.order()) links.add(bones, b);
  }
  LinksOfLimb(const LinksOfLimb&) = delete;
  LinksOfLimb& operator=(const LinksOfLimb&) = delete;

  // Returns the bone of the limb that a found one turns like.
  std::size_t true_bone(std::size_t found) const {
    std::size_t best = 0;
    double min = 1e9;
    for (std::size_t b = 0; b < limb.bones.size(); ++b) {
      const Eigen::Matrix3d first = limb.motions[b][0].leftCols<3>().transpose();
      double sum = 0.0;
      for (std::size_t f = 0; f < limb.motions[b].size(); ++f) {
        sum += (limb.motions[b][f].leftCols<3>() * first - rotations.bones[found].rotation[f])
                   .squaredNorm();
      }
      if (sum < min) best = b;
      min = std::min(min, sum);
    }
    return best;
  }
  // Returns the vertices that truly follow two bones alone, each by a tenth or more.
  std::vector<std::uint32_t> followers(std::size_t a, std::size_t b) const {
    std::vector<std::uint32_t> result;
    for (std::uint32_t v = 0; v < limb.weights.size(); ++v) {
      const double first = limb.weights[v][a];
      const double second = limb.weights[v][b];
      if (std::min(first, second) > 0.1 && first + second > 1.0 - 1e-9) result.push_back(v);
    }
    return result;
  }

  SkinnedLimb limb;
  Trajectories trajectories;
  VertexRings rings;
  BoneRotations rotations;
  BoneChains chains;
  BoneSpace space;
  PlacedBones bones;
  BoneLinks links;
};

// However far the first frame is from the bind pose.
TEST(BoneLinks, AreTheVerticesThatFollowTwoBones) {
  for (const double bend : {0.1, 2.2}) {
    SCOPED_TRACE(testing::Message() << "bend " << bend);
    const LinksOfLimb x(bend);
    ASSERT_EQ(x.space.num_bones(), 3U);
    ASSERT_EQ(x.space.order().size(), 2U);  // the bone between them has no place yet
    for (const std::size_t a : x.space.order()) {
      for (std::size_t b = 0; b < x.space.num_bones(); ++b) {
        if (a == b) continue;
        const std::size_t first = x.true_bone(a);
        const std::size_t second = x.true_bone(b);
        const std::vector<std::uint32_t>& found = x.links.between(a, b);
        if (std::max(first, second) - std::min(first, second) != 1) {
          EXPECT_TRUE(found.empty());
          continue;
        }
        const std::vector<std::uint32_t> expected = x.followers(first, second);
        const auto count = std::count_if(
            expected.begin(), expected.end(),
            [&](std::uint32_t v) { return std::binary_search(found.begin(), found.end(), v); });
        // Others are offered other bones alone.
        EXPECT_GT(static_cast<double>(count), 0.8 * static_cast<double>(expected.size()));
        EXPECT_GT(expected.size(), 20U);
        for (const std::uint32_t v : found) {
          EXPECT_NEAR(x.limb.weights[v][first] + x.limb.weights[v][second], 1.0, 1e-3);
        }
      }
    }
  }
}

}  // namespace
}  // namespace rlpc
