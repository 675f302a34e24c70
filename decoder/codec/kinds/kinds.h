// The kinds of GOF that the decoder decodes: the interface of each, and the table of all.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <memory>
#include <tuple>
#include <variant>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/syntax/gof_header.h"
#include "decoder/codec/kinds/cluster/cluster_decoder.h"
#include "decoder/codec/kinds/inter/inter_decoder.h"
#include "decoder/codec/kinds/skinned/skinned_decoder.h"

namespace rlpc {

// What the decoder asks of a kind. Functions instead of a base class: a program contains only
// those that it calls, and they get the structure of their kind.
//
//   Gof            its structure, an alternative of AnyGof
//   decodes        whether it decodes GOFs with this gof_kind
//   make_parser    makes the parser of one GOF. The context must outlive it, and have its
//                  connectivity set. Slices outside the cut are treated as absent.
//   make_recon     makes the reconstruction of a GOF, which is read only during the call; the
//                  context must outlive the result. Cannot fail: parsing has checked every
//                  range
//   memory_of_gof  estimates the memory of that reconstruction, without cached frames
//   add_figures    adds the figures and groups of a GOF to its summary, which has its slices
//   add_groups     adds the groups of vertices of a GOF
template <class Kind>
concept KindDecoder = requires(const typename Kind::Gof& gof, const StreamContext& context,
                               const MemoryLimit& memory, const SliceCut& cut, RigRecons& rigs,
                               GofSummary& summary, VertexGroups& groups) {
  { Kind::decodes(GofKind::kCluster) } -> std::same_as<bool>;
  { Kind::make_parser(context, memory, cut) } -> std::same_as<std::unique_ptr<GofParser>>;
  { Kind::make_recon(gof, context, rigs) } -> std::same_as<std::unique_ptr<GofRecon>>;
  { Kind::memory_of_gof(gof, context.header) } -> std::same_as<std::uint64_t>;
  { Kind::add_figures(gof, summary) } -> std::same_as<void>;
  { Kind::add_groups(gof, context, groups) } -> std::same_as<void>;
};

// A new kind of GOF adds its line here.
using KindDecoders = std::tuple<ClusterDecoder,  //
                                SkinnedDecoder,  //
                                InterDecoder>;

// Calls use(decoder) with the decoder of a kind.
template <class Use>
constexpr void with_decoder(GofKind kind, const Use& use) {
  const auto try_one = [&](KindDecoder auto decoder) {
    if (decoder.decodes(kind)) use(decoder);
  };
  std::apply([&](auto... decoders) { (try_one(decoders), ...); }, KindDecoders());
}

// Calls use(decoder, gof) with a GOF and the decoder of its kind.
template <class Use>
void visit_gof(const AnyGof& any, const Use& use) {
  const auto try_one = [&]<KindDecoder Kind>(Kind decoder) {
    if (const auto* const gof = std::get_if<typename Kind::Gof>(&any)) use(decoder, *gof);
  };
  std::apply([&](auto... decoders) { (try_one(decoders), ...); }, KindDecoders());
}

static_assert(std::tuple_size_v<KindDecoders> == std::variant_size_v<AnyGof>);
static_assert(std::all_of(kGofKinds.begin(), kGofKinds.end(), [](const KindProperties& k) {
  int decoders = 0;
  with_decoder(k.kind, [&](auto) { ++decoders; });
  return decoders == 1;
}));

}  // namespace rlpc
