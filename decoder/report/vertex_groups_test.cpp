#include "decoder/report/vertex_groups.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

using Groups = std::vector<std::uint32_t>;

TEST(VertexGroups, SeedVerticesAreInTheFirstClusterOfTheirs) {
  ClusterGof gof;
  gof.first_frame = 20;
  gof.num_frames = 5;
  gof.clusters.resize(3);
  gof.clusters[1] = {true, {4, 2, 3}, {}};
  gof.clusters[2] = {true, {5, 3, 1}, {}};
  gof.cluster_of_vertex = {
      0, kSeedCluster, kSeedCluster, kSeedCluster, kSeedCluster, kSeedCluster, 2, 1};
  AccessUnit access_unit;
  access_unit.gof = gof;
  const VertexGroups groups = vertex_groups(access_unit, StreamContext());
  EXPECT_EQ(groups.kind, GroupKind::kClusters);
  EXPECT_EQ(groups.first_frame, 20U);
  EXPECT_EQ(groups.num_frames, 5U);
  EXPECT_EQ(groups.num_groups, 3U);
  EXPECT_EQ(groups.group_of_vertex, (Groups{0, 2, 1, 1, 1, 2, 2, 1}));
  ASSERT_EQ(groups.seeds.size(), 2U);
  EXPECT_EQ(groups.seeds[0], gof.clusters[1].seed_vertex);
  EXPECT_EQ(groups.seeds[1], gof.clusters[2].seed_vertex);
}

// Tests a single triangle, whose vertices are all in the base.
class Bones : public testing::Test {
 protected:
  Bones() {
    context_.header.profile_idc = kProfileHigh;
    context_.header.num_vertices = 3;
    const std::vector<Triangle> triangles{{0, 1, 2}};
    context_.set_connectivity(triangles);
    gof_.weight_bits = 4;
    gof_.bones.resize(4);
    gof_.layer_group_size = {1};
    gof_.slice_layers = {1};
    gof_.influences.resize(3);
    gof_.influences[0] = {{{{2, 9}, {0, 7}}}, 2};
    gof_.influences[1] = {{{{3, 6}, {1, 6}, {0, 4}}}, 3};
    gof_.influences[2] = {{{{1, 16}}}, 1};
  }
  Groups found() const {
    AccessUnit access_unit;
    access_unit.gof = gof_;
    const VertexGroups groups = vertex_groups(access_unit, context_);
    EXPECT_EQ(groups.kind, GroupKind::kBones);
    EXPECT_EQ(groups.num_groups, 4U);
    EXPECT_TRUE(groups.seeds.empty());
    return groups.group_of_vertex;
  }

  StreamContext context_;
  SkinnedGof gof_;
};

TEST_F(Bones, AreThoseOfTheGreatestWeightOrOfSeveralTheFirst) {
  EXPECT_EQ(found(), (Groups{2, 1, 1}));
}

TEST_F(Bones, OfAGofOfTracksAreThoseOfItsRig) {
  const auto rig = std::make_shared<SharedRig>(static_cast<const SharedRig&>(gof_));
  gof_ = SkinnedGof();
  gof_.kind = GofKind::kSharedRig;
  gof_.rig = rig;
  EXPECT_EQ(found(), (Groups{2, 1, 1}));
}

TEST(VertexGroups, PatchesOfAGofOfFrames) {
  InterGof gof;
  gof.num_patches = 3;
  gof.patch_of_vertex = {0, 2, 1, 2};
  AccessUnit access_unit;
  access_unit.gof = gof;
  const VertexGroups groups = vertex_groups(access_unit, StreamContext());
  EXPECT_EQ(groups.kind, GroupKind::kPatches);
  EXPECT_EQ(groups.num_groups, 3U);
  EXPECT_EQ(groups.group_of_vertex, (Groups{0, 2, 1, 2}));
  EXPECT_TRUE(groups.seeds.empty());
}

TEST(VertexGroups, GofsOfFramesWithoutPatchesHaveNone) {
  AccessUnit access_unit;
  access_unit.gof = InterGof();
  const VertexGroups groups = vertex_groups(access_unit, StreamContext());
  EXPECT_EQ(groups.kind, GroupKind::kNone);
  EXPECT_TRUE(groups.group_of_vertex.empty());
}

}  // namespace
}  // namespace rlpc
