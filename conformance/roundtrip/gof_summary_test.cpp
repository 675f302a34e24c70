// Tests the GOF list of rlpcinfo for streams with layer groups, an absent slice, and clusters.
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "conformance/testing/rig_animation.h"
#include "conformance/testing/stream_summary.h"
#include "decoder/codec/units/stream_summary.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

std::vector<GofSummary> entries_of(const StreamBytes& stream) {
  return summary_of(stream).gofs;
}

TEST(GofSummaries, ReportsGofsAndTheirSlices) {
  const StreamBytes stream = sliced_stream();
  const auto gofs = entries_of(stream);
  ASSERT_EQ(gofs.size(), 2U);
  EXPECT_EQ(gofs[0].first_frame, 0U);
  EXPECT_EQ(gofs[1].first_frame, 2U);
  for (const GofSummary& gof : gofs) {
    EXPECT_EQ(gof.num_frames, 2U);
    EXPECT_EQ(gof.figure("num_bones"), 3U);
    EXPECT_EQ(gof.figure("num_component_groups"), 2U);
  }
  EXPECT_EQ(gofs[0].figure("prediction_idc"), 3U);
  ASSERT_EQ(gofs[0].layer_group_size.size(), 2U);
  EXPECT_EQ(gofs[0].layer_group_size[0], 1U);
  EXPECT_EQ(gofs[0].layer_group_size[1], gofs[0].figure("num_layers") - 1);
  EXPECT_GT(gofs[0].figure("num_layers"), 1U);
  EXPECT_EQ(gofs[0].figure("num_trajectories"), 3U);
  // The second group has no slice, and therefore no trajectories.
  EXPECT_EQ(gofs[1].figure("prediction_idc"), 1U);
  EXPECT_EQ(gofs[1].layer_group_size, std::vector<std::uint32_t>{1});
  EXPECT_EQ(gofs[1].figure("num_layers"), 1U);
  EXPECT_EQ(gofs[1].figure("num_trajectories"), 1U);
}

TEST(GofSummaries, CountsTheBytesOfUnits) {
  for (const StreamBytes& stream : {sliced_stream(), mixed_stream(), rig_stream()}) {
    std::vector<std::size_t> listed;
    std::vector<std::size_t> listed_of_rigs;
    for (const auto& rig : summary_of(stream).rigs) {
      listed_of_rigs.push_back(rig->bytes);
      for (const SliceEntry& slice : rig->slices) listed_of_rigs.push_back(slice.bytes);
    }
    for (const GofSummary& gof : entries_of(stream)) {
      listed.push_back(gof.bytes);
      for (const SliceEntry& slice : gof.slices) listed.push_back(slice.bytes);
    }
    std::vector<std::size_t> found;
    std::vector<std::size_t> found_of_rigs;
    bool is_rig = false;
    for (const UnitPlace& unit : units_of(stream)) {
      if (unit.type != UnitType::kSlice) is_rig = unit.type == UnitType::kRig;
      const bool is_gof = unit.type == UnitType::kGof || unit.type == UnitType::kSlice;
      if (is_rig || is_gof) {
        (is_rig ? found_of_rigs : found).push_back(unit.end() - unit.offset);
      }
    }
    EXPECT_EQ(listed, found);
    EXPECT_EQ(listed_of_rigs, found_of_rigs);
  }
}

TEST(GofSummaries, NumbersSlicesAsTheyStand) {
  const auto gofs = entries_of(sliced_stream());
  const auto places = [](const GofSummary& gof) {
    std::vector<std::vector<std::uint32_t>> list;
    for (const SliceEntry& s : gof.slices) {
      list.push_back({s.component_group_idx, s.layer_group_idx, s.num_trajectories});
    }
    return list;
  };
  EXPECT_EQ(places(gofs.at(0)),
            (std::vector<std::vector<std::uint32_t>>{
                {0, 0, 0}, {0, 1, 0}, {1, 0, 1}, {1, 1, 0}, {2, 0, 2}, {2, 1, 0}}));
  EXPECT_EQ(places(gofs.at(1)),
            (std::vector<std::vector<std::uint32_t>>{{0, 0, 0}, {1, 0, 1}}));
}

TEST(GofSummaries, ReportsClusterGofs) {
  const auto gofs = entries_of(rich_stream());
  ASSERT_EQ(gofs.size(), 2U);
  for (std::size_t g = 0; g < 2; ++g) {
    EXPECT_EQ(gofs[g].first_frame, 3 * g);
    EXPECT_EQ(gofs[g].num_frames, 3U);
    EXPECT_EQ(gofs[g].figure("num_clusters"), 2U);
    EXPECT_EQ(gofs[g].figure("num_components"), 4U);
    EXPECT_EQ(gofs[g].kind, GofKind::kCluster);
    EXPECT_TRUE(gofs[g].slices.empty());
  }
}

TEST(GofSummaries, ReportsBothKindsInOneStream) {
  const auto gofs = entries_of(mixed_stream());
  ASSERT_EQ(gofs.size(), 7U);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    const bool has_bones = g % 2 == 1;
    EXPECT_EQ(gofs[g].first_frame, 2 * g);
    EXPECT_EQ(gofs[g].kind, has_bones ? GofKind::kSkinned : GofKind::kCluster);
    EXPECT_EQ(gofs[g].figure("num_bones"), has_bones ? 3U : 0U);
    EXPECT_EQ(gofs[g].figure("num_clusters"), has_bones ? 0U : 2U);
    EXPECT_EQ(gofs[g].figure("num_components"), has_bones ? 0U : 2U);
    EXPECT_EQ(gofs[g].figure("num_trajectories"), has_bones ? 3U : 0U);
    EXPECT_EQ(gofs[g].slices.size(), has_bones ? 6U : 0U);
  }
}

// Three rigs, the first of 2 groups of 1 and 2 trajectories; its first GOF adds 2 groups.
TEST(GofSummaries, ReportsRigsAndTheirGofs) {
  const StreamSummary stream = summary_of(rig_stream());
  ASSERT_EQ(stream.rigs.size(), 3U);
  EXPECT_EQ(stream.rigs[0]->rig_idx, 0U);
  EXPECT_EQ(stream.rigs[1]->rig_idx, 5U);
  EXPECT_EQ(stream.rigs[2]->rig_idx, 0U);
  EXPECT_EQ(stream.rigs[0]->num_gofs, 3U);
  EXPECT_EQ(stream.rigs[1]->num_gofs, 1U);
  EXPECT_EQ(stream.rigs[2]->num_gofs, 2U);
  EXPECT_EQ(stream.rigs[0]->figure("num_trajectories"), 3U);
  EXPECT_EQ(stream.rigs[1]->figure("num_trajectories"), 1U);
  std::vector<int> used;
  std::vector<std::uint32_t> trajectories;
  for (const GofSummary& gof : stream.gofs) {
    used.push_back(gof.rig ? static_cast<int>(gof.rig->number) : -1);
    trajectories.push_back(gof.figure("num_trajectories"));
    EXPECT_EQ(gof.rig != nullptr, gof.kind == GofKind::kSharedRig);
  }
  EXPECT_EQ(used, (std::vector<int>{0, 1, 0, -1, 0, -1, 2, 2}));
  EXPECT_EQ(trajectories, (std::vector<std::uint32_t>{6, 1, 3, 0, 1, 3, 0, 4}));
}

// A rig and its GOFs are cut alike; local groups stay only if the rig stays whole.
TEST(GofSummaries, CutRigsAndGofsAlike) {
  const StreamSummary stream = summary_of(rig_stream());
  const RigSummary& rig = *stream.rigs[0];
  const GofSummary& gof = stream.gofs[0];
  for (const std::uint32_t components : {0U, 1U, 2U, 3U, 4U, 5U, 6U}) {
    const SliceCut cut{components, SliceCut::kAll};
    const std::uint32_t kept = components < 1 ? 0 : components < 3 ? 1 : 3;
    const std::uint32_t all = components < 4 ? kept : components < 6 ? 4 : 6;
    EXPECT_EQ(rig.totals(rig.groups_that_stay(cut)).num_trajectories, kept);
    EXPECT_EQ(gof.totals(gof.groups_that_stay(cut)).num_trajectories, all);
    EXPECT_EQ(rig.is_cut_by(cut), kept < 3);
    EXPECT_EQ(gof.is_cut_by(cut), all < 6);
  }
  // The third GOF has no slice of layers of its own.
  const SliceCut coarse{SliceCut::kAll, 1};
  EXPECT_EQ(stream.gofs[2].totals(stream.gofs[2].groups_that_stay(coarse)).num_slices, 2U);
  EXPECT_TRUE(stream.gofs[2].is_cut_by(coarse));
  EXPECT_EQ(stream.gofs[2].totals({}).num_layers, rig.figure("num_layers"));
}

}  // namespace
}  // namespace rlpc
