#include "encoder/codec/sequence/choices/level_choice.h"

#include <gtest/gtest.h>

#include <string>

namespace rlpc {
namespace {

SequenceHeader mesh(std::uint32_t num_vertices, std::uint32_t num_triangles) {
  SequenceHeader header;
  header.num_vertices = num_vertices;
  header.num_triangles = num_triangles;
  return header;
}

std::uint32_t level_of(SequenceHeader header, std::uint32_t longest,
                       std::uint32_t least_level = 1) {
  const auto error = choose_level(header, longest, least_level);
  return error ? 0 : header.level_idc;
}

TEST(LevelChoice, IsTheLowestThatAllowsMeshAndGofs) {
  EXPECT_EQ(level_of(mesh(1U << 13, 1U << 15), 512), 1U);
  EXPECT_EQ(level_of(mesh(1U << 14, 0), 512), 2U);  // vertices x frames
  EXPECT_EQ(level_of(mesh((1U << 14) + 1, 0), 1), 2U);
  EXPECT_EQ(level_of(mesh(1, (1U << 15) + 1), 1), 2U);
  EXPECT_EQ(level_of(mesh(1, 0), 513), 2U);
  EXPECT_EQ(level_of(mesh(1, 0), 16384), 4U);
  EXPECT_EQ(level_of(mesh(1, 0), 16385), 0U);
  EXPECT_EQ(level_of(mesh(1, 0), 1, 3), 3U);
}

EncodedSpan coded(std::uint64_t factors, std::size_t bytes, std::uint32_t clusters,
                  std::uint32_t components) {
  EncodedSpan gof;
  gof.units.push_back({UnitType::kGof, std::vector<std::uint8_t>(bytes)});
  gof.units.push_back({UnitType::kSlice, std::vector<std::uint8_t>(1)});
  gof.num_factors = factors;
  gof.max_clusters = clusters;
  gof.max_components = components;
  return gof;
}

TEST(LevelNeeds, GiveTheLowestLevelThatMeetsAll) {
  EXPECT_EQ(LevelNeeds(coded(100, 10, 2, 5)).level_from(1), 1U);
  EXPECT_EQ(LevelNeeds(coded(100, 10, 2, 5)).level_from(3), 3U);
  EXPECT_EQ(LevelNeeds(coded(pow2(23) + 1, 10, 2, 5)).level_from(1), 2U);
  EXPECT_EQ(LevelNeeds(coded(100, pow2(25) + 1, 2, 5)).level_from(1), 2U);
  EXPECT_EQ(LevelNeeds(coded(100, 10, 513, 5)).level_from(1), 3U);
  EXPECT_EQ(LevelNeeds(coded(100, 10, 2, 513)).level_from(1), 2U);
  EXPECT_FALSE(LevelNeeds(coded(100, 10, 2, 1025)).level_from(1));
}

TEST(LevelNeeds, IncludeTheCountsInTheSettings) {
  EncoderSettings settings;
  EXPECT_EQ(LevelNeeds(settings).level_from(1), 1U);
  settings.components = 513;
  EXPECT_EQ(LevelNeeds(settings).level_from(1), 2U);
  settings.main.bones = 513;
  EXPECT_EQ(LevelNeeds(settings).level_from(1), 3U);
  settings.main.bones = 0;
  settings.baseline.clusters = 513;
  EXPECT_EQ(LevelNeeds(settings).level_from(1), 3U);
}

TEST(LevelNeeds, DoubleUpToTheHighestLevel) {
  const auto reserved = [](const EncodedSpan& gof) {
    return LevelNeeds(gof).with_reserve().level_from(1);
  };
  EXPECT_EQ(reserved(coded(pow2(22), 10, 128, 256)), 1U);
  EXPECT_EQ(reserved(coded(pow2(22) + 1, 10, 128, 256)), 2U);
  EXPECT_EQ(reserved(coded(100, 10, 129, 5)), 2U);
  EXPECT_EQ(reserved(coded(100, 10, 600, 700)), 3U);
  EXPECT_FALSE(reserved(coded(100, 10, 1025, 5)));
}

TEST(LevelNeeds, RaiseALevelButNeverLowerIt) {
  std::uint32_t level_idc = 2;
  EXPECT_FALSE(raise_level(level_idc, LevelNeeds(coded(100, 10, 2, 5)), 8));
  EXPECT_EQ(level_idc, 2U);
  EXPECT_FALSE(raise_level(level_idc, LevelNeeds(coded(100, 10, 513, 5)), 8));
  EXPECT_EQ(level_idc, 3U);
  const auto error = raise_level(level_idc, LevelNeeds(coded(100, 10, 1025, 5)), 8);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->message.find("a GOF of 8 frames has 100 factors"), 0U) << error->message;
}

}  // namespace
}  // namespace rlpc
