// Skinned GOFs, with a rig of their own or a shared one, as a kind of GOF (clauses 6.11, 6.13.1
// and 8.9 to 8.16).
#pragma once

#include <cstdint>
#include <memory>

#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/stream_context.h"
#include "decoder/codec/parse/gof_parser.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/recon/gof_recon.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/slice_cut.h"
#include "decoder/codec/summary/gof_summary.h"
#include "decoder/codec/summary/vertex_groups.h"

namespace rlpc {

// A KindDecoder (decoder/codec/kinds/kinds.h).
struct SkinnedDecoder {
  using Gof = SkinnedGof;
  static constexpr bool decodes(GofKind kind) {
    return kind == GofKind::kSkinned || kind == GofKind::kSharedRig;
  }
  static std::unique_ptr<GofParser> make_parser(const StreamContext& context,
                                                const MemoryLimit& memory, const SliceCut& cut);
  static std::unique_ptr<GofRecon> make_recon(const Gof& gof, const StreamContext& context,
                                              RigRecons& rigs);
  static std::uint64_t memory_of_gof(const Gof& gof, const SequenceHeader& header);
  static void add_figures(const Gof& gof, GofSummary& summary);
  static void add_groups(const Gof& gof, const StreamContext& context, VertexGroups& groups);
};

}  // namespace rlpc
