#include "common/codec/kinds/inter/patch_contexts.h"

#include <gtest/gtest.h>

namespace rlpc {
namespace {

TEST(PatchContextsOfFrames, CopiesLeaveTheOriginalAlone) {
  PatchContexts contexts(2, 2);
  contexts.start_frame(1);
  contexts.start(1);
  const std::uint32_t expected = contexts.expected(0);
  PatchContexts copy = contexts;
  copy.update(0, 1000);
  EXPECT_GT(copy.expected(0), expected);
  EXPECT_EQ(contexts.expected(0), expected);
  EXPECT_NE(&copy.models(0), &contexts.models(0));
  EXPECT_NE(&copy.mode_models(), &contexts.mode_models());
}

TEST(PatchContextsOfFrames, DependOnTheModeBefore) {
  PatchContexts contexts(2, 1);
  contexts.start_frame(0);
  contexts.start(0);
  const auto* neighbour_models = &contexts.mode_models();
  contexts.set_mode(PatchMode::kAlone);
  contexts.start(1);
  EXPECT_EQ(&contexts.mode_models(), neighbour_models);
  contexts.start_frame(0);
  contexts.start(0);
  EXPECT_NE(&contexts.mode_models(), neighbour_models);
}

}  // namespace
}  // namespace rlpc
