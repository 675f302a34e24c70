#include "encoder/codec/sequence/choices/gof_kinds.h"

#include <array>
#include <utility>

#include "encoder/codec/kinds/cluster/cluster_gof_kind.h"
#include "encoder/codec/kinds/inter/inter_gof_kind.h"
#include "encoder/codec/kinds/skinned/skinned_gof_kind.h"

namespace rlpc {
namespace {

// A new kind of GOF adds its factory here. They are compared in this order; the last wins least
// often.
constexpr std::array<MakeKindEncoder, 3> kFactories{make_skinned_gof_kind, make_inter_gof_kind,
                                                    make_cluster_gof_kind};

}  // namespace

KindEncoders make_gof_kinds(const SequenceMesh& mesh, const EncoderSettings& settings) {
  KindEncoders kinds;
  for (const MakeKindEncoder make : kFactories) {
    if (auto kind = make(mesh, settings)) kinds.push_back(std::move(kind));
  }
  return kinds;
}

}  // namespace rlpc
