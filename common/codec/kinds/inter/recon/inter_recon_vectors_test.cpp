// Inter GOFs with the positions that specdec decodes by running the text of the specification.
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/codec/bits/fixed_point.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "common/codec/mesh/ordered_meshes.h"

namespace rlpc {
namespace {

using Values = std::vector<std::int32_t>;
constexpr int kPositionBits = 12;

// Four squares, whose nine vertices are in the layers {2, 3, 6, 7}, {1} and {0, 4, 5, 8}.
struct Squares {
  std::vector<Triangle> triangles{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {3, 1, 5},
                                  {3, 5, 6}, {3, 6, 7}, {3, 7, 4}, {7, 6, 8}};
  Topology topology = make_topology(9, triangles);
  OrderedMeshes meshes{topology, triangles};
  const OrderedMesh& operator*() const { return meshes[Prediction::kLayers]; }
};

// Decodes a GOF; values: FrameValues of each frame, 1/16 grid units.
void expect_values(const InterGof& gof, const std::vector<Values>& values) {
  const Squares mesh;
  InterRecon recon(*mesh, gof, kPositionBits);
  const FrameOrder order(gof.pattern, gof.num_frames);
  Values positions(27);
  for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
    const FramePlace& at = order[place];
    recon.decode(at, order.last_use(at.frame), (*gof.frames)[at.frame]);
    recon.positions(positions);
    if (place > 0 && at.first == at.second && !(*gof.frames)[at.frame].reference) {
      const auto reference = recon.reference();
      ASSERT_EQ(Values(reference.begin(), reference.end()), values[at.first]);
    }
    for (std::size_t i = 0; i < positions.size(); ++i) {
      ASSERT_EQ(positions[i],
                clip_signed(kPositionBits, round2(values[at.frame][i], kPointFractionBits)))
          << "frame " << at.frame << ", value " << i;
    }
  }
}

CompactResiduals compact(const Values& list) {
  CompactResiduals residuals(list.size());
  for (std::size_t i = 0; i < list.size(); ++i) residuals.set(i, list[i]);
  residuals.sort();
  return residuals;
}

struct DecodedFrame {
  Values residual;                      // FrameResiduals
  std::vector<std::uint16_t> expected;  // FrameNoise
  Values values;                        // DecodedFrames
};

// Frames of a dyadic pattern, coded in the order 0, 4, 2, 1, 3, 6, 5.
const std::vector<DecodedFrame> kDyadic{
    // Frame 0
    {{-10, 16, -39, -245, 252, -122, -15, 134,  -269, -215, 110, 237, -19, -51,
      -31, 2,  12,  -88,  -33, -39,  284, -129, 272,  284,  57,  57,  36},
     {1006, 1023, 16, 852, 996, 1016, 1023, 1023, 1023},
     {-3193, 4951, -4313, -6019, 7004, -2773, -315,  2814, -5649,
      -4830, 5124, -672,  -3602, 5648, -591,  -4700, 5125, -445,
      -3265, 3150, 2804,  -5512, 9408, 4792,  -4238, 6429, 3893}},
    // Frame 1
    {{0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0},
     {0, 0, 0, 0, 0, 0, 0, 0, 0},
     {43833, 45413, 36371, -5691, 7264, -3039, -465,  3175, -7608,
      -5592, 4543,  -112,  -3728, 5455, -538,  -5052, 5149, -635,
      -5719, 3721,  3170,  -5580, 8121, 8814,  -5002, 5724, 5987}},
    // Frame 2
    {{-7, 13,  -35, 1,   22,  -25, -7,  13, -35, -15, -12, 22, -15, -12,
      22, -39, 40,  -25, -39, 40,  -25, 10, 4,   31,  10,  4,  31},
     {97, 113, 9, 109, 120, 120, 106, 144, 133},
     {43833, 45413, 36371, -5691, 7264, -3039, -465,  3175, -7608,
      -5592, 4543,  -112,  -3728, 5455, -538,  -5052, 5149, -635,
      -5719, 3721,  3170,  -5580, 8121, 8814,  -5002, 5724, 5987}},
    // Frame 3
    {{0, 0, 0, 1, 22,  -25, -7,  13, -35, -15, -12, 22, 0, 0,
      0, 0, 0, 0, -39, 40,  -25, 10, 4,   31,  0,   0,  0},
     {0, 113, 9, 109, 0, 0, 106, 144, 0},
     {65535, 65535, 65535, -5456, 7480, -3263, -611,  3445, -9109,
      -6072, 4059,  438,   -3665, 5337, -506,  -5055, 4936, -574,
      -5585, 3280,  3687,  -5853, 7471, 12309, -5097, 5214, 8178}},
    // Frame 4
    {{0,   0,   0,   0,  0,   0,  -7,  13, -35, -15, -12, 22, -7, 13,
      -35, -15, -12, 22, -39, 40, -25, 10, 4,   31,  -39, 40, -25},
     {0, 0, 9, 109, 97, 100, 106, 144, 127},
     {10315, 14114, 5055, -5867, 6915, -2657, -462,  3087, -6384,
      -5292, 5145,  -945, -3829, 5760, -847,  -5049, 5279, -689,
      -3949, 3814,  2027, -5373, 9406, 5381,  -4302, 6404, 3683}},
    // Frame 5
    {{0, 0, 0, 1, 22,  -25, -7,  13, -35, -15, -12, 22, 0, 0,
      0, 0, 0, 0, -39, 40,  -25, 10, 4,   31,  0,   0,  0},
     {0, 219, 160, 227, 0, 0, 342, 252, 0},
     {45990, 56407, 18565, -8121, 12092, -8346, -210,  2484, -3111,
      -4730, 6061,  -4308, -3651, 6928,  -3365, -4385, 8019, -6791,
      -1884, 5240,  -5424, -5330, 11496, -2031, -3485, 8136, -2977}},
    // Frame 6
    {{-7, 13, -35, -39, 40, -25, 0,   0,   0,   0,  0,   0,   0, 0,
      0,  0,  0,   0,   -7, 13,  -35, -15, -12, 22, -15, -12, 22},
     {71, 62, 0, 0, 0, 0, 240, 150, 296},
     {65517, 65535, 65443, -6990, 9102, -4497, -367,  2964, -6698,
      -5323, 5006,  -945,  -3790, 5626, -775,  -5059, 5138, -658,
      -3838, 3871,  1100,  -5578, 8930, 5953,  -4128, 6166, 3710}},
};

constexpr std::array<std::int32_t, kMotionValues> kFirstMotion{6,  -25, -30, 28, -16, 20,
                                                               -2, 10,  -7,  16, 12,  37};
constexpr std::array<std::int32_t, kMotionValues> kOtherMotion{29, -17, 22,  2,  -21, 28,
                                                               37, 16,  -23, 23, 26,  -30};

// The GOF has two temporal layers and layer groups, patches in all modes, a frame that repeats
// another, and one that is predicted from an earlier one.
TEST(InterReconVectors, LearnWeightsAndFollowPatches) {
  InterGof gof;
  gof.num_frames = 7;
  gof.pattern.kind = FramePattern::kDyadic;
  gof.pattern.period_log2 = 2;
  gof.pattern.temporal_layers = 2;
  gof.first_step = 21;
  gof.step = {21, 32, 41};
  gof.learning_flag = true;
  gof.weights = {6, 3, 11, 0};
  gof.prime_log2 = 5;
  gof.max_earlier_distance = 4;
  gof.layer_group_size = {2, 1};
  gof.layer_step = {16, 10, 2};
  gof.num_patches = 3;
  gof.patch_of_vertex = {2, 2, 0, 0, 0, 0, 1, 1, 1};
  std::vector<InterFrame> frames(7);
  std::vector<Values> values;
  const std::uint32_t groups[] = {2, 2, 2, 1, 2, 1, 2};
  for (std::size_t f = 0; f < 7; ++f) {
    frames[f].layer_groups = groups[f];
    frames[f].residual = compact(kDyadic[f].residual);
    frames[f].expected = kDyadic[f].expected;
    values.push_back(kDyadic[f].values);
  }
  const PatchMotion still;
  frames[4].patches = {
      still, {PatchMode::kMotion, kFirstMotion}, {PatchMode::kAlone, kOtherMotion}};
  frames[2].patches = {
      {PatchMode::kMotion, kFirstMotion}, still, {PatchMode::kMotion, kOtherMotion}};
  frames[3].patches = frames[2].patches;
  frames[6].patches = {
      {PatchMode::kAlone, kFirstMotion}, {PatchMode::kMotion, kOtherMotion}, still};
  frames[5].patches = {still, still, still};
  frames[5].reference = 2;
  frames[1] = {};
  frames[1].layer_groups = 2;
  frames[1].repeated = 2;
  gof.frames = std::make_shared<std::vector<InterFrame>>(std::move(frames));
  expect_values(gof, values);
}

// The frames are coded in the order 0, 3, 1, 2, 6, 4, 5; the first has counterparts and axes.
TEST(InterReconVectors, StartFromPositionsInAnOrderOfTheirOwn) {
  InterGof gof;
  gof.num_frames = 7;
  gof.pattern.kind = FramePattern::kExplicit;
  gof.pattern.entries = {{3, {0, 0}, 0}, {1, {0, 3}, 1}, {2, {1, 1}, 3}};
  gof.pattern.temporal_layers = 3;
  gof.exact_flag = true;
  gof.step.assign(4, kExactInterStep);
  gof.weights = {1, 15, 0, 0};
  gof.max_earlier_distance = 3;
  gof.layer_group_size = {3};
  gof.layer_step = {16, 16, 16};
  gof.rest = {true, true, 63, 1, true, true};
  std::vector<InterFrame> frames(7);
  for (InterFrame& frame : frames) frame.layer_groups = 1;
  frames[0].residual = compact({40, -20, 7, 3,  1,  -1, 20, -5, 6,  9,  -8, 0,  -3, -3,
                                -3, 1,   4, -3, -3, -3, -3, -3, -3, -3, -3, -3, -3});
  frames[0].counterparts.resize(9);
  frames[0].counterparts[4] = {false, true, true, 0, 0};
  frames[0].counterparts[7] = {true, false, false, 0, 0};
  Values residual(27, 0);
  residual[6] = 3;
  residual[8] = -1;
  residual[9] = 1;
  residual[10] = 2;
  frames[3].residual = compact(residual);
  residual[6] = 5;
  frames[1].residual = compact(residual);
  frames[2].residual = compact(Values(27, 1));
  frames[4].residual = compact(Values(27, 0));
  for (const std::size_t f : {0U, 1U, 2U, 3U, 4U}) frames[f].expected.assign(9, 0);
  frames[4].reference = 6;
  frames[5].repeated = 4;
  frames[6].repeated = 3;
  gof.frames = std::make_shared<std::vector<InterFrame>>(std::move(frames));
  const Values third{640,  -400, 112,  736,  -304, 80,   1040,  -384, 192,
                     1568, -272, 352,  2256, -432, 704,  1648,  48,   352,
                     4992, 544,  1376, 3120, -272, 1056, 13776, 1648, 4592};
  expect_values(
      gof, {{640, -320, 112, 688, -304, 96,  992,  -384, 208,  1502, -307,  372,  2173, -465,
             727, 1575, 1,   377, 4857, 390, 1417, 3019, -352, 1082, 13504, 1225, 4676},
            {688, -448, 112, 784, -304, 80,  1088, -384, 192,  1616, -256,  352,  2304, -400,
             704, 1696, 80,  352, 5040, 624, 1376, 3168, -224, 1056, 13824, 1856, 4592},
            {672, -464, 96,  800, -288, 96,  1104, -368, 208,  1648, -224,  384,  2368, -336,
             768, 1744, 128, 400, 5152, 736, 1488, 3248, -144, 1136, 14096, 2128, 4864},
            third,
            third,
            third,
            third});
}

}  // namespace
}  // namespace rlpc
