// Each kind of GOF that settings can name has an encoder, from its lowest profile on.
#include "encoder/codec/sequence/choices/gof_kinds.h"

#include <gtest/gtest.h>

#include "encoder/codec/kind_choices.h"

namespace rlpc {
namespace {

TEST(GofKinds, EachChoiceHasAnEncoderInItsProfiles) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  SequenceHeader header;
  header.num_vertices = 3;
  header.num_triangles = 1;
  const Topology topology = make_topology(3, triangles);
  for (const GofKind kind : kKindChoices) {
    for (const Profile profile : {Profile::kBaseline, Profile::kMain, Profile::kHigh}) {
      header.profile_idc = static_cast<std::uint32_t>(profile);
      EncoderSettings settings;
      settings.profile = profile;
      settings.gof_kind = kind;
      const SequenceMesh mesh{header, topology, triangles};
      const bool is_in_profile = properties_of(kind).profile_idc <= header.profile_idc;
      EXPECT_EQ(make_gof_kinds(mesh, settings).size(), is_in_profile ? 1U : 0U)
          << kind_name(kind) << " " << kProfileNames[header.profile_idc];
    }
  }
}

TEST(GofKinds, SharedRigsAreNoChoice) {
  EXPECT_FALSE(can_be_chosen(GofKind::kSharedRig));
  EXPECT_EQ(kKindChoices.size(), kGofKinds.size() - 1);
}

}  // namespace
}  // namespace rlpc
