// Tests the elements of 6.13 up to the ends of their ranges, and beyond; and NumFactors with
// shared rigs.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/testing/skinned_gof_recipe.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/testing/skinned_gof_units.h"

namespace rlpc {
namespace {

using Memory = std::uint64_t;
constexpr Memory kAmple = Memory{1} << 40;

// Units of a mesh without triangles.
class Units {
 public:
  explicit Units(std::uint32_t num_vertices, std::uint32_t num_frames = 1,
                 Memory max_memory_bytes = kAmple)
      : header_(high_header(num_vertices, num_frames)),
        topology_(make_topology(num_vertices, {})),
        meshes_(topology_, {}),
        parser_(header_, meshes_, {max_memory_bytes, 0}) {}

  Result<bool> rig(const SkinnedGofRecipe& recipe, std::uint32_t rig_idx) {
    const Bytes payload = recipe.rig_payload(rig_idx);
    BitReader r(payload);
    return parser_.rig(r, rigs);
  }
  Result<bool> gof(const Bytes& payload) {
    BitReader r(payload);
    const GofHeader header = parse_gof_header(r, header_, 0);
    if (r.error()) return *r.error();
    return header.kind == GofKind::kSharedRig ? parser_.tracks(r, header, rigs)
                                              : parser_.bones(r, header, rigs);
  }
  Result<bool> slice(SliceRecipe& recipe) {
    const Bytes payload = recipe.payload();
    BitReader r(payload);
    return parser_.slice(r, kUnitBitPos);
  }
  // Adds residuals of all vertices.
  void add_residuals(SliceRecipe& slice, std::size_t num_factors) const {
    const OrderedMesh& mesh = meshes_[Prediction::kNone];
    slice.vertex_residuals(mesh, mesh.order(), num_factors);
  }
  Result<bool> rest() {
    SliceRecipe slice(0, 0);
    add_residuals(slice, kRestFactors);
    return this->slice(slice);
  }
  // Parses component group 1 of a shared rig.
  Result<bool> group(const std::vector<std::int32_t>& spatial_bits_deltas) {
    SliceRecipe slice(1, 0);
    slice.num_group_components_minus1(static_cast<std::int32_t>(spatial_bits_deltas.size()) -
                                      1);
    for (const std::int32_t delta : spatial_bits_deltas) slice.spatial_header(delta);
    add_residuals(slice, spatial_bits_deltas.size());
    return this->slice(slice);
  }
  void keep() { rigs.slots[parser_.rig_idx()] = parser_.finish_rig(); }
  SkinnedGofParser& parser() { return parser_; }

  RigSlots rigs;

 private:
  SequenceHeader header_;
  Topology topology_;
  OrderedMeshes meshes_;
  SkinnedGofParser parser_;
};

// Returns a rig with a number of factors, in steps of the number of vertices.
std::shared_ptr<SharedRig> rig_of(std::uint32_t num_vertices, std::size_t factors) {
  auto rig = std::make_shared<SharedRig>();
  rig->influences.resize(num_vertices);
  rig->trajectories.resize(factors - kRestFactors);
  return rig;
}

Bytes gof_of_bones() {
  SkinnedGofRecipe recipe;
  recipe.num_adaptive_factors = 0;  // High profile
  return recipe.payload();
}

TEST(ParseRigRanges, RigsHaveEightIndices) {
  for (std::uint32_t idx = 0; idx < kMaxRigs; ++idx) {
    Units units(2);
    ASSERT_TRUE(units.rig({}, idx));
    EXPECT_EQ(units.parser().rig_idx(), idx);
    units.keep();
    for (std::uint32_t other = 0; other < kMaxRigs; ++other) {
      const auto parsed = units.gof(SkinnedGofRecipe().tracks_payload(2, other, 0));
      EXPECT_EQ(static_cast<bool>(parsed), other == idx);
      if (parsed) continue;
      EXPECT_EQ(parsed.error().code, Errc::kUnsupported);
      EXPECT_STREQ(parsed.error().rule, "R-MOD-01");
      EXPECT_STREQ(parsed.error().element, "rig_idx");
    }
  }
}

TEST(ParseRigRanges, TheHeaderIsThatOfAGof) {
  SkinnedGofRecipe recipe;
  recipe.bones.resize(257);
  expect_invalid(Units(2).rig(recipe, 0), "R-LVL-06", "num_bones_minus1");
  recipe = {};
  recipe.rest_step_minus1 = 65536;
  expect_invalid(Units(2).rig(recipe, 0), "R-BON-01", "rest_step_minus1");
  recipe = {};
  recipe.num_component_groups = 256;
  expect_invalid(Units(2).rig(recipe, 0), "R-BON-02", "num_component_groups");
}

// 16384 vertices, and 2^21 values at level 1.
TEST(ParseRigRanges, AdaptiveValuesAreBoundedByTheLevel) {
  for (const std::uint32_t adaptive : {0U, 128U, 129U, 512U}) {
    SkinnedGofRecipe recipe;
    recipe.prediction_idc = 3;
    recipe.layer_step_minus1 = {15};
    recipe.num_adaptive_factors = adaptive;
    const auto rig = Units(16384).rig(recipe, 0);
    const auto gof = Units(16384).gof(recipe.payload());
    if (adaptive <= 128) {
      EXPECT_TRUE(rig && gof);
    } else {
      expect_invalid(rig, "R-LVL-09", "num_adaptive_factors");
      expect_invalid(gof, "R-LVL-09", "num_adaptive_factors");
    }
  }
}

TEST(ParseRigRanges, LocalGroupsAreWithinWhatTheRigLeaves) {
  for (const std::uint32_t rig_groups : {0U, 1U, 254U, 255U}) {
    Units units(2);
    SkinnedGofRecipe recipe;
    recipe.num_component_groups = rig_groups;
    ASSERT_TRUE(units.rig(recipe, 3));
    units.keep();
    EXPECT_TRUE(units.gof(recipe.tracks_payload(2, 3, 255 - rig_groups)));
    expect_invalid(units.gof(recipe.tracks_payload(2, 3, 256 - rig_groups)), "R-BON-02",
                   "num_local_groups");
  }
}

TEST(ParseRigRanges, SpatialBitsAreWithinTheirRange) {
  const auto parse = [](std::int32_t first, std::int32_t second) {
    Units units(2);
    SkinnedGofRecipe recipe;
    recipe.num_component_groups = 1;
    EXPECT_TRUE(units.rig(recipe, 0));
    EXPECT_TRUE(units.rest());
    return units.group({first, second});
  };
  EXPECT_TRUE(parse(23, -23));
  EXPECT_TRUE(parse(0, 23));
  expect_invalid(parse(-1, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse(24, 0), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse(23, 1), "R-GOF-11", "spatial_bits_delta");
  expect_invalid(parse(1, -2), "R-GOF-11", "spatial_bits_delta");
}

// Rig of one component group of `count` trajectories, and a GOF that uses it.
class Tracks {
 public:
  explicit Tracks(std::size_t count, std::uint32_t local_groups = 0) : units_(2, 3) {
    SkinnedGofRecipe recipe;
    recipe.num_component_groups = 1;
    recipe.num_gof_frames_minus1 = 2;
    EXPECT_TRUE(units_.rig(recipe, 0));
    EXPECT_TRUE(units_.rest());
    EXPECT_TRUE(units_.group(std::vector<std::int32_t>(count, 0)));
    units_.keep();
    EXPECT_TRUE(units_.gof(recipe.tracks_payload(2, 0, local_groups)));
  }
  Result<bool> slice(SliceRecipe& slice) { return units_.slice(slice); }
  void add_residuals(SliceRecipe& slice, std::size_t factors) {
    units_.add_residuals(slice, factors);
  }
  SkinnedGof finish() { return units_.parser().finish(); }

 private:
  Units units_;
};

TEST(ParseTracksRanges, HeadersAreWithinTheirRanges) {
  // The first trajectory has 100 and 8, the second is still, and the arguments are the deltas
  // of the third.
  const auto parse = [](std::int32_t scale_idx, std::int32_t temporal_bits) {
    Tracks tracks(3);
    SliceRecipe slice(1, 0);
    slice.track(100, 7, 3);
    slice.trajectory_flag(false);
    slice.track(scale_idx, temporal_bits, 3);
    return tracks.slice(slice);
  };
  EXPECT_TRUE(parse(27, 18));
  EXPECT_TRUE(parse(-100, -7));
  expect_invalid(parse(28, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse(-101, 0), "R-GOF-10", "scale_idx_delta");
  expect_invalid(parse(0, 19), "R-GOF-12", "temporal_bits_delta");
  expect_invalid(parse(0, -8), "R-GOF-12", "temporal_bits_delta");
}

TEST(ParseTracksRanges, StillTrajectoriesHaveNothingElse) {
  Tracks tracks(4);
  SliceRecipe slice(1, 0);
  slice.trajectory_flag(false);
  slice.track(5, 6, 3);
  slice.trajectory_flag(false);
  slice.trajectory_flag(false);
  ASSERT_TRUE(tracks.slice(slice));
  const SkinnedGof gof = tracks.finish();
  ASSERT_EQ(gof.trajectories.size(), 4U);
  for (std::size_t l = 0; l < 4; ++l) {
    EXPECT_EQ(gof.trajectories[l].trajectory_flag, l == 1);
    EXPECT_EQ(gof.trajectories[l].residual.size(), l == 1 ? 3U : 0U);
    EXPECT_EQ(gof.trajectories[l].spatial_bits, 1);
  }
  EXPECT_EQ(gof.trajectories[1].scale_idx, 5);
  EXPECT_EQ(gof.trajectories[1].temporal_bits, 7);
}

// 7.13.2: one slice for each component group of the rig, and none for its rest positions.
TEST(ParseTracksRanges, SlicesAreThoseOfTheRig) {
  const auto parse = [](std::uint32_t group, std::uint32_t layers) {
    Tracks tracks(1, 1);
    SliceRecipe slice(group, layers);
    slice.trajectory_flag(false);
    return tracks.slice(slice);
  };
  EXPECT_TRUE(parse(1, 0));
  expect_invalid(parse(0, 0), "R-SLI-02", "slice_unit");
  expect_invalid(parse(1, 1), "R-SLI-01", "layer_group_idx");
  expect_invalid(parse(2, 0), "R-SLI-02", "slice_unit");
  expect_invalid(parse(3, 0), "R-SLI-01", "component_group_idx");
}

// 512 trajectories at level 1, with those of the rig.
TEST(ParseTracksRanges, TrajectoriesOfBothAreBoundedByTheLevel) {
  const auto parse = [](std::int32_t local) {
    Tracks tracks(510, 1);
    SliceRecipe slice(1, 0);
    for (int l = 0; l < 510; ++l) slice.trajectory_flag(false);
    EXPECT_TRUE(tracks.slice(slice));
    SliceRecipe own(2, 0);
    // Not the first slice with such elements: the models continue.
    own.models = slice.models;
    own.num_group_components_minus1(local - 1);
    for (std::int32_t l = 0; l < local; ++l) own.trajectory(0, 0, 0, 0, 0, 3);
    tracks.add_residuals(own, static_cast<std::size_t>(local));
    return tracks.slice(own);
  };
  EXPECT_TRUE(parse(2));
  expect_invalid(parse(3), "R-SLI-03", "num_group_components_minus1");
}

// 2^23 factors at level 1, which are 512 for each of 16384 vertices. All rigs count together:
// for a rig, those that it does not replace; for a GOF that uses one, all.
TEST(ParseRigRanges, FactorsOfAllRigsAreBoundedByTheLevel) {
  constexpr std::uint32_t kVertices = 16384;
  for (const std::size_t others : {509U, 510U}) {
    Units units(kVertices);
    units.rigs.slots[2] = rig_of(kVertices, others - 3);
    units.rigs.slots[6] = rig_of(kVertices, 3);
    const auto added = units.rig({}, 0);
    if (others == 509) {
      EXPECT_TRUE(added);
    } else {
      expect_invalid(added, "R-LVL-05", "bone_section");
    }
    EXPECT_TRUE(units.rig({}, 2));  // replaces a rig
    EXPECT_TRUE(units.gof(gof_of_bones()));
  }
}

TEST(ParseRigRanges, FactorsOfGofsWithRigsAreBoundedByTheLevel) {
  constexpr std::uint32_t kVertices = 16384;
  for (const std::size_t factors : {511U, 512U}) {
    Units units(kVertices);
    SkinnedGofRecipe recipe;
    recipe.num_component_groups = 1;
    ASSERT_TRUE(units.rig(recipe, 0));
    ASSERT_TRUE(units.rest());
    ASSERT_TRUE(units.group({0}));
    units.keep();
    units.rigs.slots[1] = rig_of(kVertices, factors - 4);
    const auto gof = units.gof(recipe.tracks_payload(2, 0, 1));
    if (factors == 512) {
      expect_invalid(gof, "R-LVL-05", "track_section");
      continue;
    }
    ASSERT_TRUE(gof);
    SliceRecipe tracks(1, 0);
    tracks.trajectory_flag(false);
    ASSERT_TRUE(units.slice(tracks));
    // One factor per vertex is left, minus 6 for the bone and 3 for each trajectory.
    SliceRecipe local(2, 0);
    local.models = tracks.models;
    local.num_group_components_minus1(0);
    expect_invalid(units.slice(local), "R-LVL-05", "num_group_components_minus1");
  }
}

// Tracks count 3 factors per frame.
TEST(ParseRigRanges, FactorsOfTracksAreBoundedByTheLevel) {
  constexpr std::uint32_t kVertices = 8000;
  for (const std::size_t left : {3U * 512, 3U * 512 - 1}) {
    Units units(kVertices, 512);
    SkinnedGofRecipe recipe;
    recipe.num_component_groups = 1;
    recipe.num_gof_frames_minus1 = 511;
    ASSERT_TRUE(units.rig(recipe, 0));
    ASSERT_TRUE(units.rest());
    ASSERT_TRUE(units.group({0}));
    units.keep();
    // The other rig leaves 4 factors of this one, the bone, and `left`.
    const std::uint64_t others = (1U << 23) - 4 * kVertices - 6 * 512 - left;
    auto other = rig_of(1, 3);
    other->influences.resize(1);
    other->trajectories.resize(others - kRestFactors);
    units.rigs.slots[1] = other;
    ASSERT_TRUE(units.gof(recipe.tracks_payload(2, 0, 0)));
    SliceRecipe tracks(1, 0);
    tracks.trajectory_flag(false);
    const auto parsed = units.slice(tracks);
    if (left == 3U * 512) {
      EXPECT_TRUE(parsed);
    } else {
      expect_invalid(parsed, "R-LVL-05", "trajectory_flag");
    }
  }
}

// Counts the memory of the unit, of its reconstruction, and of other shared rigs, including the
// one being replaced.
TEST(ParseRigRanges, RigsStayWithinTheMemoryOfTheCaller) {
  const Memory kept = memory_of_rig(*rig_of(5, 4));
  const Memory own = memory_of_vertices(5, false) + memory_of_spatial(5, 3);
  for (const std::size_t kept_idx : {7U, 0U}) {
    const auto parse = [&](Memory max_bytes) {
      Units units(5, 1, max_bytes);
      units.rigs.slots[kept_idx] = rig_of(5, 4);
      return units.rig({}, 0);
    };
    const auto too_little = parse(kept + own);
    ASSERT_FALSE(too_little);
    EXPECT_EQ(too_little.error().code, Errc::kLimitExceeded);
    EXPECT_STREQ(too_little.error().element, "bone_section");
    const Memory needed = too_little.error().needed_bytes;
    EXPECT_GT(needed, kept + own);
    EXPECT_LT(needed, kept + own + SkinnedGofRecipe().rig_payload(0).size());
    EXPECT_TRUE(parse(needed));
    EXPECT_FALSE(parse(needed - 1));
  }
}

// Tests a skinned GOF, and skinned GOFs with a shared rig, without and with local component
// groups.
TEST(ParseRigRanges, GofsStayWithinTheMemoryOfTheCaller) {
  const auto rig = rig_of(5, 4);
  rig->bones.resize(1);
  const Memory kept = memory_of_rig(*rig);
  const Memory vertex_bytes = memory_of_vertices(5, false) + memory_of_spatial(5, 3);
  const SkinnedGofRecipe recipe;
  const std::pair<Bytes, Memory> gofs[] = {
      {gof_of_bones(), kept + vertex_bytes + memory_of_tracks(6)},
      {recipe.tracks_payload(2, 7, 0), kept + memory_of_tracks(6)},
      {recipe.tracks_payload(2, 7, 1),
       kept + memory_of_tracks(6) + memory_of_adaptive_weights(5)}};
  for (const auto& [payload, bytes] : gofs) {
    Units units(5, 1, 0);
    units.rigs.slots[7] = rig;
    const auto parsed = units.gof(payload);
    ASSERT_FALSE(parsed);
    EXPECT_EQ(parsed.error().code, Errc::kLimitExceeded);
    EXPECT_GT(parsed.error().needed_bytes, bytes);
    EXPECT_LT(parsed.error().needed_bytes, bytes + payload.size());
  }
}

}  // namespace
}  // namespace rlpc
