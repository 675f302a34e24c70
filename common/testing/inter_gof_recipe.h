// Units of an inter GOF element by element, including ones that no writer produces, for tests
// of parsers.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/kinds/inter/inter_contexts.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/testing/section_recipe.h"

namespace rlpc {

struct PatternEntryRecipe {
  std::uint32_t pattern_offset_minus1 = 0;
  std::vector<std::uint32_t> pattern_reference{0};  // one, or two with two_references_flag
  std::uint32_t pattern_depth = 0;
};

// 6.14.1 frame_pattern( )
struct FramePatternRecipe {
  std::uint32_t frame_pattern_idc = 0;
  std::uint32_t pattern_period_log2 = 1;
  std::vector<PatternEntryRecipe> entries;  // at least 1 with frame_pattern_idc 3
  std::optional<std::uint32_t> temporal_layers_minus1;

  static FramePatternRecipe dyadic(std::uint32_t period_log2, std::uint32_t layers_minus1) {
    return {2, period_log2, {}, layers_minus1};
  }
  static FramePatternRecipe from_entries(
      std::vector<PatternEntryRecipe> list,
      std::optional<std::uint32_t> layers_minus1 = std::nullopt) {
    return {3, 1, std::move(list), layers_minus1};
  }

  void write(BitWriter& w) const {
    w.u(2, frame_pattern_idc);
    if (frame_pattern_idc == 2) w.u(3, pattern_period_log2);
    if (frame_pattern_idc == 3) {
      w.u(5, static_cast<std::uint32_t>(entries.size()) - 1);
      for (const PatternEntryRecipe& entry : entries) {
        w.u(5, entry.pattern_offset_minus1);
        w.flag(entry.pattern_reference.size() == 2);
        for (const std::uint32_t reference : entry.pattern_reference) w.u(6, reference);
        w.u(3, entry.pattern_depth);
      }
    }
    if (temporal_layers_minus1) w.u(3, *temporal_layers_minus1);
  }
};

// GOF unit (6.5, 6.14) of a GOF that begins with frame 0.
struct InterGofRecipe {
  std::uint32_t num_gof_frames_minus1 = 4;
  FramePatternRecipe pattern;
  bool exact_flag = false;
  std::vector<std::uint32_t> frame_step_minus1{15};
  std::uint32_t damping_log2 = 0;
  std::uint32_t outer_weight = 0;
  std::uint32_t outer_scale = 0;
  bool learning_flag = false;
  std::uint32_t prime_log2 = 0;
  bool frame_hash_flag = false;
  std::uint32_t max_earlier_distance = 0;
  std::uint32_t num_layer_groups_minus1 = 0;
  std::vector<std::uint32_t> layer_group_layers_minus1;
  std::vector<std::uint32_t> layer_step_minus1{15, 15, 15};
  bool rest_order_flag = false;
  std::uint32_t rest_edge_weight = 0;
  std::uint32_t rest_ring_weight = 0;
  bool rest_axes_flag = false;
  bool rest_counterparts_flag = false;
  std::uint32_t rest_step_minus1 = 15;
  bool frame_step_delta_flag = false;
  std::uint32_t num_patches = 0;
  std::vector<std::uint8_t> patch_map;  // the section

  std::vector<std::uint8_t> payload() const {
    BitWriter w;
    w.ue(0);
    w.ue(num_gof_frames_minus1);
    w.u(2, 3);  // gof_kind
    pattern.write(w);
    w.flag(exact_flag);
    if (!exact_flag) {
      for (const std::uint32_t step : frame_step_minus1) w.ue(step);
    }
    w.u(4, damping_log2);
    w.u(4, outer_weight);
    w.u(4, outer_scale);
    w.flag(learning_flag);
    if (learning_flag) w.u(4, prime_log2);
    w.flag(frame_hash_flag);
    w.ue(max_earlier_distance);
    w.ue(num_layer_groups_minus1);
    for (const std::uint32_t layers : layer_group_layers_minus1) w.ue(layers);
    if (!exact_flag) {
      for (const std::uint32_t step : layer_step_minus1) w.u(4, step);
    }
    w.flag(rest_order_flag);
    if (rest_order_flag) {
      w.u(6, rest_edge_weight);
      w.u(6, rest_ring_weight);
      w.flag(rest_axes_flag);
      w.flag(rest_counterparts_flag);
    }
    if (!exact_flag) {
      w.ue(rest_step_minus1);
      w.flag(frame_step_delta_flag);
    }
    w.ue(num_patches);
    w.byte_alignment();
    w.append(patch_map);
    return w.take();
  }
};

// 6.14.2 earlier_frame( ); earlier_flag is 0 without a distance.
struct EarlierRecipe {
  std::optional<std::uint32_t> earlier_distance_minus1;
  bool repeat_flag = false;
};

// 6.14.2 frame_unit( )
class FrameRecipe : public SectionRecipe {
 public:
  explicit FrameRecipe(std::uint32_t idx, std::uint32_t group = 0)
      : frame_idx(idx), layer_group_idx(group) {}

  std::uint32_t frame_idx;
  std::optional<bool> gof_end_flag;  // of open-ended streams
  std::uint32_t layer_group_idx;
  std::uint32_t unit_frames_minus1 = 0;
  std::vector<EarlierRecipe> earlier;          // of each frame, where earlier_flag is coded
  std::vector<std::int32_t> frame_step_delta;  // of each frame, in units without earlier flags
  std::vector<std::uint32_t> frame_crc;
  bool has_section = true;

  // Writes residuals of 0 for these vertices.
  void zeros(InterContexts& contexts, std::span<const std::uint32_t> vertices) {
    for (const std::uint32_t v : vertices) {
      contexts.start(v);
      for (int c = 0; c < 3; ++c) {
        residual(contexts.models(), contexts.expected(), 0);
        contexts.update(0);
      }
    }
  }

  std::vector<std::uint8_t> payload() {
    BitWriter w;
    w.ue(frame_idx);
    if (gof_end_flag) w.flag(*gof_end_flag);
    if (!gof_end_flag.value_or(false)) {
      w.ue(layer_group_idx);
      w.ue(unit_frames_minus1);
      for (const EarlierRecipe& frame : earlier) {
        w.flag(frame.earlier_distance_minus1.has_value());
        if (!frame.earlier_distance_minus1) continue;
        w.ue(*frame.earlier_distance_minus1);
        w.flag(frame.repeat_flag);
      }
      for (const std::int32_t delta : frame_step_delta) w.se(delta);
    }
    w.byte_alignment();
    for (const std::uint32_t crc : frame_crc) w.u(32, crc);
    if (has_section && !gof_end_flag.value_or(false)) w.append(section.finish());
    return w.take();
  }
};

}  // namespace rlpc
