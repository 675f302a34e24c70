// What rlpcinfo lists of GOFs, from streams with layer groups, an absent slice, and clusters.
#include "decoder/stream/gof_summary.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "conformance/roundtrip/sliced_animation.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

std::vector<GofSummary> entries_of(const StreamBytes& stream) {
  StreamReader reader(memory_source(stream), {});
  EXPECT_TRUE(reader.open());
  const auto gofs = summarise_all(reader);
  EXPECT_TRUE(gofs);
  return gofs ? *gofs : std::vector<GofSummary>();
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
  for (const StreamBytes& stream : {sliced_stream(), mixed_stream()}) {
    std::vector<std::size_t> listed;
    for (const GofSummary& gof : entries_of(stream)) {
      listed.push_back(gof.bytes);
      for (const SliceEntry& slice : gof.slices) listed.push_back(slice.bytes);
    }
    std::vector<std::size_t> found;
    for (const UnitPlace& unit : units_of(stream)) {
      const bool of_gof = unit.type == UnitType::kGof || unit.type == UnitType::kSlice;
      if (of_gof) found.push_back(unit.end() - unit.offset);
    }
    EXPECT_EQ(listed, found);
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
    EXPECT_EQ(gofs[g].kind, GofKind::kClusters);
    EXPECT_TRUE(gofs[g].slices.empty());
  }
}

TEST(GofSummaries, ReportsBothKindsInOneStream) {
  const auto gofs = entries_of(mixed_stream());
  ASSERT_EQ(gofs.size(), 7U);
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    const bool has_bones = g % 2 == 1;
    EXPECT_EQ(gofs[g].first_frame, 2 * g);
    EXPECT_EQ(gofs[g].kind, has_bones ? GofKind::kSkinned : GofKind::kClusters);
    EXPECT_EQ(gofs[g].figure("num_bones"), has_bones ? 3U : 0U);
    EXPECT_EQ(gofs[g].figure("num_clusters"), has_bones ? 0U : 2U);
    EXPECT_EQ(gofs[g].figure("num_components"), has_bones ? 0U : 2U);
    EXPECT_EQ(gofs[g].figure("num_trajectories"), has_bones ? 3U : 0U);
    EXPECT_EQ(gofs[g].slices.size(), has_bones ? 6U : 0U);
  }
}

}  // namespace
}  // namespace rlpc
