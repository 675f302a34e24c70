// Tests the counts of vertices by the mode of their patch, in frames with and without
// residuals.
#include "decoder/codec/kinds/inter/vertex_modes.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace rlpc {
namespace {

// Makes a GOF with two, three and one vertices in three patches.
InterGof gof_of(std::vector<InterFrame> frames) {
  InterGof gof;
  gof.num_patches = 3;
  gof.patch_of_vertex = {0, 1, 1, 2, 0, 1};
  gof.frames = std::make_shared<std::vector<InterFrame>>(std::move(frames));
  return gof;
}

InterFrame frame_with(PatchMode first, PatchMode second, PatchMode third) {
  InterFrame frame;
  frame.layer_groups = 1;
  frame.patches = {{first, {}}, {second, {}}, {third, {}}};
  return frame;
}

TEST(VertexModesOfFrames, ResidualsOfAnyAxisCount) {
  InterFrame frame = frame_with(PatchMode::kNeighbours, PatchMode::kMotion, PatchMode::kAlone);
  frame.residual = CompactResiduals(18);
  frame.residual.set(3, 1);      // vertex 1
  frame.residual.set(8, -1000);  // vertex 2
  frame.residual.set(13, 1);     // vertex 4, from neighbours
  frame.residual.sort();
  const auto modes = vertex_modes(gof_of({frame}));
  EXPECT_EQ(modes, (std::vector<VertexModes>{{2, 2, 2}}));
}

TEST(VertexModesOfFrames, FramesWithoutMotionsOrResiduals) {
  InterFrame repeated;
  repeated.repeated = 0;
  const auto modes = vertex_modes(gof_of(
      {InterFrame{}, frame_with(PatchMode::kMotion, PatchMode::kNeighbours, PatchMode::kMotion),
       repeated}));
  EXPECT_EQ(modes, (std::vector<VertexModes>{{6, 0, 0}, {3, 0, 3}, {0, 0, 0}}));
}

TEST(VertexModesOfFrames, NoneWithoutPatches) {
  InterGof gof = gof_of({InterFrame{}});
  gof.num_patches = 0;
  gof.patch_of_vertex.clear();
  EXPECT_TRUE(vertex_modes(gof).empty());
}

}  // namespace
}  // namespace rlpc
