#include "encoder/codec/write/write_inter_gof.h"

#include <cassert>
#include <utility>

#include "common/codec/bits/bit_writer.h"
#include "encoder/codec/write/write_cluster_map.h"
#include "encoder/codec/write/write_gof_header.h"
#include "encoder/codec/write/write_layers.h"
#include "encoder/codec/write/write_residual.h"
#include "encoder/codec/write/write_rest.h"

namespace rlpc {

namespace {

// 6.14.1 frame_pattern( )
void write_frame_pattern(BitWriter& w, const FramePattern& pattern) {
  w.u(2, pattern.kind);
  if (pattern.kind == FramePattern::kDyadic) {
    w.u(3, static_cast<std::uint32_t>(pattern.period_log2));
  } else if (pattern.kind == FramePattern::kExplicit) {
    w.u(5, pattern.period() - 1);
    for (const PatternEntry& entry : pattern.entries) {
      const bool has_two = entry.reference[0] != entry.reference[1];
      w.u(5, entry.offset - 1);
      w.flag(has_two);
      w.u(6, entry.reference[0]);
      if (has_two) w.u(6, entry.reference[1]);
      w.u(3, entry.depth);
    }
  }
  if (pattern.num_depths() > 1) w.u(3, pattern.temporal_layers - 1);
}

}  // namespace

std::vector<std::uint8_t> write_inter_gof_unit(const GofHeader& gof,
                                               const InterSettings& settings,
                                               const Topology& topology) {
  BitWriter w;
  write_gof_header(w, gof, kProfileHigh);
  write_frame_pattern(w, settings.pattern);
  w.flag(settings.exact_flag);
  for (const std::uint32_t step : settings.step) {
    if (!settings.exact_flag) w.ue(step - 1);
  }
  w.u(4, static_cast<std::uint32_t>(settings.weights.damping_log2));
  w.u(4, static_cast<std::uint32_t>(settings.weights.outer_weight));
  w.u(4, static_cast<std::uint32_t>(settings.weights.outer_scale));
  w.flag(settings.learning_flag);
  if (settings.learning_flag) w.u(4, static_cast<std::uint32_t>(settings.prime_log2));
  w.flag(settings.frame_hash_flag);
  w.ue(settings.max_earlier_distance);
  write_layer_groups(w, settings.layer_group_size);
  if (!settings.exact_flag) write_layer_steps(w, settings.layer_step);
  write_rest_settings(w, settings.rest);
  if (!settings.exact_flag) {
    w.ue(settings.first_step - 1);
    w.flag(settings.step_delta_flag);
  }
  w.ue(settings.num_patches);
  w.byte_alignment();
  std::vector<std::uint8_t> payload = w.take();
  if (settings.num_patches == 0) return payload;
  SectionWriter section;  // 6.14.3 patch_map( )
  ClusterMapModels models;
  write_cluster_map(section, topology, models, settings.num_patches, settings.patch_of_vertex);
  const std::vector<std::uint8_t> map = section.finish();
  payload.insert(payload.end(), map.begin(), map.end());
  return payload;
}

void FrameUnitWriter::start_frame(std::uint32_t place, const FramePlace& frame,
                                  std::int32_t step_delta) {
  place_ = place;
  frame_ = frame;
  step_delta_ = step_delta;
  unit_ = &unit_of(frame, 0);
  if (place > 0) patch_contexts_.start_frame(frame.depth);
  patches_.clear();
  reference_distance_ = 0;
}

// 6.14.3 patch_motions( )
void FrameUnitWriter::write_patches() {
  for (std::size_t p = 0; p < patches_.size(); ++p) {
    patch_contexts_.start(p);
    unit_->section->truncated_unary(patch_contexts_.mode_models(),
                                    static_cast<int>(patches_[p].mode));
    patch_contexts_.set_mode(patches_[p].mode);
    if (patches_[p].mode == PatchMode::kNeighbours) continue;
    for (std::size_t i = 0; i < kMotionValues; ++i) {
      const std::int32_t residual = patches_[p].residual[i];
      unit_->section->residual(patch_contexts_.models(i), patch_contexts_.expected(i),
                               residual);
      patch_contexts_.update(i, residual);
    }
  }
}

void FrameUnitWriter::repeat(const FramePlace& frame, std::uint32_t distance) {
  unit_of(frame, 0).frames.push_back(
      {.frame = frame.frame, .distance = distance, .is_repeated = true});
}

void FrameUnitWriter::start_group(std::uint32_t layer_group) {
  unit_ = &unit_of(frame_, layer_group);
  contexts_.start_group(place_, frame_.depth, layer_group);
  unit_->frames.push_back(
      {.frame = frame_.frame, .distance = reference_distance_, .step_delta = step_delta_});
  if (!unit_->section) unit_->section.emplace();
  if (layer_group == 0) write_patches();
}

// 6.14.2 positions_in_order( )
void FrameUnitWriter::write_positions(const RestOrder& order,
                                      std::span<const std::int32_t> residuals,
                                      std::span<const Counterpart> counterparts) {
  RestWriter writer(order);
  for (const std::uint32_t v : order.order()) {
    const std::int32_t* const residual = &residuals[kRestFactors * std::size_t{v}];
    writer.start(v);
    if (!counterparts.empty()) writer.counterpart(*unit_->section, counterparts[v]);
    writer.finish(*unit_->section, {residual[0], residual[1], residual[2]});
  }
}

void FrameUnitWriter::write(std::int32_t residual) {
  unit_->section->residual(contexts_.models(), contexts_.expected(), residual);
  contexts_.update(residual);
}

void FrameUnitWriter::end_group(std::uint32_t frame_crc) {
  unit_->frames.back().crc = frame_crc;
}

FrameUnitWriter::Unit& FrameUnitWriter::unit_of(const FramePlace& frame,
                                                std::uint32_t layer_group) {
  std::vector<Unit>& units = units_[settings_.pattern.temporal_layer(frame.depth)];
  if (units.size() <= layer_group) units.resize(layer_group + 1);
  return units[layer_group];
}

std::size_t FrameUnitWriter::unit_bytes(std::uint32_t layer) const {
  std::size_t bytes = 0;
  for (const Unit& unit : units_[layer]) bytes += unit.section ? unit.section->size() : 0;
  return bytes;
}

std::vector<std::vector<std::uint8_t>> FrameUnitWriter::finish_units(std::uint32_t layer) {
  assert(unit_frames(layer) > 0);
  std::vector<std::vector<std::uint8_t>> payloads;
  for (Unit& unit : std::exchange(units_[layer], {})) {
    payloads.push_back(
        payload_of(static_cast<std::uint32_t>(payloads.size()), std::move(unit)));
  }
  return payloads;
}

// 6.14.2 frame_unit( )
std::vector<std::uint8_t> FrameUnitWriter::payload_of(std::uint32_t layer_group,
                                                      Unit unit) const {
  const std::size_t num_groups = settings_.layer_group_size.size();
  BitWriter w;
  w.ue(unit.frames.front().frame);
  if (is_open_ended_) w.flag(false);  // gof_end_flag
  w.ue(layer_group);
  w.ue(static_cast<std::uint32_t>(unit.frames.size() - 1));
  for (const UnitFrame& frame : unit.frames) {
    if (layer_group > 0 || frame.frame == 0) continue;
    if (settings_.max_earlier_distance > 0) {
      w.flag(frame.distance > 0);  // earlier_flag
      if (frame.distance > 0) w.ue(frame.distance - 1);
      if (frame.distance > 0) w.flag(frame.is_repeated);
    }
    if (settings_.step_delta_flag && !frame.is_repeated) w.se(frame.step_delta);
  }
  w.byte_alignment();
  for (const UnitFrame& frame : unit.frames) {
    if (!settings_.frame_hash_flag || frame.is_repeated) continue;
    const bool is_whole =
        layer_group + 1 == num_groups || (frame.frame == 0 && settings_.rest.order_flag);
    if (is_whole) w.u(32, frame.crc);
  }
  std::vector<std::uint8_t> payload = w.take();
  if (!unit.section) return payload;
  const std::vector<std::uint8_t> section = unit.section->finish();
  payload.insert(payload.end(), section.begin(), section.end());
  return payload;
}

std::vector<std::uint8_t> write_gof_end(std::uint32_t num_frames) {
  BitWriter w;
  w.ue(num_frames);
  w.flag(true);
  w.byte_alignment();
  return w.take();
}

namespace {

void write_first(FrameUnitWriter& writer, const OrderedMesh& mesh, const InterFrame& frame) {
  std::vector<std::int32_t> residuals(frame.residual.size());
  for (std::size_t i = 0; i < residuals.size(); ++i) residuals[i] = frame.residual[i];
  writer.write_positions(mesh.rest_order(), residuals, frame.counterparts);
}

}  // namespace

InterGofPayloads write_inter_gof(const InterGof& gof, const OrderedMesh& mesh,
                                 std::uint32_t frames_per_unit) {
  InterGofPayloads payloads;
  payloads.first = write_inter_gof_unit(gof, gof, mesh.topology());
  FrameUnitWriter writer(mesh, gof);
  const FrameOrder order(gof.pattern, gof.num_frames);
  // Units end after those of lower temporal layers, which their frames may need.
  const auto finish_units = [&](std::uint32_t highest_layer) {
    for (std::uint32_t t = 0; t <= highest_layer; ++t) {
      if (writer.unit_frames(t) == 0) continue;
      for (std::vector<std::uint8_t>& unit : writer.finish_units(t)) {
        payloads.frames.push_back(std::move(unit));
      }
    }
  };
  // Layer groups of the last frame of each temporal layer that repeats no other.
  std::vector<std::uint32_t> groups_of_layer(gof.pattern.temporal_layers);
  for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
    const InterFrame& frame = (*gof.frames)[order[place].frame];
    if (frame.layer_groups == 0 && !frame.repeated) continue;
    const std::uint32_t layer = gof.pattern.temporal_layer(order[place].depth);
    if (writer.unit_frames(layer) == frames_per_unit) finish_units(layer);
    if (frame.repeated) {
      writer.repeat(order[place], place - order.place_of(*frame.repeated));
      continue;
    }
    if (std::exchange(groups_of_layer[layer], frame.layer_groups) > frame.layer_groups) {
      finish_units(layer);
    }
    writer.start_frame(place, order[place], frame.step_delta);
    if (frame.reference) writer.set_reference(place - order.place_of(*frame.reference));
    writer.set_patches(frame.patches);
    std::uint32_t first = 0;  // first layer of the group
    for (std::uint32_t j = 0; j < frame.layer_groups; ++j) {
      writer.start_group(j);
      if (place == 0 && gof.rest.order_flag) {
        write_first(writer, mesh, frame);
        writer.end_group(frame.frame_crc.value_or(FrameCrc{}).crc);
        break;
      }
      const std::uint32_t end = first + gof.layer_group_size[j];
      for (const std::uint32_t v : mesh.vertices_of_layers(first, end)) {
        if (mode_of(frame.patches, gof.patch_of_vertex, v) == PatchMode::kAlone) continue;
        writer.start(v);
        for (std::size_t c = 0; c < 3; ++c)
          writer.write(frame.residual[3 * std::size_t{v} + c]);
      }
      first = end;
      writer.end_group(frame.frame_crc.value_or(FrameCrc{}).crc);
    }
  }
  finish_units(gof.pattern.temporal_layers - 1);
  return payloads;
}

}  // namespace rlpc
