#include "common/codec/kinds/skinned/influences.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

#include "common/testing/residual_bound.h"

namespace rlpc {
namespace {

Influences of(std::initializer_list<Influence> list) {
  Influences influences;
  for (const Influence& i : list) influences.list[influences.size++] = i;
  return influences;
}
std::vector<Influence> list_of(const Influences& influences) {
  return {influences.begin(), influences.end()};
}

TEST(Influences, AreTheFirstBoneWithoutARing) {
  const std::vector<Influences> none(1);
  InfluencePrediction prediction(none, 5, 6);
  prediction.start({});
  ASSERT_EQ(prediction.num_candidates(), 1U);
  EXPECT_EQ(prediction.candidate(0), 0U);
  EXPECT_EQ(prediction.weight_left(), 64);
  EXPECT_EQ(list_of(prediction.finish()), (std::vector<Influence>{{0, 64}}));
}

TEST(Influences, CandidatesAreInOrderOfTheirWeightsInTheRing) {
  const std::vector<Influences> known{of({{7, 10}, {3, 6}}), of({{3, 12}, {2, 4}}),
                                      of({{9, 16}}), of({{2, 4}, {5, 8}, {1, 4}})};
  InfluencePrediction prediction(known, 20, 4);
  const std::vector<std::uint32_t> ring{0, 1, 3};  // sums: 3: 18, 7: 10, 2: 8, 5: 8, 1: 4
  prediction.start(ring);
  std::vector<std::uint16_t> bones;
  for (std::size_t k = 0; k < prediction.num_candidates(); ++k) {
    bones.push_back(prediction.candidate(k));
  }
  EXPECT_EQ(bones, (std::vector<std::uint16_t>{3, 7, 2, 5, 1})) << "ties by number";
  EXPECT_EQ(prediction.candidate_mean(0), 6);
  EXPECT_EQ(prediction.candidate_mean(1), 3);  // 10 / 3
  EXPECT_EQ(prediction.candidate_mean(2), 3);  // 8 / 3 = 2.67
  EXPECT_EQ(prediction.candidate_mean(4), 1);  // 4 / 3
  for (const std::uint32_t bone : {3U, 7U, 2U, 5U, 1U})
    EXPECT_FALSE(prediction.is_new_bone(bone));
  for (const std::uint32_t bone : {0U, 9U}) EXPECT_TRUE(prediction.is_new_bone(bone));
  for (std::size_t k = 1; k < 5; ++k) prediction.add_candidate(k, 0);
  EXPECT_EQ(list_of(prediction.finish()),
            (std::vector<Influence>{{7, 3}, {2, 3}, {5, 3}, {1, 1}, {3, 6}}))
      << "the first candidate comes last and gets what is left";
}

TEST(Influences, AreInheritedIfTheRingAgrees) {
  const Influences shared = of({{4, 40}, {6, 20}, {1, 4}});
  const std::vector<Influences> known(5, shared);
  InfluencePrediction prediction(known, 8, 6);
  const std::vector<std::uint32_t> ring{0, 2, 4};
  prediction.start(ring);
  for (std::size_t k = 1; k < prediction.num_candidates(); ++k) {
    EXPECT_EQ(prediction.expected(k), 0U);
    prediction.add_candidate(k, 0);
  }
  EXPECT_EQ(list_of(prediction.finish()), (std::vector<Influence>{{6, 20}, {1, 4}, {4, 40}}));
}

// 9.8.3: half the mean absolute deviation, with 4 fractional bits, plus 5/16 of the previous
// residual, whose magnitude is clipped to 2^20.
TEST(Influences, ExpectedResidualsFollowTheDifferencesInTheRing) {
  const std::vector<Influences> known{of({{0, 40}, {1, 24}}), of({{0, 60}, {1, 4}}),
                                      of({{0, 64}})};
  InfluencePrediction prediction(known, 4, 6);
  const std::vector<std::uint32_t> ring{0, 1, 2};
  prediction.start(ring);
  ASSERT_EQ(prediction.candidate_mean(1), 9);  // 28 / 3
  // Differences 15 + 5 + 9 = 29; 16 * 29 / 3 = 154.67, rounded 155; 8 * 155 / 16 = 77.5.
  EXPECT_EQ(prediction.expected(1), 77U);
  prediction.add_candidate(1, -6);
  // 8 * 155 + 5 * 16 * 6 = 1720; / 16 = 107.5
  EXPECT_EQ(prediction.expected(1), 107U);
  prediction.add_candidate(1, -0xfffff);
  EXPECT_EQ(prediction.expected(1), 77U + 5 * 0xfffff);
  for (const std::int32_t clipped : {0x100000, -0x100001, kResidualBound, -kResidualBound}) {
    prediction.add_candidate(1, clipped);
    EXPECT_EQ(prediction.expected(1), 77U + 5 * 0x100000) << clipped;
  }
}

TEST(Influences, ExtraBonesAreAtMostFourAndNew) {
  const std::vector<Influences> known{of({{2, 16}})};
  InfluencePrediction prediction(known, 20, 4);
  const std::vector<std::uint32_t> ring{0};
  prediction.start(ring);
  for (const std::uint32_t bone : {7U, 19U, 0U, 3U}) {
    ASSERT_TRUE(prediction.can_add_bone());
    ASSERT_TRUE(prediction.is_new_bone(bone));
    prediction.add_extra_bone(bone, 3);
    EXPECT_FALSE(prediction.is_new_bone(bone));
  }
  EXPECT_FALSE(prediction.can_add_bone());
  EXPECT_EQ(prediction.weight_left(), 4);
  EXPECT_EQ(list_of(prediction.finish()),
            (std::vector<Influence>{{7, 3}, {19, 3}, {0, 3}, {3, 3}, {2, 4}}));
}

TEST(Influences, NoBoneCanBeAddedWithoutWeightOrWithoutBones) {
  const std::vector<Influences> known{of({{0, 8}, {1, 8}})};
  InfluencePrediction two_bones(known, 2, 4);
  const std::vector<std::uint32_t> ring{0};
  two_bones.start(ring);
  EXPECT_FALSE(two_bones.can_add_bone()) << "both are candidates";
  InfluencePrediction three_bones(known, 3, 4);
  three_bones.start(ring);
  ASSERT_TRUE(three_bones.can_add_bone());
  three_bones.add_extra_bone(2, 16);
  EXPECT_FALSE(three_bones.can_add_bone());
  EXPECT_FALSE(three_bones.has_residual()) << "no weight is left";
  three_bones.add_candidate(1, kResidualBound);
  EXPECT_EQ(list_of(three_bones.finish()), (std::vector<Influence>{{2, 16}}));
}

// A ring of 7 can give 56 candidates. After 7 influences, only the first candidate is added.
TEST(Influences, AreAtMostEight) {
  std::vector<Influences> known;
  for (std::uint16_t u = 0; u < 7; ++u) {
    Influences influences;
    for (std::uint16_t k = 0; k < 8; ++k) {
      influences.list[k] = {static_cast<std::uint16_t>(8 * u + k), 16};
    }
    influences.size = 8;
    known.push_back(influences);
  }
  InfluencePrediction prediction(known, 60, 7);
  const std::vector<std::uint32_t> ring{0, 1, 2, 3, 4, 5, 6};
  prediction.start(ring);
  ASSERT_EQ(prediction.num_candidates(), 56U);
  for (std::size_t k = 1; k < 56; ++k) {
    EXPECT_EQ(prediction.has_residual(), k <= 7) << k;
    prediction.add_candidate(k, k <= 7 ? 3 : 0);
  }
  const Influences found = prediction.finish();
  ASSERT_EQ(found.size, 8);
  EXPECT_EQ(found.list[6], (Influence{7, 5}));
  EXPECT_EQ(found.list[7], (Influence{0, 93}));
}

// Skinning relies on this: whatever the stream contains, a vertex has 1 to 8 distinct bones
// with positive weights that sum to the total.
TEST(RandomInfluences, AreLegalWhateverTheResiduals) {
  std::mt19937 random(1);
  const auto below = [&](std::uint32_t n) { return static_cast<std::uint32_t>(random() % n); };
  for (int i = 0; i < 300; ++i) {
    const std::uint32_t num_bones = 1 + below(i % 2 == 0 ? 6 : 300);
    const int weight_bits = static_cast<int>(below(kMaxWeightBits + 1));
    std::vector<Influences> influences(60);
    InfluencePrediction prediction(influences, num_bones, weight_bits);
    for (std::uint32_t v = 0; v < influences.size(); ++v) {
      std::vector<std::uint32_t> ring;
      for (std::uint32_t k = 0; k < std::min(v, below(8)); ++k) ring.push_back(below(v));
      prediction.start(ring);
      while (prediction.can_add_bone() && below(3) != 0) {
        const std::uint32_t bone = below(num_bones);
        if (!prediction.is_new_bone(bone)) continue;
        prediction.add_extra_bone(
            bone,
            1 + static_cast<int>(below(static_cast<std::uint32_t>(prediction.weight_left()))));
      }
      for (std::size_t k = 1; k < prediction.num_candidates(); ++k) {
        const std::int32_t small = static_cast<std::int32_t>(below(9)) - 4;
        const std::int32_t large = below(2) == 0 ? kResidualBound : -kResidualBound;
        prediction.add_candidate(k, below(8) == 0 ? large : small);
      }
      influences[v] = prediction.finish();
      const Influences& found = influences[v];
      ASSERT_GE(found.size, 1);
      ASSERT_LE(found.size, kMaxInfluences);
      int sum = 0;
      for (const Influence* a = found.begin(); a != found.end(); ++a) {
        ASSERT_GT(a->weight, 0);
        ASSERT_LT(a->bone, num_bones);
        sum += a->weight;
        for (const Influence* b = found.begin(); b != a; ++b) ASSERT_NE(a->bone, b->bone);
      }
      ASSERT_EQ(sum, 1 << weight_bits);
    }
  }
}

}  // namespace
}  // namespace rlpc
