#include "common/codec/kinds/inter/recon/inter_recon.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/parallel/for_each.h"
#include "common/testing/grid.h"
#include "common/testing/inter_recon_of_text.h"
#include "common/testing/random_inter_gof.h"
#include "common/testing/tube.h"

namespace rlpc {
namespace {

using Values = std::vector<std::int32_t>;

struct Mesh {
  Topology topology;
  OrderedMeshes meshes;

  Mesh(std::uint32_t num_vertices, const std::vector<Triangle>& triangles)
      : topology(make_topology(num_vertices, triangles)), meshes(topology, triangles) {}
  const OrderedMesh& operator*() const { return meshes[Prediction::kLayers]; }
};

// Returns a random GOF, with expected magnitudes of any size in place of those of a parser.
InterGof random_gof(unsigned seed, const OrderedMesh& mesh, std::uint32_t num_frames) {
  InterGof gof = random_inter_gof(seed, mesh, num_frames);
  auto frames = std::make_shared<std::vector<InterFrame>>(*gof.frames);
  std::mt19937 random(seed);
  for (InterFrame& frame : *frames) {
    if (frame.layer_groups == 0 || frame.repeated) continue;
    for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
      const std::uint32_t max_expected = random() % 4 == 0 ? kMaxInterExpected : 40;
      frame.expected.push_back(static_cast<std::uint16_t>(random() % (max_expected + 1)));
    }
  }
  gof.frames = std::move(frames);
  return gof;
}

void expect_same_frames(const OrderedMesh& mesh, const InterGof& gof, int position_bits) {
  InterReconOfText text(mesh, gof, position_bits);
  InterRecon recon(mesh, gof, position_bits);
  const FrameOrder order(gof.pattern, gof.num_frames);
  Values positions(3 * std::size_t{mesh.num_vertices()});
  for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
    const FramePlace& at = order[place];
    text.decode_next();
    ASSERT_EQ(recon.place(), place);
    recon.decode(at, order.last_use(at.frame), (*gof.frames)[at.frame]);
    recon.positions(positions);
    ASSERT_EQ(positions, text.positions(at.frame)) << "frame " << at.frame;
    if (place == 0) continue;
    ASSERT_TRUE(std::equal(text.reference.begin(), text.reference.end(),
                           recon.reference().begin(), recon.reference().end()))
        << "frame " << at.frame;
  }
}

TEST(RandomInterGofs, ReconstructAsSpecified) {
  const Mesh tube(14 * 9 + 2, tube_triangles(14, 9));
  const Mesh sheet(7 * 6, grid_triangles(7, 6, false));
  const Mesh torus(6 * 6, grid_triangles(6, 6, true));
  const Mesh alone(20, {});
  int patches = 0;
  int learning = 0;
  int earlier = 0;
  int absent = 0;
  int in_order = 0;
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    const Mesh& mesh = seed % 8 == 0   ? alone
                       : seed % 4 == 1 ? tube
                       : seed % 4 == 2 ? sheet
                                       : torus;
    const InterGof gof = random_gof(seed, *mesh, 1 + seed % 11);
    patches += gof.num_patches > 0 ? 1 : 0;
    learning += gof.learning_flag ? 1 : 0;
    in_order += gof.rest.order_flag ? 1 : 0;
    for (const InterFrame& frame : *gof.frames) {
      earlier += frame.repeated || frame.reference ? 1 : 0;
      absent += frame.layer_groups < gof.layer_group_size.size() ? 1 : 0;
    }
    const int position_bits = seed % 5 == 0 ? 24 : 4 + static_cast<int>(seed % 19);
    ASSERT_NO_FATAL_FAILURE(expect_same_frames(*mesh, gof, position_bits));
  }
  for (const int count : {patches, learning, earlier, absent, in_order}) EXPECT_GT(count, 30);
}

// 8.19.2: at most 256 vertices of the base are candidates, those before or around a vertex.
TEST(RandomInterGofs, HaveNearVerticesInLargeBases) {
  const std::vector<Triangle> triangles = tube_triangles(6, 5);
  for (const std::uint32_t num_vertices : {290U, 700U}) {
    const Mesh mesh(num_vertices, triangles);
    for (const unsigned seed : {1U, 4U}) {
      SCOPED_TRACE(seed);
      ASSERT_NO_FATAL_FAILURE(expect_same_frames(*mesh, random_gof(seed, *mesh, 3), 16));
    }
  }
}

// The layers have several passes.
TEST(RandomInterGofs, DoNotDependOnThreads) {
  const Mesh mesh(40 * 30, tube_triangles(40, 30));
  const Threads threads(3);
  for (const unsigned seed : {3U, 4U, 9U}) {
    SCOPED_TRACE(seed);
    ASSERT_NO_FATAL_FAILURE(expect_same_frames(*mesh, random_gof(seed, *mesh, 4), 16));
  }
}

// Takes the steps of decode( ) one by one, as an encoder does; the weights adapt in the end.
TEST(InterRecon, TellsHowVerticesArePredicted) {
  const Mesh mesh(10 * 7 + 1, tube_triangles(10, 7));
  std::size_t num_checked = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    InterGof gof = random_gof(seed, *mesh, 7);
    gof.rest = {};
    InterReconOfText text(*mesh, gof, 18);
    InterRecon recon(*mesh, gof, 18);
    const FrameOrder order(gof.pattern, gof.num_frames);
    for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
      const FramePlace& at = order[place];
      const InterFrame& frame = (*gof.frames)[at.frame];
      text.decode_next();
      recon.start_frame(frame.reference ? at.from(*frame.reference) : at,
                        order.last_use(at.frame), frame.step_delta);
      if (place > 0 && gof.num_patches > 0) recon.move_patches(frame.patches);
      std::vector<VertexMotion> motions((*mesh).num_vertices());
      std::uint32_t present = 0;
      for (std::uint32_t j = 0; j < frame.layer_groups; ++j) present += gof.layer_group_size[j];
      for (std::uint32_t layer = 0; layer < (*mesh).num_layers(); ++layer) {
        const bool is_there = layer < present;
        for (const std::uint32_t v : (*mesh).vertices_of_layers(layer, layer + 1)) {
          VertexMotion& motion = motions[v];
          recon.predict(v, motion, is_there);
          const InterReconOfText::Vertex& expected = text.vertices[v];
          for (std::size_t c = 0; c < 3; ++c) {
            ASSERT_EQ(motion.prediction[c], expected.predicted[c]) << v;
            if (place == 0) continue;
            ASSERT_EQ(motion.plain[c], expected.plain[c]) << v;
            ASSERT_EQ(motion.mean[c], expected.mean[c]) << v;
            ASSERT_TRUE(std::equal(expected.offsets[c].begin(), expected.offsets[c].end(),
                                   motion.offsets[c].begin()));
            ++num_checked;
          }
          Vec3i residual{};
          for (std::size_t c = 0; c < 3 && is_there && !frame.repeated; ++c) {
            residual[c] = frame.residual[3 * std::size_t{v} + c];
          }
          Vec3i values = recon.position(v, motion, residual);
          for (std::size_t c = 0; c < 3; ++c) {
            const std::int64_t decoded = text.decoded[at.frame][3 * std::size_t{v} + c];
            if (frame.repeated) values[c] = static_cast<std::int32_t>(decoded);
            ASSERT_EQ(values[c], decoded) << "frame " << at.frame << ", vertex " << v;
          }
          recon.set(v, motion, values, is_there);
        }
      }
      for (const std::uint32_t v : (*mesh).order()) {
        const bool is_there = (*mesh).layer_of(v) < present;
        const bool has_noise = is_there && !frame.repeated;
        recon.adapt(v, motions[v], is_there, has_noise ? frame.expected[v] : 0U);
      }
      recon.end_frame();
    }
  }
  EXPECT_GT(num_checked, 30000U);
}

// A vertex whose prediction is its reference, in frames with the given residuals along x.
struct OneVertex {
  Mesh mesh{1, {}};
  InterGof gof;
  int position_bits = 12;

  explicit OneVertex(const Values& residuals) {
    gof.num_frames = static_cast<std::uint32_t>(residuals.size());
    gof.layer_step = {kMaxLayerStep};
    auto frames = std::make_shared<std::vector<InterFrame>>(residuals.size());
    for (std::size_t f = 0; f < residuals.size(); ++f) {
      InterFrame& frame = (*frames)[f];
      frame.layer_groups = 1;
      frame.residual = CompactResiduals(3);
      frame.residual.set(0, residuals[f]);
      frame.residual.sort();
      frame.expected = {0};
    }
    gof.frames = frames;
  }
  std::vector<InterFrame> frames() const { return *gof.frames; }
  void set_frames(std::vector<InterFrame> frames) {
    gof.frames = std::make_shared<std::vector<InterFrame>>(std::move(frames));
  }
  Values references;  // x of the reference of each place but the first, 1/16 grid units
  Values grid;        // x of each frame, grid units
  void decode() {
    InterRecon recon(*mesh, gof, position_bits);
    const FrameOrder order(gof.pattern, gof.num_frames);
    references.clear();
    grid.assign(gof.num_frames, 0);
    for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
      const FramePlace& at = order[place];
      recon.decode(at, order.last_use(at.frame), (*gof.frames)[at.frame]);
      if (place > 0) references.push_back(recon.reference()[0]);
      Values xyz(3);
      recon.positions(xyz);
      grid[at.frame] = xyz[0];
      EXPECT_EQ(xyz[1], 0);
    }
  }
};

TEST(InterRecon, FollowsTheFrameBeforeOrTheFirst) {
  OneVertex one({10, 3, -5, 7});
  one.decode();
  EXPECT_EQ(one.grid, (Values{10, 13, 8, 15}));
  EXPECT_EQ(one.references, (Values{160, 208, 128}));
  one.gof.pattern.kind = FramePattern::kFirst;
  one.decode();
  EXPECT_EQ(one.grid, (Values{10, 13, 5, 17}));
}

// Five frames are coded in the order 0, 4, 2, 1, 3, four in the order 0, 3, 1, 2.
TEST(InterRecon, WeighsTwoReferencesByTheirDistance) {
  OneVertex one({10, 0, 0, 0, 7});
  one.gof.pattern.kind = FramePattern::kDyadic;
  one.gof.pattern.period_log2 = 2;
  one.gof.step.assign(3, kExactInterStep);
  one.decode();
  // Frame 4 has 272; the mean of 160 and 272 is 216, and then come 188 and 244.
  EXPECT_EQ(one.references, (Values{160, 216, 188, 244}));
  EXPECT_EQ(one.grid, (Values{10, 12, 14, 15, 17}));  // 11.75, 13.5, 15.25
  OneVertex rest({10, 0, 0, 7});
  rest.gof.pattern = one.gof.pattern;
  rest.gof.step = one.gof.step;
  rest.decode();
  // The references are (2 * 160 + 272) / 3 = 197.3 and (197 + 272) / 2 = 234.5.
  EXPECT_EQ(rest.references, (Values{160, 197, 235}));
  EXPECT_EQ(rest.grid, (Values{10, 12, 15, 17}));
}

TEST(InterRecon, StepsAreThoseOfDepthsAndLayers) {
  OneVertex one({16, 16, 16});
  one.gof.pattern.kind = FramePattern::kDyadic;
  one.gof.pattern.period_log2 = 1;
  one.gof.step = {16, 5};
  one.gof.layer_step = {6};
  one.decode();
  // A residual adds 16 * 16 * 6 / 16 = 96, in frame 1 16 * 5 * 6 / 16 = 30.
  EXPECT_EQ(one.references, (Values{96, 144}));
  EXPECT_EQ(one.grid, (Values{6, 11, 12}));  // 174 / 16 = 10.9
}

// Ties go up: -8/16 becomes 0, 8/16 becomes 1.
TEST(InterRecon, ResidualsAreRoundedToSixteenths) {
  OneVertex one({0, 8, -8, 7, -9, 0});
  one.gof.step = {1};
  one.gof.layer_step = {1};
  one.decode();
  EXPECT_EQ(one.references, (Values{0, 1, 1, 1, 0}));
}

TEST(InterRecon, ExactPositionsStartFromTheGrid) {
  OneVertex one({1, 1, 1, 0, 4});
  one.gof.pattern.kind = FramePattern::kDyadic;
  one.gof.pattern.period_log2 = 2;
  one.gof.step.assign(3, kExactInterStep);
  one.gof.exact_flag = true;
  one.decode();
  // Frames 0 and 4 have 1 and 5, frame 2 has 3 + 1, frame 1 has 2.5 + 1, and frame 3 has 4.5.
  EXPECT_EQ(one.references, (Values{16, 48, 40, 72}));
  EXPECT_EQ(one.grid, (Values{1, 4, 4, 5, 5}));
}

TEST(InterRecon, PositionsAreClippedToTheirBits) {
  OneVertex one({1000, -1, -100000, 1});
  one.position_bits = 4;
  one.decode();
  EXPECT_EQ(one.references, (Values{255, 239, -256}));
  EXPECT_EQ(one.grid, (Values{7, 7, -8, -8}));
}

// Frame 2 repeats frame 0, frame 4 has no unit, and frame 5 is predicted from frame 1.
TEST(InterRecon, FramesCanRepeatOthersOrBeAbsent) {
  OneVertex one({10, 3, 99, 1, 99, 2});
  one.gof.max_earlier_distance = 5;
  auto frames = one.frames();
  frames[2] = {};
  frames[2].layer_groups = 1;
  frames[2].repeated = 0;
  frames[4] = {};
  frames[5].reference = 1;
  one.set_frames(frames);
  one.decode();
  EXPECT_EQ(one.grid, (Values{10, 13, 10, 11, 11, 15}));
  EXPECT_EQ(one.references, (Values{160, 208, 160, 176, 208}));
}

// Frame 30 and those after it are predicted from the frame 30 places before.
TEST(InterRecon, FramesAreKeptAsLongAsTheyAreNeeded) {
  Values residuals(40, 1);
  OneVertex one(residuals);
  one.gof.max_earlier_distance = 30;
  auto frames = one.frames();
  for (std::uint32_t f = 30; f < 40; ++f) frames[f].reference = f - 30;
  one.set_frames(frames);
  one.decode();
  for (int f = 0; f < 30; ++f) EXPECT_EQ(one.grid[static_cast<std::size_t>(f)], f + 1);
  for (int f = 30; f < 40; ++f) EXPECT_EQ(one.grid[static_cast<std::size_t>(f)], f - 30 + 2);
}

// The second of two vertices is predicted from the first in frame 0. Their patches move by 8,
// -12 and 0, and by 16, 0 and 0 sixteenths in each frame.
TEST(InterRecon, ResidualsFollowTheMotionOfTheirPatch) {
  const Mesh mesh(2, {});
  InterGof gof;
  gof.num_frames = 3;
  gof.layer_step = {kMaxLayerStep};
  gof.num_patches = 2;
  gof.patch_of_vertex = {0, 1};
  std::vector<InterFrame> frames(3);
  for (InterFrame& frame : frames) {
    frame.layer_groups = 1;
    frame.residual = CompactResiduals(6);
    frame.expected = {0, 0};
    for (std::size_t i = 0; i < 6; ++i) frame.residual.set(i, static_cast<std::int32_t>(i));
  }
  frames[1].patches = {{PatchMode::kMotion, {2, -3, 0}}, {PatchMode::kMotion, {4}}};
  frames[2].patches = {{PatchMode::kMotion, {}}, {PatchMode::kMotion, {}}};
  gof.frames = std::make_shared<std::vector<InterFrame>>(frames);
  for (const bool exact : {false, true}) {
    gof.exact_flag = exact;
    InterRecon recon(*mesh, gof, 12);
    const FrameOrder order(gof.pattern, 3);
    std::vector<Values> xyz(3, Values(6));
    for (std::uint32_t f = 0; f < 3; ++f) {
      recon.decode(order[f], order.last_use(f), frames[f]);
      recon.positions(xyz[f]);
    }
    EXPECT_EQ(xyz[0], (Values{0, 1, 2, 3, 5, 7}));
    // Vertex 0 is at 0 + 0.5 and 1 - 0.75 + 1.
    EXPECT_EQ(xyz[1], (Values{1, 1, 4, 7, 9, 12}));
    // Vertex 0 is at 0.5 + 0.5 and 1.25 - 0.75 + 1, or exactly at 2 and 0 + 1.
    EXPECT_EQ(xyz[2], exact ? (Values{2, 1, 6, 11, 13, 17}) : (Values{1, 2, 6, 11, 13, 17}));
  }
}

// The first frame has been decoded before.
TEST(InterRecon, IndependentFramesAreDecodedInAnyOrder) {
  OneVertex one({10, 1, 2, 3, 4});
  EXPECT_FALSE(InterRecon(*one.mesh, one.gof, 12).has_independent_frames());
  one.gof.pattern.kind = FramePattern::kFirst;
  InterRecon recon(*one.mesh, one.gof, 12);
  ASSERT_TRUE(recon.has_independent_frames());
  const FrameOrder order(one.gof.pattern, 5);
  Values xyz(3);
  recon.decode(order[0], order.last_use(0), (*one.gof.frames)[0]);
  for (const std::uint32_t f : {3U, 1U, 2U, 2U, 4U}) {
    recon.skip_to(f);
    EXPECT_EQ(recon.place(), f);
    recon.decode(order[f], order.last_use(f), (*one.gof.frames)[f]);
    recon.positions(xyz);
    EXPECT_EQ(xyz[0], 10 + static_cast<int>(f));
  }
  for (const int change : {0, 1, 2}) {
    InterGof gof = one.gof;
    gof.learning_flag = change == 0;
    gof.max_earlier_distance = change == 1 ? 1 : 0;
    gof.num_patches = change == 2 ? 1 : 0;
    EXPECT_FALSE(InterRecon(*one.mesh, gof, 12).has_independent_frames());
  }
}

}  // namespace
}  // namespace rlpc
