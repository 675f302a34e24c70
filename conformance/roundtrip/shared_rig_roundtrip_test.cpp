// Tests writer and parser of shared rigs, and of GOFs that use them, against each other (6.13);
// and their reconstruction against that of one GOF with the same contents (8.16).
#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/skinned/recon/rig_recon.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/testing/split_skinned_gof.h"
#include "conformance/testing/ample_memory.h"
#include "conformance/testing/error_text.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "encoder/codec/write/write_skinned_gof.h"

namespace rlpc {
namespace {

using Payload = std::vector<std::uint8_t>;

// Parses a rig or a GOF that uses it, as a decoder does.
class RigReading {
 public:
  explicit RigReading(const SplitSkinnedGof& from, const RigSlots& rigs = {})
      : from_(from),
        rigs_(rigs),
        meshes_(from.whole.topology, from.whole.triangles),
        parser_(from.whole.header, meshes_, {kAmpleMemory, 0}) {}

  std::optional<Error> rig(const Payload& payload) {
    BitReader r(payload);
    return error_of(parser_.rig(r, rigs_));
  }
  std::optional<Error> tracks(const Payload& payload) {
    BitReader r(payload);
    const GofHeader header =
        parse_gof_header(r, from_.whole.header, from_.whole.gof.first_frame);
    if (r.error()) return *r.error();
    if (header.kind != GofKind::kSharedRig) return Error{Errc::kInvalid, "", "gof_kind", 0};
    return error_of(parser_.tracks(r, header, rigs_));
  }
  std::optional<Error> slice(const Payload& payload) {
    BitReader r(payload);
    return error_of(parser_.slice(r, 0));
  }
  // Parses a unit and its slices, up to the first error.
  std::optional<Error> all(const SkinnedGofPayloads& payloads, bool is_rig) {
    auto error = is_rig ? rig(payloads.first) : tracks(payloads.first);
    for (std::size_t i = 0; i < payloads.slices.size() && !error; ++i) {
      error = slice(payloads.slices[i]);
    }
    return error;
  }
  const OrderedMeshes& meshes() const { return meshes_; }
  SkinnedGofParser& parser() { return parser_; }

 private:
  static std::optional<Error> error_of(const Result<bool>& result) {
    if (result) return std::nullopt;
    return result.error();
  }

  const SplitSkinnedGof& from_;
  RigSlots rigs_;
  OrderedMeshes meshes_;
  SkinnedGofParser parser_;
};

SkinnedGofPayloads payloads_of_rig(const SplitSkinnedGof& from) {
  return write_shared_rig(*from.rig, from.rig_idx, from.whole.coded_mesh(), from.whole.header);
}
SkinnedGofPayloads payloads_of_tracks(const SplitSkinnedGof& from) {
  return write_tracks(from.tracks, from.whole.coded_mesh(), from.whole.header);
}
RigSlots slots_with(const SplitSkinnedGof& from) {
  RigSlots rigs;
  rigs.slots[from.rig_idx] = from.rig;
  return rigs;
}

void expect_rig_round_trip(const SplitSkinnedGof& from) {
  RigReading rig(from);
  auto error = rig.all(payloads_of_rig(from), true);
  ASSERT_FALSE(error) << text_of(error);
  EXPECT_EQ(rig.parser().rig_idx(), from.rig_idx);
  SharedRig parsed = *rig.parser().finish_rig();
  parsed.influences = complete_influences(rig.meshes()[parsed.prediction], parsed);
  EXPECT_TRUE(*from.rig == parsed);

  RigReading gof(from, slots_with(from));
  error = gof.all(payloads_of_tracks(from), false);
  ASSERT_FALSE(error) << text_of(error);
  const SkinnedGof tracks = gof.parser().finish();
  EXPECT_TRUE(from.tracks == tracks);
}

TEST(SharedRigRoundTrip, RandomLegalRigsAndGofsComeBack) {
  int with_local_groups = 0;
  int still = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    const SplitSkinnedGof from(seed, {});
    expect_rig_round_trip(from);
    if (HasFailure()) return;
    if (from.tracks.group_end.size() > 1) ++with_local_groups;
    for (const Trajectory& t : from.tracks.trajectories) {
      if (!t.trajectory_flag) ++still;
    }
  }
  EXPECT_GT(with_local_groups, 200);
  EXPECT_GT(still, 200);
}

TEST(SharedRigRoundTrip, TheSmallestAndManyGroupsComeBack) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    expect_rig_round_trip(
        SplitSkinnedGof(seed, {.max_vertices = 1, .max_frames = 1, .max_bones = 1}));
  }
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    expect_rig_round_trip(SplitSkinnedGof(
        seed, {.max_vertices = 8, .max_groups = kMaxComponentGroups, .max_components = 2}));
    expect_rig_round_trip(SplitSkinnedGof(seed, {.max_bones = kLevels[0].max_clusters}));
  }
}

// A few prefixes of a payload happen to be payloads themselves.
TEST(SharedRigParser, ProperPrefixesFailOrParse) {
  int refused = 0;
  int parsed = 0;
  for (unsigned seed = 1; seed <= 120; ++seed) {
    SCOPED_TRACE(seed);
    const SplitSkinnedGof from(seed, {.max_vertices = 12,
                                      .max_frames = 3,
                                      .max_bones = 3,
                                      .max_groups = 3,
                                      .max_components = 2});
    for (const bool is_rig : {true, false}) {
      const SkinnedGofPayloads whole =
          is_rig ? payloads_of_rig(from) : payloads_of_tracks(from);
      for (std::size_t i = 0; i <= whole.slices.size(); ++i) {
        SkinnedGofPayloads cut = whole;
        cut.slices.resize(i);
        Payload& last = i == 0 ? cut.first : cut.slices.back();
        const Payload all = last;
        for (std::size_t n = 0; n < all.size(); ++n) {
          last = Payload(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(n));
          ++(RigReading(from, slots_with(from)).all(cut, is_rig) ? refused : parsed);
        }
        last = all;
        last.push_back(0);
        EXPECT_TRUE(RigReading(from, slots_with(from)).all(cut, is_rig));
      }
    }
  }
  EXPECT_GT(refused, 10000);
  EXPECT_LT(parsed, refused / 50);
}

// 7.13.2: tracks stand for the slices of the rig.
TEST(SharedRigParser, RefusesSlicesInAnotherOrderOrTwice) {
  int tried = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    const SplitSkinnedGof from(seed, {});
    const SkinnedGofPayloads good = payloads_of_tracks(from);
    for (std::size_t i = 0; i < good.slices.size(); ++i) {
      SkinnedGofPayloads changed = good;
      changed.slices.insert(changed.slices.begin() + static_cast<std::ptrdiff_t>(i),
                            good.slices[i]);
      EXPECT_EQ(text_of(RigReading(from, slots_with(from)).all(changed, false)),
                "R-SLI-02 slice_unit");
      ++tried;
      if (i == 0) continue;
      changed = good;
      std::swap(changed.slices[i - 1], changed.slices[i]);
      EXPECT_EQ(text_of(RigReading(from, slots_with(from)).all(changed, false)),
                "R-SLI-02 slice_unit");
    }
  }
  EXPECT_GT(tried, 200);
}

TEST(SharedRigParser, RefusesTracksWithoutTheirRig) {
  const SplitSkinnedGof from(1, {});
  const auto error = RigReading(from).tracks(payloads_of_tracks(from).first);
  EXPECT_EQ(text_of(error), "R-MOD-01 rig_idx");
  EXPECT_EQ(error->code, Errc::kUnsupported);
}

std::vector<std::int32_t> frames_of(const SkinnedRecon& recon, std::size_t num_vertices) {
  std::vector<std::int32_t> positions(3 * num_vertices * recon.num_frames());
  recon.frames(0, recon.num_frames(), positions);
  return positions;
}

TEST(SharedRigRecon, GivesTheFramesOfOneGof) {
  int adaptive = 0;
  for (unsigned seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    const SplitSkinnedGof from(seed, {});
    const OrderedMesh mesh = from.whole.coded_mesh();
    const int bits = from.whole.header.position_bits;
    const auto rig = std::make_shared<RigRecon>(mesh, *from.rig, bits, true);
    const SkinnedRecon whole(mesh, from.whole.gof, bits);
    const SkinnedRecon tracks(rig, from.tracks);
    ASSERT_EQ(frames_of(tracks, mesh.num_vertices()), frames_of(whole, mesh.num_vertices()));
    adaptive +=
        from.whole.gof.weights.num_adaptive_factors > 0 && from.tracks.group_end.size() > 1 ? 1
                                                                                            : 0;
  }
  EXPECT_GT(adaptive, 20);  // their weights continue those of the rig
}

// The rig is only read: its GOFs do not depend on each other or on their order.
TEST(SharedRigRecon, ServesSeveralGofs) {
  for (unsigned seed = 1; seed <= 100; ++seed) {
    SCOPED_TRACE(seed);
    const SplitSkinnedGof from(seed, {});
    const OrderedMesh mesh = from.whole.coded_mesh();
    const auto rig =
        std::make_shared<RigRecon>(mesh, *from.rig, from.whole.header.position_bits, true);
    SkinnedGof other = from.tracks;
    for (Trajectory& t : other.trajectories) t.residual.assign(other.num_frames, {3, -2, 1});
    const auto before = frames_of(SkinnedRecon(rig, from.tracks), mesh.num_vertices());
    (void)frames_of(SkinnedRecon(rig, other), mesh.num_vertices());
    EXPECT_EQ(frames_of(SkinnedRecon(rig, from.tracks), mesh.num_vertices()), before);
  }
}

}  // namespace
}  // namespace rlpc
