// Tests the elements of 6.11 and 6.12 up to the ends of their ranges, and beyond.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/testing/skinned_gof_recipe.h"
#include "decoder/testing/skinned_gof_units.h"

namespace rlpc {
namespace {

struct Gof {
  SkinnedGofUnits units;
  Result<bool> parsed;
  SkinnedGof gof;

  explicit Gof(const SkinnedGofRecipe& recipe)
      : units(recipe.is_high() ? high_header(9, 21) : main_header(9, 1), kSquares),
        parsed(units.gof(recipe.payload())) {
    if (parsed) gof = units.parser().finish();
  }
};

// Returns a recipe with three layers in one group.
SkinnedGofRecipe layered() {
  SkinnedGofRecipe recipe;
  recipe.prediction_idc = 3;
  recipe.layer_step_minus1 = {15, 15, 15};
  return recipe;
}

struct Bound {
  const char* rule;
  const char* element;
  std::uint32_t max;
  std::function<void(SkinnedGofRecipe&, std::uint32_t)> set;
};

TEST(ParseSkinnedGofRanges, ElementsAreTakenUpToTheirBoundsAndNotBeyond) {
  const std::vector<Bound> bounds{
      {"R-LVL-06", "num_bones_minus1", 255, [](auto& r, auto v) { r.bones.resize(v + 1); }},
      {"R-GOF-03", "fraction_bits", 24, [](auto& r, auto v) { r.fraction_bits = v; }},
      {"R-BON-01", "rest_step_minus1", 65535, [](auto& r, auto v) { r.rest_step_minus1 = v; }},
      {"R-BON-02", "num_component_groups", 255,
       [](auto& r, auto v) { r.num_component_groups = v; }},
      {"R-BON-06", "num_adaptive_factors", 512,
       [](auto& r, auto v) {
         r = layered();
         r.num_adaptive_factors = v;
       }},
      {"R-BON-03", "num_layer_groups_minus1", 2,
       [](auto& r, auto v) {
         r = layered();
         r.num_layer_groups_minus1 = v;
         r.layer_group_layers_minus1 = {0, 0};
       }},
      {"R-BON-03", "layer_group_layers_minus1", 1,
       [](auto& r, auto v) {
         r = layered();
         r.num_layer_groups_minus1 = 1;
         r.layer_group_layers_minus1 = {v};
       }},
      {"R-BON-03", "layer_group_layers_minus1", 0,
       [](auto& r, auto v) {
         r = layered();
         r.num_layer_groups_minus1 = 2;
         r.layer_group_layers_minus1 = {0, v};
       }},
      {"R-BON-04", "bone_parent_plus1", 2,
       [](auto& r, auto v) {
         r.bones.resize(3);  // 2 bits
         r.bones[2].bone_parent_plus1 = v;
       }},
      {"R-BON-04", "bone_parent_plus1", 4,
       [](auto& r, auto v) {
         r.bones.resize(5);  // 3 bits
         r.bones[4].bone_parent_plus1 = v;
       }},
      {"R-BON-05", "rotation_step_idx", 239,
       [](auto& r, auto v) {
         r.bones[0].rotation_flag = true;
         r.bones[0].rotation_step_idx = v;
       }},
      {"R-BON-05", "origin_step_idx", 239,
       [](auto& r, auto v) {
         r.bones[0].origin_flag = true;
         r.bones[0].origin_step_idx = v;
       }},
      {"R-BON-05", "stretch_step_idx", 239,
       [](auto& r, auto v) {
         r.track_levels = 0;
         r.stretch_flag = true;
         r.bones[0].stretch_idc = 1;
         r.bones[0].stretch_step_idx = v;
       }},
  };
  for (const Bound& bound : bounds) {
    SkinnedGofRecipe recipe;
    bound.set(recipe, bound.max);
    EXPECT_TRUE(Gof(recipe).parsed) << bound.element;
    recipe = {};
    bound.set(recipe, bound.max + 1);
    expect_invalid(Gof(recipe).parsed, bound.rule, bound.element);
  }
}

TEST(ParseSkinnedGofRanges, BonesTakeAllStretches) {
  for (std::uint32_t i = 0; i < 15; ++i) {
    SkinnedGofRecipe recipe;
    recipe.track_levels = i % 4;
    recipe.stretch_flag = true;
    recipe.bones.resize(2);
    BoneRecipe& bone = recipe.bones[i % 2];
    bone.stretch_idc = i % 3;
    bone.stretch_axes = {0, 40000 + i, 65535};
    bone.stretch_order = i % 5;
    bone.stretch_between = i % 3;
    const Gof parsed(recipe);
    ASSERT_TRUE(parsed.parsed) << i;
    EXPECT_TRUE(parsed.gof.stretch_flag);
    const Bone& b = parsed.gof.bones[i % 2];
    EXPECT_EQ(b.stretch, static_cast<Stretch>(i % 3));
    const auto x = static_cast<std::int32_t>(i);
    EXPECT_EQ(b.stretch_axes, i % 3 == 2 ? (Vec3i{-32768, 7232 + x, 32767}) : Vec3i{});
    EXPECT_EQ(b.stretch_residual.size(), i % 3 == 0 ? 0U : 1U);
    EXPECT_EQ(b.stretch_order, i % 3 == 0 ? 0 : static_cast<int>(i % 5));
    const bool has_between = i % 3 > 0 && i % 4 > 0;
    EXPECT_EQ(b.stretch_between, has_between ? static_cast<int>(i % 3) : 0);
    EXPECT_EQ(parsed.gof.bones[1 - i % 2].stretch, Stretch::kNone);
  }
}

TEST(ParseSkinnedGofRanges, ElementsWithoutBoundsTakeAllValues) {
  for (std::uint32_t v = 0; v < 16; ++v) {
    SkinnedGofRecipe recipe = layered();
    recipe.weight_bits = v % 8;
    recipe.damping_log2 = v;
    recipe.outer_weight = 15 - v;
    recipe.outer_scale = v ^ 5U;
    recipe.layer_step_minus1 = {v, 15 - v, v ^ 1U};
    const Gof parsed(recipe);
    ASSERT_TRUE(parsed.parsed);
    EXPECT_EQ(parsed.gof.weight_bits, static_cast<int>(v % 8));
    EXPECT_EQ(parsed.gof.weights.damping_log2, static_cast<int>(v));
    EXPECT_EQ(parsed.gof.weights.outer_weight, static_cast<int>(15 - v));
    EXPECT_EQ(parsed.gof.weights.outer_scale, static_cast<int>(v ^ 5U));
    EXPECT_EQ(parsed.gof.layer_step[0], v + 1);
    EXPECT_EQ(parsed.gof.layer_step[1], 16 - v);
    EXPECT_EQ(parsed.gof.layer_step[2], (v ^ 1U) + 1);
  }
  for (std::uint32_t idc = 0; idc < 4; ++idc) {
    SkinnedGofRecipe recipe = layered();
    recipe.prediction_idc = idc;
    const Gof parsed(recipe);
    ASSERT_TRUE(parsed.parsed) << idc;
    EXPECT_EQ(static_cast<std::uint32_t>(parsed.gof.prediction), idc);
    EXPECT_EQ(parsed.gof.layer_group_size.size(), 1U);
    EXPECT_EQ(parsed.gof.layer_group_size[0], idc == 3 ? 3U : 1U);
  }
}

// 6.11: only in the High profile, and only with layers.
TEST(ParseSkinnedGofRanges, AdaptiveFactorsAreThoseOfTheHighProfile) {
  SkinnedGofRecipe recipe = layered();
  EXPECT_EQ(Gof(recipe).gof.weights.num_adaptive_factors, 0U);
  recipe.num_adaptive_factors = 7;
  EXPECT_EQ(Gof(recipe).gof.weights.num_adaptive_factors, 7U);
  recipe.prediction_idc = 2;
  const Gof parsed(recipe);
  ASSERT_TRUE(parsed.parsed);
  EXPECT_EQ(parsed.gof.weights.num_adaptive_factors, 0U);
}

// 6.11 rest_order( ): with any prediction.
TEST(ParseSkinnedGofRanges, RestPositionsHaveAnOrderOfTheirOwnInTheHighProfile) {
  for (const std::uint32_t weight : {0U, 16U, 63U}) {
    SkinnedGofRecipe recipe;
    recipe.num_adaptive_factors = 0;
    EXPECT_FALSE(Gof(recipe).gof.rest.order_flag);
    recipe.rest_order_flag = true;
    recipe.rest_edge_weight = weight;
    recipe.rest_ring_weight = 63 - weight;
    recipe.rest_axes_flag = weight == 16;
    recipe.rest_counterparts_flag = weight == 63;
    const Gof parsed(recipe);
    ASSERT_TRUE(parsed.parsed);
    const RestSettings& rest = parsed.gof.rest;
    EXPECT_TRUE(rest.order_flag);
    EXPECT_EQ(rest.edge_weight, static_cast<int>(weight));
    EXPECT_EQ(rest.ring_weight, static_cast<int>(63 - weight));
    EXPECT_EQ(rest.axes_flag, weight == 16);
    EXPECT_EQ(rest.counterparts_flag, weight == 63);
    EXPECT_EQ(parsed.gof.counterparts.size(), weight == 63 ? 9U : 0U);
  }
}

TEST(ParseSkinnedGofRanges, BonesTakeAllPivotsFlagsAndOrders) {
  for (std::uint32_t order = 0; order <= 4; ++order) {
    SkinnedGofRecipe recipe;
    BoneRecipe& bone = recipe.bones[0];
    bone.bone_pivot = {0, 65536 + order, 131071};
    bone.rotation_flag = order < 4;
    bone.rotation_order_minus1 = order;
    bone.origin_flag = order != 1;
    bone.origin_order = order;
    const Gof parsed(recipe);
    ASSERT_TRUE(parsed.parsed) << order;
    const Bone& b = parsed.gof.bones[0];
    EXPECT_EQ(b.pivot, (Vec3i{-65536, static_cast<std::int32_t>(order), 65535}));
    EXPECT_EQ(b.rotation_flag, order < 4);
    EXPECT_EQ(b.origin_flag, order != 1);
    if (b.rotation_flag) {
      EXPECT_EQ(b.rotation_order, static_cast<int>(order) + 1);
    }
    if (b.origin_flag) {
      EXPECT_EQ(b.origin_order, static_cast<int>(order));
    }
  }
}

// Only the High profile has levels, and only with levels do tracks code their order.
TEST(ParseSkinnedGofRanges, TracksTakeAllOrders) {
  for (std::uint32_t levels = 0; levels <= 7; ++levels) {
    for (std::uint32_t between = 0; between <= 2; ++between) {
      SkinnedGofRecipe recipe;
      recipe.num_gof_frames_minus1 = 20;
      recipe.track_levels = levels;
      recipe.bones[0].rotation_flag = recipe.bones[0].origin_flag = true;
      recipe.bones[0].rotation_between = between;
      recipe.bones[0].origin_between = 2 - between;
      const Gof parsed(recipe);
      ASSERT_TRUE(parsed.parsed) << levels;
      EXPECT_EQ(parsed.gof.track_levels, static_cast<int>(levels));
      const Bone& bone = parsed.gof.bones[0];
      EXPECT_EQ(bone.rotation_between, levels > 0 ? static_cast<int>(between) : 0);
      EXPECT_EQ(bone.origin_between, levels > 0 ? static_cast<int>(2 - between) : 0);
    }
  }
}

TEST(ParseSkinnedGofRanges, TemporalLayersAreAtMostOneMoreThanLevels) {
  for (std::uint32_t levels = 0; levels <= 7; ++levels) {
    for (std::uint32_t layers_minus1 = 0; layers_minus1 <= 7; ++layers_minus1) {
      SkinnedGofRecipe recipe;
      recipe.num_gof_frames_minus1 = 20;
      recipe.track_levels = levels;
      recipe.num_temporal_layers_minus1 = layers_minus1;
      const Gof parsed(recipe);
      if (levels == 0 || layers_minus1 <= levels) {
        ASSERT_TRUE(parsed.parsed) << levels << " " << layers_minus1;
        EXPECT_EQ(parsed.gof.num_temporal_layers,
                  levels == 0 ? 1 : static_cast<int>(layers_minus1) + 1);
      } else {
        ASSERT_FALSE(parsed.parsed) << levels << " " << layers_minus1;
        EXPECT_EQ(std::string(parsed.parsed.error().rule), "R-TRK-01");
      }
    }
  }
}

// Slices of a mesh without triangles, with one layer. Bones after the first are extra bones.
class Slices {
 public:
  explicit Slices(std::uint32_t num_vertices, std::size_t num_bones = 1,
                  std::uint32_t weight_bits = 0, std::uint32_t num_frames = 1)
      : header_(main_header(num_vertices, num_frames)),
        topology_(make_topology(num_vertices, {})),
        meshes_(topology_, {}),
        units_(header_) {
    SkinnedGofRecipe recipe;
    recipe.num_gof_frames_minus1 = num_frames - 1;
    recipe.num_component_groups = 1;
    recipe.weight_bits = weight_bits;
    recipe.bones.resize(num_bones);
    EXPECT_TRUE(units_.gof(recipe.payload()));
  }

  void add_residuals(SliceRecipe& slice, std::size_t num_factors) const {
    const OrderedMesh& mesh = meshes_[Prediction::kNone];
    slice.vertex_residuals(mesh, mesh.order(), num_factors);
  }
  Result<bool> parse(SliceRecipe& slice) { return units_.slice(slice.payload()); }
  // Parses component group 0, with a single bone.
  void parse_rest() {
    SliceRecipe rest(0, 0);
    add_residuals(rest, kRestFactors);
    EXPECT_TRUE(parse(rest));
  }
  SkinnedGof finish() { return units_.parser().finish(); }

 private:
  SequenceHeader header_;
  Topology topology_;
  OrderedMeshes meshes_;
  SkinnedGofUnits units_;
};

TEST(ParseSliceRanges, GroupsAreThoseOfTheGof) {
  const auto parse = [](std::uint32_t component_group, std::uint32_t layer_group) {
    Slices slices(3);
    slices.parse_rest();
    SliceRecipe slice(component_group, layer_group);
    slice.num_group_components_minus1(0);
    slice.trajectory(0, 0, 0, 0, 0, 1);
    slices.add_residuals(slice, 1);
    return slices.parse(slice);
  };
  EXPECT_TRUE(parse(1, 0));
  expect_invalid(parse(2, 0), "R-SLI-01", "component_group_idx");
  expect_invalid(parse(1, 1), "R-SLI-01", "layer_group_idx");
}

TEST(ParseSliceRanges, ComponentsAreAtLeastOneAndBoundedByTheLevel) {
  const auto parse = [](std::int32_t minus1) {
    Slices slices(3);
    slices.parse_rest();
    SliceRecipe slice(1, 0);
    slice.num_group_components_minus1(minus1);
    for (std::int32_t l = 0; l <= minus1; ++l) slice.trajectory(0, 0, 0, 0, 0, 1);
    slices.add_residuals(slice, static_cast<std::size_t>(minus1) + 1);
    return slices.parse(slice);
  };
  EXPECT_TRUE(parse(0));
  EXPECT_TRUE(parse(511));
  expect_invalid(parse(-1), "R-SLI-03", "num_group_components_minus1");
  expect_invalid(parse(512), "R-SLI-03", "num_group_components_minus1");
}

// 6 * 256 + 3 * 16384 factors without trajectories, 16384 + 3 * 256 for each; 487 have more
// than 2^23. With fewer, missing bytes are detected after the first.
TEST(ParseSliceRanges, FactorsAreBoundedByTheLevel) {
  for (const std::int32_t count : {486, 487}) {
    Slices slices(16384, 1, 0, 256);
    slices.parse_rest();
    SliceRecipe slice(1, 0);
    slice.num_group_components_minus1(count - 1);
    const auto parsed = slices.parse(slice);
    if (count == 487) {
      expect_invalid(parsed, "R-LVL-05", "num_group_components_minus1");
    } else {
      ASSERT_FALSE(parsed);
      EXPECT_STRNE(parsed.error().rule, "R-LVL-05");
    }
  }
}

TEST(ParseSliceRanges, ComponentHeadersAreWithinTheirRanges) {
  // The first trajectory has 100, 5 and 8; the arguments are the deltas of the second.
  const auto parse = [](std::int32_t scale_idx, std::int32_t spatial_bits,
                        std::int32_t temporal_bits) {
    Slices slices(1);
    slices.parse_rest();
    SliceRecipe slice(1, 0);
    slice.num_group_components_minus1(1);
    slice.trajectory(100, 4, 7, 0, 0, 1);
    slice.trajectory(scale_idx, spatial_bits, temporal_bits, 0, 0, 1);
    slices.add_residuals(slice, 2);
    return slices.parse(slice);
  };
  EXPECT_TRUE(parse(27, 19, 18));
  EXPECT_TRUE(parse(-100, -4, -7));
  expect_invalid(parse(28, 0, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse(-101, 0, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse(0, 20, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse(0, -5, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse(0, 0, 19), "R-GOF-12", "temporal_bits_delta");
  expect_invalid(parse(0, 0, -8), "R-GOF-12", "temporal_bits_delta");
}

TEST(ParseSliceRanges, TrajectoriesTakeAllPredictorsAndWeights) {
  for (int predictor = 0; predictor <= kMaxTemporalPredictor; ++predictor) {
    for (const std::uint32_t weight : {0U, 256U, 511U}) {
      Slices slices(1);
      slices.parse_rest();
      SliceRecipe slice(1, 0);
      slice.num_group_components_minus1(0);
      slice.trajectory(0, 0, 0, static_cast<std::uint32_t>(predictor), weight, 1);
      slices.add_residuals(slice, 1);
      ASSERT_TRUE(slices.parse(slice));
      const Trajectory t = slices.finish().trajectories.at(0);
      EXPECT_EQ(t.temporal_predictor, predictor);
      for (int k = 0; k < kMaxTemporalWeights; ++k) {
        const int expected = k < predictor - 4 ? static_cast<int>(weight) - 256 : 0;
        EXPECT_EQ(t.temporal_weight[static_cast<std::size_t>(k)], expected);
      }
    }
  }
}

// Parses one vertex and three bones; bone 0 is its candidate. Weights minus 1, with a sum of 4.
Result<bool> parse_extra_bones(
    const std::vector<std::pair<std::uint32_t, std::uint32_t>>& bones, bool flag_follows) {
  Slices slices(1, 3, 2);
  SliceRecipe slice(0, 0);
  slice.extra_bones(bones, 2, 2);
  if (flag_follows) slice.section.bin(slice.models.extra_bone_flag[bones.size()], false);
  slices.add_residuals(slice, kRestFactors);
  return slices.parse(slice);
}

TEST(ParseSliceRanges, ExtraBonesAreNewOnesOfTheGof) {
  EXPECT_TRUE(parse_extra_bones({{1, 0}}, true));
  EXPECT_TRUE(parse_extra_bones({{2, 0}}, true));
  EXPECT_TRUE(parse_extra_bones({{2, 0}, {1, 0}}, false));
  expect_invalid(parse_extra_bones({{3, 0}}, true), "R-SLI-04", "extra_bone");
  expect_invalid(parse_extra_bones({{0, 0}}, true), "R-SLI-04", "extra_bone");
  expect_invalid(parse_extra_bones({{2, 0}, {2, 0}}, false), "R-SLI-04", "extra_bone");
}

TEST(ParseSliceRanges, WeightsAreWithinWhatIsLeft) {
  EXPECT_TRUE(parse_extra_bones({{1, 3}}, false));
  EXPECT_TRUE(parse_extra_bones({{1, 0}, {2, 2}}, false));
  expect_invalid(parse_extra_bones({{1, 0}, {2, 3}}, false), "R-SLI-05",
                 "extra_bone_weight_minus1");
  expect_invalid(parse_extra_bones({{1, 2}, {2, 1}}, false), "R-SLI-05",
                 "extra_bone_weight_minus1");
}

}  // namespace
}  // namespace rlpc
