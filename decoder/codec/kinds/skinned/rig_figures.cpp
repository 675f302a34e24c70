#include "decoder/codec/kinds/skinned/rig_figures.h"

namespace rlpc {

void add_rig_figures(const SharedRig& rig, SlicedSummary& summary) {
  summary.layer_group_size = rig.layer_group_size;
  summary.first_group = "influences, rest positions";
  summary.figures = {
      {"num_bones", "bone", "bones", count_of(rig.bones)},
      {"num_trajectories", "trajectory", "trajectories", count_of(rig.trajectories)},
      {"num_component_groups", "component group", "component groups", rig.num_component_groups},
      {"prediction_idc", nullptr, nullptr, static_cast<std::uint32_t>(rig.prediction)},
      {"num_layers", "layer", "layers", count_of(rig.layer_step)},
      {"num_layer_groups", "layer group", "layer groups", count_of(rig.layer_group_size)},
      {"num_slices", "slice", "slices", count_of(summary.slices)}};
}

}  // namespace rlpc
