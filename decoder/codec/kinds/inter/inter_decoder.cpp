#include "decoder/codec/kinds/inter/inter_decoder.h"

#include <algorithm>

#include "decoder/codec/kinds/inter/ordered_recon.h"
#include "decoder/codec/kinds/inter/parse/inter_memory.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"
#include "decoder/codec/kinds/inter/vertex_modes.h"

namespace rlpc {

std::unique_ptr<GofParser> InterDecoder::make_parser(const StreamContext& context,
                                                     const MemoryLimit& memory,
                                                     const SliceCut& cut) {
  return std::make_unique<InterGofParser>(context.header,
                                          (*context.meshes)[Prediction::kLayers], memory, cut);
}

std::unique_ptr<GofRecon> InterDecoder::make_recon(const InterGof& gof,
                                                   const StreamContext& context, RigRecons&) {
  return std::make_unique<OrderedRecon>((*context.meshes)[Prediction::kLayers], gof,
                                        context.header.position_bits);
}

std::uint64_t InterDecoder::memory_of_gof(const InterGof& gof, const SequenceHeader& header) {
  std::uint64_t bytes = memory_of_frames(header.num_vertices, gof.num_frames, gof);
  for (const InterFrame& frame : *gof.frames) {
    bytes += memory_of_frame(header.num_vertices, frame.residual.num_large(), gof.num_patches);
  }
  return bytes;
}

void InterDecoder::add_figures(const InterGof& gof, GofSummary& summary) {
  const auto repeated = std::count_if(gof.frames->begin(), gof.frames->end(),
                                      [](const InterFrame& f) { return f.repeated; });
  summary.first_group = "frames";
  summary.layer_group_size = gof.layer_group_size;
  summary.figures = {
      {"frame_pattern_idc", nullptr, nullptr, gof.pattern.kind},
      {"pattern_period", nullptr, nullptr, gof.pattern.period()},
      {"exact_flag", nullptr, nullptr, gof.exact_flag ? 1U : 0U},
      {"learning_flag", nullptr, nullptr, gof.learning_flag ? 1U : 0U},
      {"num_temporal_layers", "temporal layer", "temporal layers", gof.pattern.temporal_layers,
       true},
      {"num_layers", "layer", "layers", count_of(gof.layer_step)},
      {"num_layer_groups", "layer group", "layer groups", count_of(gof.layer_group_size)},
      {"num_frame_units", "frame unit", "frame units", count_of(summary.slices)},
      {"num_repeated_frames", "repeated frame", "repeated frames",
       static_cast<std::uint32_t>(repeated), true},
      {"num_patches", "patch", "patches", gof.num_patches, true}};
  summary.vertex_modes = vertex_modes(gof);
}

void InterDecoder::add_groups(const InterGof& gof, const StreamContext&, VertexGroups& groups) {
  if (gof.num_patches == 0) return;
  groups.kind = GroupKind::kPatches;
  groups.num_groups = gof.num_patches;
  groups.group_of_vertex.assign(gof.patch_of_vertex.begin(), gof.patch_of_vertex.end());
}

}  // namespace rlpc
