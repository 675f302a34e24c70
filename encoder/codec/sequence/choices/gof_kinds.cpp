#include "encoder/codec/sequence/choices/gof_kinds.h"

#include <array>
#include <utility>

#include "encoder/codec/kinds/cluster/cluster_gof_kind.h"
#include "encoder/codec/kinds/inter/frame_gof_kind.h"
#include "encoder/codec/kinds/skinned/skinned_gof_kind.h"

namespace rlpc {
namespace {

// A new kind of GOF adds its factory here.
constexpr std::array<MakeGofKind, 3> kFactories{make_skinned_gof_kind, make_cluster_gof_kind,
                                                make_frame_gof_kind};

}  // namespace

GofKinds make_gof_kinds(const SequenceMesh& mesh, const EncoderSettings& settings) {
  GofKinds kinds;
  for (const MakeGofKind make : kFactories) {
    if (auto kind = make(mesh, settings)) kinds.push_back(std::move(kind));
  }
  return kinds;
}

}  // namespace rlpc
