// Writes units of a skinned GOF element by element, including units that no writer produces,
// for tests of parsers. Residuals are 0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/testing/section_recipe.h"

namespace rlpc {

struct BoneRecipe {
  std::uint32_t bone_parent_plus1 = 0;
  std::array<std::uint32_t, 3> bone_pivot{};
  bool rotation_flag = false;
  bool origin_flag = false;
  std::uint32_t rotation_step_idx = 0;
  std::uint32_t rotation_order_minus1 = 0;
  std::uint32_t origin_step_idx = 0;
  std::uint32_t origin_order = 0;
  std::uint32_t rotation_between = 0;
  std::uint32_t origin_between = 0;
  std::uint32_t stretch_idc = 0;
  std::array<std::uint32_t, 3> stretch_axes{};
  std::uint32_t stretch_step_idx = 0;
  std::uint32_t stretch_order = 0;
  std::uint32_t stretch_between = 0;
};

// Units of a GOF that begins with frame 0 (6.5 and 6.11), of a shared rig (6.13), and of a GOF
// that uses it (6.13.1).
struct SkinnedGofRecipe {
  std::uint32_t num_gof_frames_minus1 = 0;
  std::uint32_t fraction_bits = 0;
  std::uint32_t weight_bits = 0;
  std::uint32_t rest_step_minus1 = 0;
  std::uint32_t num_component_groups = 0;
  std::optional<std::uint32_t> track_levels;  // High profile only
  std::uint32_t num_temporal_layers_minus1 = 0;
  std::uint32_t prediction_idc = 0;
  std::uint32_t damping_log2 = 0;
  std::uint32_t outer_weight = 0;
  std::uint32_t outer_scale = 0;
  // High profile only; set in all its GOFs.
  std::optional<std::uint32_t> num_adaptive_factors;
  bool stretch_flag = false;
  bool rest_order_flag = false;
  std::uint32_t rest_edge_weight = 0;
  std::uint32_t rest_ring_weight = 0;
  bool rest_axes_flag = false;
  bool rest_counterparts_flag = false;
  std::uint32_t num_layer_groups_minus1 = 0;
  std::vector<std::uint32_t> layer_group_layers_minus1;
  std::vector<std::uint32_t> layer_step_minus1;
  std::vector<BoneRecipe> bones{1};
  int position_bits = 12;

  std::vector<std::uint8_t> payload() const {
    BitWriter w;
    w.ue(0);
    w.ue(num_gof_frames_minus1);
    w.u(is_high() ? 2 : 1, 1);  // gof_kind or, in the Main profile, bones_flag
    if (is_high()) levels_of_tracks(w);
    rig_header(w, is_high());
    w.byte_alignment();
    w.append(bone_section(true, true));
    return w.take();
  }
  std::vector<std::uint8_t> rig_payload(std::uint32_t rig_idx) const {
    BitWriter w;
    w.u(3, rig_idx);
    rig_header(w, true);
    w.byte_alignment();
    w.append(bone_section(true, false));
    return w.take();
  }
  std::vector<std::uint8_t> tracks_payload(std::uint32_t gof_kind, std::uint32_t rig_idx,
                                           std::uint32_t num_local_groups) const {
    BitWriter w;
    w.ue(0);
    w.ue(num_gof_frames_minus1);
    w.u(2, gof_kind);
    w.u(3, rig_idx);
    levels_of_tracks(w);
    w.ue(num_local_groups);
    w.byte_alignment();
    w.append(bone_section(false, true));
    return w.take();
  }

  bool is_high() const { return track_levels || num_adaptive_factors; }

 private:
  void levels_of_tracks(BitWriter& w) const {
    w.u(3, track_levels.value_or(0));
    if (track_levels.value_or(0) > 0) w.u(3, num_temporal_layers_minus1);
  }

  void rig_header(BitWriter& w, bool high_profile) const {
    w.ue(static_cast<std::uint32_t>(bones.size()) - 1);
    w.u(5, fraction_bits);
    w.u(3, weight_bits);
    w.ue(rest_step_minus1);
    w.ue(num_component_groups);
    w.u(2, prediction_idc);
    if (prediction_idc == 3) {
      w.u(4, damping_log2);
      w.u(4, outer_weight);
      w.u(4, outer_scale);
      if (high_profile) w.ue(num_adaptive_factors.value_or(0));
      w.ue(num_layer_groups_minus1);
      for (const std::uint32_t layers : layer_group_layers_minus1) w.ue(layers);
      for (const std::uint32_t step : layer_step_minus1) w.u(4, step);
    }
    if (high_profile) w.flag(stretch_flag);
    if (high_profile) w.flag(rest_order_flag);
    if (rest_order_flag) {
      w.u(6, rest_edge_weight);
      w.u(6, rest_ring_weight);
      w.flag(rest_axes_flag);
      w.flag(rest_counterparts_flag);
    }
  }
  std::vector<std::uint8_t> bone_section(bool has_vertices, bool has_tracks) const {
    SectionRecipe r;
    BoneModels models;
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const BoneRecipe& bone = bones[b];
      if (has_vertices) {
        if (b > 0) r.section.bypass(ceil_log2(b + 1), bone.bone_parent_plus1);
        for (const std::uint32_t x : bone.bone_pivot) r.section.bypass(position_bits + 5, x);
        r.section.bin(models.rotation_flag, bone.rotation_flag);
        r.section.bin(models.origin_flag, bone.origin_flag);
        if (stretch_flag) r.truncated_unary(models.stretch_idc, bone.stretch_idc);
        for (const std::uint32_t x : bone.stretch_axes) {
          if (bone.stretch_idc == 2) r.section.bypass(kStretchAxisBits, x);
        }
      }
      if (has_tracks && bone.rotation_flag) {
        r.section.bypass(8, bone.rotation_step_idx);
        r.truncated_unary(models.rotation_order, bone.rotation_order_minus1);
        if (has_levels()) r.truncated_unary(models.rotation_between, bone.rotation_between);
        track(r, models.rotation, bone.rotation_between);
      }
      if (has_tracks && bone.origin_flag) {
        r.section.bypass(8, bone.origin_step_idx);
        r.truncated_unary(models.origin_order, bone.origin_order);
        if (has_levels()) r.truncated_unary(models.origin_between, bone.origin_between);
        track(r, models.origin, bone.origin_between);
      }
      if (has_tracks && bone.stretch_idc > 0) {
        r.section.bypass(8, bone.stretch_step_idx);
        r.truncated_unary(models.stretch_order, bone.stretch_order);
        if (has_levels()) r.truncated_unary(models.stretch_between, bone.stretch_between);
        track(r, models.stretch, bone.stretch_between);
      }
    }
    return r.section.finish();
  }
  bool has_levels() const { return track_levels.value_or(0) > 0; }
  void track(SectionRecipe& r, TrackModels& models, std::uint32_t between) const {
    for (const TrackPlace& at :
         track_order(num_gof_frames_minus1 + 1, static_cast<int>(track_levels.value_or(0)),
                     static_cast<int>(between))) {
      for (int c = 0; c < 3; ++c) r.residual(models[models_of_level(at.level)], 0, 0);
    }
  }
};

// 6.12: writes the first slice of component group 0 or 1, or of a group with tracks only.
class SliceRecipe : public SectionRecipe {
 public:
  SliceRecipe(std::uint32_t component_group_idx, std::uint32_t layer_group_idx)
      : component_group_idx_(component_group_idx), layer_group_idx_(layer_group_idx) {}

  SliceModels models;

  void num_group_components_minus1(std::int32_t value) {
    field(HeaderField::kNumComponents, value);
  }
  void trajectory(std::int32_t scale_idx_delta, std::int32_t spatial_bits_delta,
                  std::int32_t temporal_bits_delta, std::uint32_t temporal_predictor,
                  std::uint32_t temporal_weight, std::uint32_t num_frames) {
    field(HeaderField::kScaleIdx, scale_idx_delta);
    field(HeaderField::kSpatialBits, spatial_bits_delta);
    field(HeaderField::kTemporalBits, temporal_bits_delta);
    truncated_unary(models.temporal_predictor, temporal_predictor);
    for (std::uint32_t k = 4; k < temporal_predictor; ++k) section.bypass(9, temporal_weight);
    for (std::uint32_t i = 0; i < 3 * num_frames; ++i) residual(models.trajectory[0], 0, 0);
  }
  // 6.12.1: spatial header in a shared rig.
  void spatial_header(std::int32_t spatial_bits_delta) {
    field(HeaderField::kSpatialBits, spatial_bits_delta);
  }
  // 6.13.2
  void trajectory_flag(bool value) { section.bin(models.trajectory_flag, value); }
  void track(std::int32_t scale_idx_delta, std::int32_t temporal_bits_delta,
             std::uint32_t num_frames) {
    trajectory_flag(true);
    field(HeaderField::kScaleIdx, scale_idx_delta);
    field(HeaderField::kTemporalBits, temporal_bits_delta);
    truncated_unary(models.temporal_predictor, 0);
    for (std::uint32_t i = 0; i < 3 * num_frames; ++i) residual(models.trajectory[0], 0, 0);
  }
  // Writes extra bones of the first vertex: bones and weights minus 1 in bone_bits and
  // weight_bits.
  void extra_bones(std::span<const std::pair<std::uint32_t, std::uint32_t>> bones,
                   int bone_bits, int weight_bits) {
    for (std::size_t i = 0; i < bones.size(); ++i) {
      section.bin(models.extra_bone_flag[i], true);
      section.bypass(bone_bits, bones[i].first);
      section.bypass(weight_bits, bones[i].second);
    }
  }
  void vertex_residuals(const OrderedMesh& mesh, std::span<const std::uint32_t> vertices,
                        std::size_t num_factors) {
    VertexContexts contexts(mesh, num_factors);
    VertexModels vertex_models;
    for (const std::uint32_t v : vertices) {
      contexts.start(v);
      for (std::size_t l = 0; l < num_factors; ++l) {
        residual(vertex_models[contexts.activity()], contexts.expected(), 0);
        contexts.update(0);
      }
    }
  }

  std::vector<std::uint8_t> payload() {
    BitWriter w;
    w.ue(component_group_idx_);
    w.ue(layer_group_idx_);
    w.byte_alignment();
    w.append(section.finish());
    return w.take();
  }

 private:
  void field(HeaderField which, std::int32_t delta) {
    header_delta(models.header, models.header_mean[static_cast<std::size_t>(which)], delta);
  }

  std::uint32_t component_group_idx_;
  std::uint32_t layer_group_idx_;
};

}  // namespace rlpc
