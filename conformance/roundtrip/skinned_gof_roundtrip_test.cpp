// Tests writer and parser of skinned GOFs against each other (clauses 6.11 and 6.12).
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/testing/random_skinned_gof.h"
#include "common/testing/residual_bound.h"
#include "conformance/testing/ample_memory.h"
#include "conformance/testing/error_text.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "encoder/codec/write/write_skinned_gof.h"

namespace rlpc {
namespace {

using Payload = std::vector<std::uint8_t>;

SkinnedGofPayloads payloads_of(const RandomSkinnedGof& from) {
  const OrderedMesh mesh = from.coded_mesh();
  return write_skinned_gof(from.gof, mesh, from.header);
}

// Parses one stream, as a decoder does.
class SkinnedReading {
 public:
  explicit SkinnedReading(const RandomSkinnedGof& from, std::uint64_t max_memory = kAmpleMemory)
      : from_(from),
        meshes_(from.topology, from.triangles),
        parser_(from.header, meshes_, {max_memory, 0}) {}

  std::optional<Error> gof(const Payload& payload) {
    BitReader r(payload);
    const GofHeader header = parse_gof_header(r, from_.header, from_.gof.first_frame);
    if (!r.error() && header.kind != GofKind::kSkinned)
      return Error{Errc::kInvalid, "", "bones_flag", 0};
    return error_of(parser_.bones(r, header));
  }
  std::optional<Error> slice(const Payload& payload) {
    BitReader r(payload);
    return error_of(parser_.slice(r, 0));
  }
  // Parses a GOF and its slices, up to the first error.
  std::optional<Error> all(const Payload& gof_payload, const std::vector<Payload>& slices) {
    if (auto error = gof(gof_payload)) return error;
    for (const Payload& payload : slices) {
      if (auto error = slice(payload)) return error;
    }
    return std::nullopt;
  }
  const OrderedMesh& mesh_of(const SkinnedGof& gof) const { return meshes_[gof.prediction]; }
  SkinnedGof finish() { return parser_.finish(); }

 private:
  static std::optional<Error> error_of(const Result<bool>& result) {
    if (result) return std::nullopt;
    return result.error();
  }

  const RandomSkinnedGof& from_;
  OrderedMeshes meshes_;
  SkinnedGofParser parser_;
};

// Compares the parts first: they show where a difference is.
void expect_equal_skinned(const SkinnedGof& a, const SkinnedGof& b) {
  ASSERT_EQ(a.bones.size(), b.bones.size());
  for (std::size_t i = 0; i < a.bones.size(); ++i) EXPECT_TRUE(a.bones[i] == b.bones[i]) << i;
  ASSERT_EQ(a.trajectories.size(), b.trajectories.size());
  for (std::size_t l = 0; l < a.trajectories.size(); ++l) {
    EXPECT_TRUE(a.trajectories[l] == b.trajectories[l]) << l;
  }
  ASSERT_EQ(a.influences.size(), b.influences.size());
  for (std::size_t v = 0; v < a.influences.size(); ++v) {
    ASSERT_TRUE(a.influences[v] == b.influences[v]) << v;
  }
  EXPECT_EQ(a.vertex_residual, b.vertex_residual);
  EXPECT_TRUE(a == b);
}

void expect_skinned_round_trip(const RandomSkinnedGof& from) {
  const SkinnedGofPayloads payloads = payloads_of(from);
  SkinnedReading reading(from);
  const auto error = reading.all(payloads.first, payloads.slices);
  ASSERT_FALSE(error) << text_of(error);
  SkinnedGof parsed = reading.finish();
  parsed.influences = complete_influences(reading.mesh_of(parsed), parsed);
  expect_equal_skinned(from.gof, parsed);
}

// Reconstructs the parsed GOF and checks that positions are within their range.
void expect_frames_in_range(SkinnedReading& reading, int position_bits) {
  const SkinnedGof gof = reading.finish();
  const OrderedMesh& mesh = reading.mesh_of(gof);
  const SkinnedRecon recon(mesh, gof, position_bits);
  std::vector<std::int32_t> positions(3 * std::size_t{mesh.num_vertices()});
  for (std::uint32_t f = 0; f < recon.num_frames(); ++f) {
    recon.frame(f, positions);
    for (const std::int32_t x : positions) {
      ASSERT_GE(x, -(1 << (position_bits - 1)));
      ASSERT_LT(x, 1 << (position_bits - 1));
    }
  }
}

TEST(SkinnedGofRoundTrip, RandomLegalGofsComeBack) {
  for (unsigned seed = 1; seed <= 2000; ++seed) {
    SCOPED_TRACE(seed);
    expect_skinned_round_trip(RandomSkinnedGof(seed, {}));
    if (HasFailure()) return;
  }
}

TEST(SkinnedGofRoundTrip, OneVertexOneFrameAndOneBoneAreEnough) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    expect_skinned_round_trip(
        RandomSkinnedGof(seed, {.max_vertices = 1, .max_frames = 1, .max_bones = 1}));
  }
}

TEST(SkinnedGofRoundTrip, LargerGofsComeBack) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    expect_skinned_round_trip(RandomSkinnedGof(seed, {.max_vertices = 2000, .max_groups = 2}));
    expect_skinned_round_trip(RandomSkinnedGof(seed, {.max_bones = kLevels[0].max_clusters}));
    expect_skinned_round_trip(
        RandomSkinnedGof(seed, {.max_vertices = 8, .max_frames = kLevels[0].max_gof_frames}));
    expect_skinned_round_trip(RandomSkinnedGof(
        seed, {.max_vertices = 8, .max_groups = kMaxComponentGroups, .max_components = 2}));
  }
}

// Alternating largest and smallest residuals drive every running mean to its limits.
TEST(SkinnedGofRoundTrip, ResidualsThatJumpBetweenTheirBoundsComeBack) {
  for (const int period : {1, 2, 7, 50}) {
    for (unsigned seed = 1; seed <= 40; ++seed) {
      SCOPED_TRACE(seed);
      RandomSkinnedGof from(seed, {});
      int count = 0;
      const auto jump = [&](std::int32_t& x) {
        ++count;
        x = count / period % 2 == 0 ? 0 : count % 2 == 0 ? kResidualBound : -kResidualBound;
      };
      const auto jump_track = [&](TrackResiduals& residuals) {
        for (Vec3i& r : residuals) std::for_each(r.begin(), r.end(), jump);
      };
      for (Bone& bone : from.gof.bones) {
        jump_track(bone.rotation_residual);
        jump_track(bone.origin_residual);
        jump_track(bone.stretch_residual);
      }
      for (Trajectory& t : from.gof.trajectories) jump_track(t.residual);
      from.drop_absent_residuals();
      const OrderedMesh mesh = from.coded_mesh();
      for (std::size_t group = 0; group < from.gof.vertex_residual.size(); ++group) {
        std::uint32_t end = 0;
        for (std::uint32_t j = 0; j < from.gof.slice_layers[group]; ++j) {
          end += from.gof.layer_group_size[j];
        }
        auto& residuals = from.gof.vertex_residual[group];
        const std::size_t size = residuals.size() / mesh.num_vertices();
        for (const std::uint32_t v : mesh.vertices_of_layers(0, end)) {
          for (std::size_t k = 0; k < size; ++k) jump(residuals[v * size + k]);
        }
      }
      expect_skinned_round_trip(from);
    }
  }
}

// Returns the first n bytes in an exact-size copy, so that a sanitizer sees one byte over.
Payload prefix_of(const Payload& payload, std::size_t n) {
  return {payload.begin(), payload.begin() + static_cast<std::ptrdiff_t>(n)};
}

// A few prefixes of a payload happen to be payloads themselves; these decode.
TEST(SkinnedGofParser, ProperPrefixesFailOrDecode) {
  int refused = 0;
  int decoded = 0;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {.max_vertices = 12,
                                       .max_frames = 3,
                                       .max_bones = 3,
                                       .max_groups = 2,
                                       .max_components = 2});
    const SkinnedGofPayloads payloads = payloads_of(from);
    for (std::size_t i = 0; i <= payloads.slices.size(); ++i) {
      const Payload& whole = i == 0 ? payloads.first : payloads.slices[i - 1];
      const std::vector<Payload> before(
          payloads.slices.begin(),
          payloads.slices.begin() +
              static_cast<std::ptrdiff_t>(std::max<std::size_t>(i, 1) - 1));
      for (std::size_t n = 0; n < whole.size(); ++n) {
        SkinnedReading reading(from);
        if (i > 0) {
          ASSERT_FALSE(reading.all(payloads.first, before));
        }
        const Payload prefix = prefix_of(whole, n);
        if (i == 0 ? reading.gof(prefix) : reading.slice(prefix)) {
          ++refused;
          continue;
        }
        ++decoded;
        expect_frames_in_range(reading, from.header.position_bits);
        if (HasFailure()) return;
      }
    }
  }
  EXPECT_GT(refused, 20000);
  EXPECT_LT(decoded, refused / 50) << refused;
}

TEST(SkinnedGofParser, ABytePastTheEndFails) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const RandomSkinnedGof from(seed, {});
    SkinnedGofPayloads payloads = payloads_of(from);
    SkinnedReading reading(from);
    ASSERT_FALSE(reading.gof(payloads.first));
    payloads.first.push_back(0);
    ASSERT_TRUE(SkinnedReading(from).gof(payloads.first)) << seed;
    if (payloads.slices.empty()) continue;
    payloads.slices[0].push_back(0);
    ASSERT_TRUE(reading.slice(payloads.slices[0])) << seed;
  }
}

// 8.14.1: slices may be left out as long as each one's coarser layers, and the same layers of
// the group before, stay. Those that stay are read as before.
TEST(SkinnedGofParser, SlicesCanBeLeftOutWhereNothingNeedsThem) {
  int legal = 0;
  int illegal = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {.temporal_layers = false});
    const SkinnedGofPayloads payloads = payloads_of(from);
    std::mt19937 random(seed);
    std::vector<std::uint32_t> kept(from.gof.slice_layers.size(), 0);
    SkinnedReading reading(from);
    ASSERT_FALSE(reading.gof(payloads.first));
    bool is_legal = true;
    std::size_t next = 0;
    for (std::uint32_t group = 0; group < kept.size() && is_legal; ++group) {
      for (std::uint32_t j = 0; j < from.gof.slice_layers[group] && is_legal; ++j) {
        const Payload& payload = payloads.slices[next++];
        if (random() % 4 == 0) continue;
        is_legal = kept[group] == j && (group == 0 || kept[group - 1] > j);
        const auto error = reading.slice(payload);
        ASSERT_EQ(is_legal, !error) << text_of(error);
        if (error) {
          EXPECT_EQ(std::string(error->rule), "R-SLI-02");
        }
        kept[group] = j + 1;
      }
    }
    ++(is_legal ? legal : illegal);
    if (!is_legal) continue;
    const SkinnedGof cut = reading.finish();
    EXPECT_EQ(cut.slice_layers, kept);
    const OrderedMesh mesh = from.coded_mesh();
    for (std::size_t group = 0; group < cut.vertex_residual.size(); ++group) {
      const std::size_t size = cut.vertex_residual[group].size() / mesh.num_vertices();
      ASSERT_EQ(from.gof.vertex_residual[group].size(), cut.vertex_residual[group].size());
      std::uint32_t end = 0;
      for (std::uint32_t j = 0; j < kept[group]; ++j) end += from.gof.layer_group_size[j];
      for (std::uint32_t v = 0; v < mesh.num_vertices(); ++v) {
        const bool is_there = mesh.layer_of(v) < end;
        const bool is_coded = group == 0 && cut.rest.order_flag ? kept[0] > 0 : is_there;
        for (std::size_t k = 0; k < size; ++k) {
          ASSERT_EQ(cut.vertex_residual[group][v * size + k],
                    is_coded ? from.gof.vertex_residual[group][v * size + k] : 0);
        }
        if (group == 0 && is_there) {
          EXPECT_TRUE(std::equal(cut.influences[v].begin(), cut.influences[v].end(),
                                 from.gof.influences[v].begin(), from.gof.influences[v].end()));
        }
      }
    }
    for (std::size_t l = 0; l < cut.trajectories.size(); ++l) {
      EXPECT_TRUE(cut.trajectories[l] == from.gof.trajectories[l]) << l;
    }
  }
  EXPECT_GT(legal, 200);
  EXPECT_GT(illegal, 200);
}

// Returns the residuals of a track in the first temporal layer and in `layers` further ones.
TrackResiduals with_layers(const SkinnedGof& gof, const TrackResiduals& residuals, int between,
                           std::uint32_t layers) {
  TrackResiduals left(residuals.size());
  for (int layer = 0; layer <= static_cast<int>(layers) && !left.empty(); ++layer) {
    for (const TrackPlace& at : places_of_layer(track_frames(gof), between, layer)) {
      left[at.frame] = residuals[at.frame];
    }
  }
  return left;
}

// 8.14.1: slices of temporal layers may be left out as long as the lower layers of each one's
// component group, and the same layer of the group before, stay.
TEST(SkinnedGofParser, TemporalLayersCanBeLeftOutWhereNothingNeedsThem) {
  int legal = 0;
  int illegal = 0;
  for (unsigned seed = 1; seed <= 6000; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {.max_vertices = 12, .max_frames = 20});
    if (from.gof.num_temporal_layers == 1) continue;
    const SkinnedGofPayloads payloads = payloads_of(from);
    std::mt19937 random(seed);
    SkinnedReading reading(from);
    ASSERT_FALSE(reading.gof(payloads.first));
    std::vector<std::uint32_t> kept(from.gof.temporal_layers.size(), 0);
    bool is_legal = true;
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < payloads.slices.size() && is_legal; ++i) {
      const std::uint32_t layer = payloads.temporal_layer_idx[i];
      group = layer > 0 && i > 0 && payloads.temporal_layer_idx[i - 1] == layer ? group + 1 : 0;
      if (layer > 0 && random() % 6 == 0) continue;
      if (layer > 0) {
        is_legal = kept[group] + 1 == layer && (group == 0 || kept[group - 1] >= layer);
        kept[group] = layer;
      }
      const auto error = reading.slice(payloads.slices[i]);
      ASSERT_EQ(is_legal, !error) << text_of(error);
      if (error) {
        EXPECT_EQ(std::string(error->rule), "R-SLI-02");
      }
    }
    ++(is_legal ? legal : illegal);
    if (!is_legal) continue;
    const SkinnedGof cut = reading.finish();
    EXPECT_EQ(cut.temporal_layers, kept);
    for (std::size_t b = 0; b < cut.bones.size(); ++b) {
      const Bone& bone = from.gof.bones[b];
      EXPECT_EQ(cut.bones[b].rotation_residual,
                with_layers(cut, bone.rotation_residual, bone.rotation_between, kept[0]));
      EXPECT_EQ(cut.bones[b].origin_residual,
                with_layers(cut, bone.origin_residual, bone.origin_between, kept[0]));
    }
    for (std::size_t g = 1; g < cut.group_end.size(); ++g) {
      for (std::size_t l = cut.group_end[g - 1]; l < cut.group_end[g]; ++l) {
        const Trajectory& t = from.gof.trajectories[l - kRestFactors];
        EXPECT_EQ(cut.trajectories[l - kRestFactors].residual,
                  with_layers(cut, t.residual, t.temporal_between, kept[g]));
      }
    }
  }
  EXPECT_GT(legal, 100);
  EXPECT_GT(illegal, 100);
}

TEST(SkinnedGofParser, RefusesSlicesInAnotherOrder) {
  int swapped = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const RandomSkinnedGof from(seed, {});
    SkinnedGofPayloads payloads = payloads_of(from);
    for (std::size_t i = 0; i + 1 < payloads.slices.size(); ++i) {
      std::vector<Payload> slices = payloads.slices;
      std::swap(slices[i], slices[i + 1]);
      const auto error = SkinnedReading(from).all(payloads.first, slices);
      ASSERT_TRUE(error) << seed << " " << i;
      EXPECT_EQ(std::string(error->rule), "R-SLI-02");
      ++swapped;
    }
  }
  EXPECT_GT(swapped, 300);
}

// Damaged payloads are refused, or decode to positions in their range.
TEST(SkinnedGofParser, SurvivesDamage) {
  int refused = 0;
  int decoded = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    const RandomSkinnedGof from(seed, {.max_vertices = 30, .max_frames = 4});
    SkinnedGofPayloads payloads = payloads_of(from);
    std::mt19937 random(seed);
    const std::size_t which = random() % (payloads.slices.size() + 1);
    Payload& payload = which == 0 ? payloads.first : payloads.slices[which - 1];
    payload[random() % payload.size()] ^= static_cast<std::uint8_t>(1U << random() % 8);
    SkinnedReading reading(from);
    if (reading.all(payloads.first, payloads.slices)) {
      ++refused;
      continue;
    }
    ++decoded;
    expect_frames_in_range(reading, from.header.position_bits);
    if (HasFailure()) return;
  }
  EXPECT_GT(refused, 100);
  EXPECT_GT(decoded, 10);
}

TEST(SkinnedGofParser, StopsAtTheCallersMemory) {
  const RandomSkinnedGof from(1, {});
  const SkinnedGofPayloads payloads = payloads_of(from);
  const auto error = SkinnedReading(from, 100).gof(payloads.first);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, Errc::kLimitExceeded);
}

}  // namespace
}  // namespace rlpc
