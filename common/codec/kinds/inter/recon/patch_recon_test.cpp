#include "common/codec/kinds/inter/recon/patch_recon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <random>
#include <vector>

#include "common/testing/patches_of_text.h"

namespace rlpc {
namespace {

using Values = std::vector<std::int32_t>;

PatchesOfText::List wide(const Values& values) { return {values.begin(), values.end()}; }

// Vertices in patches, moved by both implementations.
struct Patches {
  PatchOfVertex patch_of_vertex;
  std::vector<std::uint32_t> lowest;  // vertices of the lowest layer group
  Values first;
  PatchesOfText text;
  std::optional<PatchRecon> recon;

  void start(std::uint32_t num_patches, std::uint32_t num_depths, int position_bits) {
    text.num_patches = num_patches;
    text.patch_of_vertex = patch_of_vertex;
    text.position_bits = position_bits;
    text.start(lowest, wide(first), num_depths);
    recon.emplace(num_patches, patch_of_vertex, lowest, first, num_depths, position_bits + 5);
    ASSERT_EQ(recon->num_patches(), num_patches);
    for (std::uint32_t p = 0; p < num_patches; ++p) {
      ASSERT_EQ(recon->reach(p), text.reach[p]) << p;
    }
  }
  // Compares both in a frame; reference: must outlive the frame.
  void expect_frame(const Values& reference, std::uint32_t depth, std::uint32_t step,
                    const FramePatches& patches) {
    text.move(wide(reference), depth, step, patches);
    recon->start_frame(reference, depth, step, patches);
    for (std::uint32_t v = 0; v < patch_of_vertex.size(); ++v) {
      ASSERT_EQ(recon->mode(v), text.mode_of_vertex(v));
      if (recon->mode(v) == PatchMode::kNeighbours) continue;
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(recon->moved(v, c), text.moved(v, c)) << v;
    }
    for (std::uint32_t p = 0; p < patches.size(); ++p) {
      const PatchRecon::Motion& motion = recon->last_motion(depth, p);
      ASSERT_TRUE(std::equal(motion.begin(), motion.end(), text.motion[depth][p].begin())) << p;
      for (std::size_t c = 0; c < 3; ++c) ASSERT_EQ(recon->centre(p)[c], text.centre[p][c]);
    }
  }
};

// Four vertices of patch 0 around (160, 320, 0), and one of patch 1.
struct Square : Patches {
  explicit Square(std::uint32_t num_depths = 1, int position_bits = 20) {
    patch_of_vertex = {0, 0, 0, 0, 1};
    lowest = {0, 1, 2, 3, 4};
    first = {0, 320, 0, 320, 320, 0, 160, 160, 0, 160, 480, 0, -7, 5, 9};
    start(2, num_depths, position_bits);
  }
};

PatchMotion moving(const std::array<std::int32_t, kMotionValues>& residual) {
  return {PatchMode::kMotion, residual};
}

TEST(PatchRecon, ReachIsTheMeanOfTheLargestDistances) {
  const Square square;
  EXPECT_EQ(square.recon->reach(0), 160);
  EXPECT_EQ(square.recon->reach(1), 1);  // at least 1, also of a single vertex
  Patches two;
  two.patch_of_vertex = {0, 0};
  two.lowest = {0, 1};
  two.first = {0, 0, 0, 1, -5, 0};  // the centre is (1, -2, 0): distances 2 and 3
  two.start(1, 1, 20);
  EXPECT_EQ(two.recon->reach(0), 3);  // 5 / 2, rounded up
}

// A unit of an offset is a quarter of the step; ties go up.
TEST(PatchRecon, OffsetsAreInQuartersOfSteps) {
  struct Case {
    std::int32_t residual;
    std::uint32_t step;
    std::int32_t offset;
  };
  for (const auto& [residual, step, offset] :
       {Case{1, 1, 0}, Case{2, 1, 1}, Case{-2, 1, 0}, Case{-3, 1, -1}, Case{4, 16, 16},
        Case{-1, 16, -4}, Case{7, 65536, 114688}}) {
    Square square;
    const std::vector<std::int32_t> reference = square.first;
    square.recon->start_frame(reference, 0, step,
                              {moving({residual, 0, -residual}), PatchMotion{}});
    for (std::uint32_t v = 0; v < 4; ++v) {
      EXPECT_EQ(square.recon->moved(v, 0), reference[3 * v] + offset);
      EXPECT_EQ(square.recon->moved(v, 1), reference[3 * v + 1]);
    }
    EXPECT_EQ(square.recon->mode(0), PatchMode::kMotion);
    EXPECT_EQ(square.recon->mode(4), PatchMode::kNeighbours);
  }
}

// Number 4 is the part of y that is added to x: with a reach of 160 and a step of 16, a
// residual of 40 makes it 40 * 16 / 4 / 160 = 1.
TEST(PatchRecon, MatricesTurnAboutTheCentre) {
  Square square;
  square.recon->start_frame(square.first, 0, 16,
                            {moving({0, 0, 0, 0, 40, 0, -80, 0, 0, 0, 0, 20}), PatchMotion{}});
  const PatchRecon::Motion& motion = square.recon->last_motion(0, 0);
  EXPECT_EQ(motion[4], 1 << 16);
  EXPECT_EQ(motion[6], -(2 << 16));
  EXPECT_EQ(motion[11], 1 << 15);
  // Vertices are at (-160, 0), (160, 0), (0, -160) and (0, 160) from the centre.
  EXPECT_EQ(square.recon->moved(0, 0), 0);
  EXPECT_EQ(square.recon->moved(0, 1), 320 + 320);
  EXPECT_EQ(square.recon->moved(1, 1), 320 - 320);
  EXPECT_EQ(square.recon->moved(2, 0), 160 - 160);
  EXPECT_EQ(square.recon->moved(2, 1), 160);
  EXPECT_EQ(square.recon->moved(3, 0), 160 + 160);
  EXPECT_EQ(square.recon->moved(3, 2), 0);
}

// Patches turn about the centre of the reference frame, not of the first one.
TEST(PatchRecon, CentresAreThoseOfTheReference) {
  Square square;
  Values reference = square.first;
  for (std::size_t v = 0; v < 4; ++v) reference[3 * v] += 1000;
  reference[0] += 2;  // the mean is 1160.5
  square.recon->start_frame(reference, 0, 16, {moving({0, 0, 0, 40}), PatchMotion{}});
  EXPECT_EQ(square.recon->centre(0), (Vec3i{1161, 320, 0}));
  EXPECT_EQ(square.recon->moved(1, 0), 1320 + (1320 - 1161));
}

// The motion of a patch goes on from its last one at the same depth; frames without patches,
// and modes without motion, leave it alone.
TEST(PatchRecon, MotionsGoOnAtTheirDepth) {
  Square square(2);
  const auto offset = [&](std::uint32_t depth, const FramePatches& patches) {
    square.recon->start_frame(square.first, depth, 4, patches);
    return square.recon->last_motion(depth, 0)[0];
  };
  EXPECT_EQ(offset(0, {moving({5}), PatchMotion{}}), 5);
  EXPECT_EQ(offset(1, {moving({7}), PatchMotion{}}), 7);
  EXPECT_EQ(offset(0, {moving({2}), PatchMotion{}}), 7);
  EXPECT_EQ(offset(0, {}), 7);
  EXPECT_EQ(square.recon->mode(0), PatchMode::kNeighbours);
  EXPECT_EQ(offset(0, {PatchMotion{PatchMode::kNeighbours, {9}}, PatchMotion{}}), 7);
  EXPECT_EQ(offset(0, {PatchMotion{PatchMode::kAlone, {-1}}, PatchMotion{}}), 6);
  EXPECT_EQ(square.recon->mode(0), PatchMode::kAlone);
  EXPECT_EQ(square.recon->last_motion(1, 0)[0], 7);
}

// Patches without vertices in the lowest layer group have its centre and reach.
TEST(PatchRecon, PatchesOfHigherLayersTurnWithAllOfTheLowest) {
  Patches patches;
  patches.patch_of_vertex = {0, 0, 1, 2};
  patches.lowest = {0, 1};
  patches.first = {0, 0, 0, 100, 40, 0, 5000, 0, 0, 0, 7000, 0};
  patches.start(3, 1, 20);
  for (const std::size_t p : {0U, 1U, 2U}) EXPECT_EQ(patches.recon->reach(p), 50);
  patches.recon->start_frame(patches.first, 0, 16,
                             {PatchMotion{}, moving({0, 0, 0, 0, 0, 0, 25}), PatchMotion{}});
  EXPECT_EQ(patches.recon->centre(1), (Vec3i{50, 20, 0}));
  EXPECT_EQ(patches.recon->moved(2, 1), 2 * (5000 - 50));
}

TEST(PatchRecon, NumbersAndPointsAreClipped) {
  Square square(1, 4);
  constexpr std::int32_t kResidualBound = (1 << 28) - 1;
  const PatchMotion extreme =
      moving({kResidualBound, -kResidualBound, 0, kResidualBound, 0, 0, -kResidualBound});
  for (int i = 0; i < 3; ++i) {
    square.recon->start_frame(square.first, 0, 1 << 16, {extreme, PatchMotion{}});
  }
  const PatchRecon::Motion& motion = square.recon->last_motion(0, 0);
  EXPECT_EQ(motion[0], 1 << 29);
  EXPECT_EQ(motion[1], -(1 << 29));
  EXPECT_EQ(motion[3], 1 << 18);
  EXPECT_EQ(motion[6], -(1 << 18));
  EXPECT_EQ(square.recon->moved(0, 0), 255);
  EXPECT_EQ(square.recon->moved(0, 1), -256);
}

// Trying a motion does not change that of the patch.
TEST(PatchRecon, MotionsCanBeTried) {
  Square square;
  square.recon->start_frame(square.first, 0, 16, {moving({3, 1}), PatchMotion{}});
  const PatchRecon::Motion tried = square.recon->motion(0, 0, 16, {1, 0, 0, 40});
  EXPECT_EQ(tried, (PatchRecon::Motion{16, 4, 0, 1 << 16}));
  EXPECT_EQ(square.recon->moved(tried, 1, 0), 320 + 16 + 160);
  EXPECT_EQ(square.recon->last_motion(0, 0), (PatchRecon::Motion{12, 4}));
  EXPECT_EQ(square.recon->moved(1, 0), 320 + 12);
}

TEST(RandomPatches, MoveAsSpecified) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937_64 random(seed);
    const auto below = [&](std::uint64_t n) {
      return static_cast<std::uint32_t>(random() % n);
    };
    // Returns a signed number of at most this many bits, often an end in every fourth GOF.
    const bool is_extreme = seed % 4 == 0;
    const auto number = [&](int bits) {
      const std::int64_t half = std::int64_t{1} << (bits - 1);
      if (is_extreme && below(2) == 0) {
        return static_cast<std::int32_t>(below(2) == 0 ? half - 1 : -half);
      }
      const std::int64_t max_magnitude = half >> below(static_cast<std::uint64_t>(bits));
      const auto x =
          static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(max_magnitude));
      return static_cast<std::int32_t>(below(2) == 0 ? x : -x);
    };
    const int position_bits = is_extreme ? 24 : 2 + static_cast<int>(below(23));
    const std::uint32_t num_patches = 1 + below(6);
    const std::uint32_t num_depths = 1 + below(3);
    Patches patches;
    const std::uint32_t num_vertices = 1 + below(30);
    for (std::uint32_t v = 0; v < num_vertices; ++v) {
      patches.patch_of_vertex.push_back(static_cast<std::uint16_t>(below(num_patches)));
      if (v == 0 || below(2) == 0) patches.lowest.push_back(v);
      for (int c = 0; c < 3; ++c) patches.first.push_back(number(position_bits + 5));
    }
    ASSERT_NO_FATAL_FAILURE(patches.start(num_patches, num_depths, position_bits));
    for (int f = 0; f < 12; ++f) {
      Values reference;
      for (std::uint32_t i = 0; i < 3 * num_vertices; ++i) {
        reference.push_back(number(position_bits + 5));
      }
      FramePatches frame_patches(below(5) == 0 ? 0 : num_patches);
      for (PatchMotion& patch : frame_patches) {
        patch.mode = static_cast<PatchMode>(below(3));
        for (std::int32_t& x : patch.residual) x = number(is_extreme ? 29 : 12);
      }
      const std::uint32_t step = is_extreme ? 65536 : 1 + below(200);
      ASSERT_NO_FATAL_FAILURE(
          patches.expect_frame(reference, below(num_depths), step, frame_patches))
          << "frame " << f;
    }
  }
}

}  // namespace
}  // namespace rlpc
