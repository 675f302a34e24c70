#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"

#include <algorithm>
#include <array>
#include <memory>
#include <span>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/kinds/inter/parse/inter_memory.h"
#include "decoder/codec/kinds/inter/parse/parse_frame_pattern.h"
#include "decoder/codec/parse/parse_cluster_map.h"
#include "decoder/codec/parse/parse_rest_residuals.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

bool InterGofParser::has_memory(BitReader& r, std::uint64_t more, const char* structure,
                                std::uint64_t at) {
  const std::uint64_t needed_bytes = memory_.bytes_in_use + memory_bytes_ + more;
  if (needed_bytes <= memory_.max_bytes) return true;
  r.fail(Errc::kLimitExceeded, "", structure, at, needed_bytes);
  return false;
}

// 6.14 frames_of_gof( )
Result<bool> InterGofParser::gof(BitReader& r, const GofHeader& gof_header) {
  const std::uint64_t at = r.bit_pos();
  static_cast<GofHeader&>(gof_) = gof_header;
  parse_inter_settings(r, header_, mesh_.num_layers(), gof_);
  if (r.error()) return *r.error();
  memory_bytes_ = memory_of_frames(header_.num_vertices, gof_.num_frames, gof_);
  if (!has_memory(r, 0, "frames_of_gof", at)) return *r.error();
  if (gof_.num_patches > 0) patch_map(r);
  if (r.error()) return *r.error();
  frames_.resize(gof_.num_frames);
  contexts_.emplace(mesh_, gof_.layer_group_size.size(), gof_.pattern.num_depths());
  order_.emplace(gof_.pattern, gof_.num_frames);
  first_lacking_.assign(gof_.pattern.temporal_layers,
                        Vector<std::uint32_t>(gof_.layer_group_size.size()));
  end_layer_group_ = layer_groups_that_stay(gof_.layer_group_size, cut_);
  end_temporal_layer_ = std::min(cut_.max_temporal_layers, gof_.pattern.temporal_layers);
  return true;
}

Result<bool> InterGofParser::gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) {
  rig_bytes_ = memory_of_rigs(rigs);
  memory_.bytes_in_use += rig_bytes_;
  return gof(r, header);
}

// 6.14.3 patch_map( )
void InterGofParser::patch_map(BitReader& r) {
  SectionReader section(r, "patch_map");
  ClusterMapModels models;
  gof_.patch_of_vertex.assign(header_.num_vertices, 0);
  parse_cluster_map(section, mesh_.topology(), models, gof_.num_patches, gof_.patch_of_vertex);
  section.finish();
  patch_contexts_.emplace(gof_.num_patches, gof_.pattern.num_depths());
}

// 6.14.2 frame_unit( )
Result<bool> InterGofParser::frame(BitReader& r, std::uint64_t unit_bit_pos) {
  last_unit_.reset();
  const auto num_groups = static_cast<std::uint32_t>(gof_.layer_group_size.size());
  const FrameUnitStart start =
      parse_frame_unit_header(r, header_, {gof_.num_frames, num_groups});
  if (r.error()) return *r.error();
  SliceEntry unit;
  unit.frame_idx = start.frame_idx;
  if (start.gof_end_flag) {
    end_gof(r, start.frame_idx, unit_bit_pos);
    unit.is_gof_end = true;
    last_unit_ = unit;
  } else {
    frames_of_group(r, start, unit, unit_bit_pos);
  }
  if (r.error()) return *r.error();
  return true;
}

Result<bool> InterGofParser::slice(BitReader& r, std::uint64_t unit_bit_pos,
                                   Vector<SliceEntry>& slices) {
  if (auto ok = frame(r, unit_bit_pos); !ok) return ok;
  if (last_unit_) slices.push_back(*last_unit_);
  return true;
}

// 6.14.2 gof_end( )
void InterGofParser::end_gof(BitReader& r, std::uint32_t num_frames,
                             std::uint64_t unit_bit_pos) {
  if (num_frames > 0) {
    FrameOrder order(gof_.pattern, num_frames);
    if (order.begins_as(*order_, next_place_)) {
      r.byte_alignment();
      r.expect_end();
      if (r.error()) return;
      gof_.num_frames = num_frames;
      order_ = std::move(order);
      frames_.resize(num_frames);
      for (Vector<std::uint32_t>& places : first_lacking_)
        std::fill(places.begin(), places.end(), 0U);
      return;
    }
  }
  r.fail(Errc::kInvalid, "R-FRM-04", "frame_unit", unit_bit_pos);
}

// 8.19.1 FindUnitFrames( more )
Vector<std::uint32_t> InterGofParser::unit_places(const SliceEntry& unit) const {
  Vector<std::uint32_t> places;
  for (std::uint32_t place = order_->place_of(unit.frame_idx);
       place < order_->num_frames() && places.size() < unit.num_frames; ++place) {
    const FramePlace& at = (*order_)[place];
    if (gof_.pattern.temporal_layer(at.depth) == unit.temporal_layer_idx) {
      const bool is_left_out =
          unit.layer_group_idx > 0 && !places.empty() && is_whole(frames_[at.frame]);
      if (!is_left_out) places.push_back(place);
    } else if (header_.open_end_flag) {
      break;
    }
  }
  return places;
}

std::uint32_t InterGofParser::first_lacking(std::uint32_t layer, std::uint32_t group) {
  std::uint32_t& place = first_lacking_[layer][group];
  while (place < order_->num_frames() &&
         (gof_.pattern.temporal_layer((*order_)[place].depth) != layer ||
          frame_at(place).layer_groups > group || is_whole(frame_at(place)))) {
    ++place;
  }
  return place;
}

bool InterGofParser::continues(const SliceEntry& unit,
                               std::span<const std::uint32_t> places) const {
  if (unit.layer_group_idx == 0) return places.front() >= next_place_;
  return std::equal(places.begin(), places.end(), to_come_.begin(), to_come_.end());
}

// 8.19.1 FrameMayFollow( )
bool InterGofParser::may_follow(const SliceEntry& unit, std::span<const std::uint32_t> places) {
  const std::uint32_t first = places.front();
  const std::uint32_t last = places.back();
  const std::uint32_t group = unit.layer_group_idx;
  const std::uint32_t layer = unit.temporal_layer_idx;
  for (const std::uint32_t place : places) {
    const InterFrame& frame = frame_at(place);
    if (frame.layer_groups != group || is_whole(frame)) return false;
  }
  if (header_.open_end_flag && !continues(unit, places)) return false;
  if (first_lacking(layer, group) < first) return false;
  for (std::uint32_t t = 0; t < layer; ++t) {
    if (first_lacking(t, group) < last) return false;
  }
  unit_place_ = first;
  next_place_ = std::max(next_place_, last + 1);
  return true;
}

// 6.14.2 frames_of_group( )
void InterGofParser::frames_of_group(BitReader& r, const FrameUnitStart& start,
                                     SliceEntry& unit, std::uint64_t unit_bit_pos) {
  const std::uint32_t group = start.layer_group_idx;
  unit.layer_group_idx = group;
  unit.num_frames = static_cast<std::uint32_t>(start.unit_frames_minus1.value) + 1;
  const std::uint32_t first = order_->place_of(unit.frame_idx);
  unit.temporal_layer_idx = gof_.pattern.temporal_layer((*order_)[first].depth);
  const Vector<std::uint32_t> places = unit_places(unit);
  if (!r.require(start.unit_frames_minus1, places.size() == unit.num_frames, "R-FRM-09")) {
    return;
  }
  if (group >= end_layer_group_ || unit.temporal_layer_idx >= end_temporal_layer_) {
    is_cut_ = true;
    return;
  }
  if (!may_follow(unit, places)) {
    r.fail(Errc::kInvalid, "R-FRM-03", "frame_unit", unit_bit_pos);
    return;
  }
  Vector<std::uint32_t> coded;
  for (const std::uint32_t place : places) {
    if (frame_start(r, unit, place)) coded.push_back(place);
    if (r.error()) return;
  }
  r.byte_alignment();
  to_come_.clear();
  for (const std::uint32_t place : coded) {
    InterFrame& frame = frame_at(place);
    if (!is_whole(frame)) {
      to_come_.push_back(place);
    } else if (gof_.frame_hash_flag) {
      const std::uint64_t at = r.bit_pos();
      frame.frame_crc = FrameCrc{r.u(32, "frame_crc"), at};
      if (r.error()) return;
    }
  }
  if (coded.empty()) {
    r.expect_end();
  } else if (!r.error()) {
    frame_section(r, unit, coded);
  }
  if (!r.error()) last_unit_ = unit;
}

// 6.14.2 frame_start( )
bool InterGofParser::frame_start(BitReader& r, const SliceEntry& unit, std::uint32_t place) {
  InterFrame& frame = frame_at(place);
  const bool may_be_earlier =
      gof_.max_earlier_distance > 0 && unit.layer_group_idx == 0 && place > 0;
  if (may_be_earlier && r.flag("earlier_flag")) earlier_frame(r, place);
  if (r.error()) return false;
  if (frame.repeated) return false;
  if (gof_.step_delta_flag && unit.layer_group_idx == 0 && place > 0) {
    frame.step_delta = r.se("frame_step_delta", {kMinStepDelta, kMaxStepDelta}, "R-FRM-10");
  }
  const bool has_all = place == 0 && gof_.rest.order_flag;
  frame.layer_groups = has_all ? static_cast<std::uint32_t>(gof_.layer_group_size.size())
                               : unit.layer_group_idx + 1;
  return true;
}

// 6.14.2 earlier_frame( )
void InterGofParser::earlier_frame(BitReader& r, std::uint32_t place) {
  const std::uint64_t at = r.bit_pos();
  const std::uint32_t distance =
      r.ue("earlier_distance_minus1", {0, std::int64_t{gof_.max_earlier_distance} - 1},
           "R-FRM-08") +
      1;
  if (r.error()) return;
  const FramePattern& pattern = gof_.pattern;
  const FramePlace* const earlier = distance > place ? nullptr : &(*order_)[place - distance];
  if (earlier == nullptr ||
      pattern.temporal_layer(earlier->depth) > pattern.temporal_layer((*order_)[place].depth)) {
    r.fail(Errc::kInvalid, "R-FRM-08", "earlier_distance_minus1", at);
  }
  const bool is_repeated = r.flag("repeat_flag");
  if (r.error()) return;
  InterFrame& frame = frame_at(place);
  (is_repeated ? frame.repeated : frame.reference) = earlier->frame;
}

std::uint32_t InterGofParser::complete_places() const {
  std::uint32_t place = unit_place_;
  while (place < next_place_ && is_whole(frames_[(*order_)[place].frame])) ++place;
  return place;
}

InterFrame InterGofParser::take_frame(std::uint32_t frame) {
  InterFrame& kept = frames_[frame];
  if (kept.repeated) kept.layer_groups = frames_[*kept.repeated].layer_groups;
  if (kept.layer_groups > 0 && !kept.repeated) {
    memory_bytes_ -=
        memory_of_frame(header_.num_vertices, kept.residual.num_large(), kept.patches.size());
  }
  InterFrame taken = std::exchange(kept, {});
  kept.layer_groups = taken.layer_groups;
  kept.repeated = taken.repeated;
  return taken;
}

namespace {

// Context of one vertex, for SectionReader::residuals().
struct OfVertex {
  InterContexts& contexts;
  std::uint32_t expected() const { return contexts.expected(); }
  ResidualModels& models() const { return contexts.models(); }
  void update(std::int32_t residual) const { contexts.update(residual); }
};
// Context of the motion of one patch.
struct OfPatch {
  PatchContexts& contexts;
  std::size_t value = 0;
  std::uint32_t expected() const { return contexts.expected(value); }
  ResidualModels& models() const { return contexts.models(value); }
  void update(std::int32_t residual) { contexts.update(value++, residual); }
};

}  // namespace

// 6.14.3 patch_motions( )
void InterGofParser::patch_motions(SectionReader& section, InterFrame& frame) {
  frame.patches.resize(gof_.num_patches);
  for (std::size_t p = 0; p < frame.patches.size() && !section.failed(); ++p) {
    PatchMotion& patch = frame.patches[p];
    patch_contexts_->start(p);
    patch.mode = static_cast<PatchMode>(
        section.truncated_unary(patch_contexts_->mode_models(), "patch_mode"));
    patch_contexts_->set_mode(patch.mode);
    if (patch.mode != PatchMode::kNeighbours) {
      section.residuals(OfPatch{*patch_contexts_}, patch.residual, "patch_residual");
    }
    section.check_overrun("patch_mode");
  }
}

// 6.14.2 frame_section( )
void InterGofParser::frame_section(BitReader& r, const SliceEntry& unit,
                                   std::span<const std::uint32_t> places) {
  const std::uint64_t num_vertices = header_.num_vertices;
  const std::uint64_t at = r.bit_pos();
  SectionReader section(r, "frame_section");
  for (const std::uint32_t place : places) {
    InterFrame& frame = frame_at(place);
    const std::uint32_t num_patches = place > 0 ? gof_.num_patches : 0;
    if (unit.layer_group_idx == 0) {
      const std::uint64_t max_bytes =
          memory_of_frame(num_vertices, 3 * num_vertices, num_patches);
      if (!has_memory(r, max_bytes + r.remaining_bytes().size(), "frame_section", at)) return;
      frame.residual = CompactResiduals(3 * std::size_t{header_.num_vertices});
      frame.expected.assign(header_.num_vertices, 0);
      if (num_patches > 0) {
        patch_contexts_->start_frame((*order_)[place].depth);
        patch_motions(section, frame);
      }
      memory_bytes_ += memory_of_frame(num_vertices, 0, num_patches);
    }
    const std::uint64_t large_before = frame.residual.num_large();
    if (place == 0 && gof_.rest.order_flag) {
      positions_in_order(section, frame);
    } else {
      frame_residuals(section, unit, place);
    }
    if (section.failed()) return;
    frame.residual.sort();
    memory_bytes_ += memory_of_frame(0, frame.residual.num_large() - large_before, 0);
  }
  section.finish();
}

// 6.14.2 positions_in_order( )
void InterGofParser::positions_in_order(SectionReader& section, InterFrame& frame) {
  Vector<std::int32_t> residuals(frame.residual.size());
  if (gof_.rest.counterparts_flag) frame.counterparts.resize(header_.num_vertices);
  parse_rest_residuals(section, mesh_.rest_order(), residuals, frame.counterparts);
  for (std::size_t i = 0; i < residuals.size(); ++i) {
    if (residuals[i] != 0) frame.residual.set(i, residuals[i]);
  }
}

// 6.14.2 residuals_of_frame( )
void InterGofParser::frame_residuals(SectionReader& section, const SliceEntry& unit,
                                     std::uint32_t place) {
  InterFrame& frame = frame_at(place);
  contexts_->start_group(place, (*order_)[place].depth, unit.layer_group_idx);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < unit.layer_group_idx; ++j) first += gof_.layer_group_size[j];
  const std::uint32_t end = first + gof_.layer_group_size[unit.layer_group_idx];
  for (const std::uint32_t v : mesh_.vertices_of_layers(first, end)) {
    if (section.failed()) return;
    if (mode_of(frame.patches, gof_.patch_of_vertex, v) == PatchMode::kAlone) continue;
    contexts_->start(v);
    frame.expected[v] = contexts_->frame_expected();
    std::array<std::int32_t, 3> residuals{};
    section.residuals(OfVertex{*contexts_}, residuals, "frame_residual");
    for (std::size_t c = 0; c < 3; ++c) {
      if (residuals[c] != 0) frame.residual.set(3 * std::size_t{v} + c, residuals[c]);
    }
    section.check_overrun("frame_residual");
  }
}

// A frame that repeats another has the layer groups that the other has in the end.
InterGof InterGofParser::finish() {
  for (std::uint32_t place = 0; place < order_->num_frames(); ++place) {
    InterFrame& frame = frame_at(place);
    if (frame.repeated) frame.layer_groups = frames_[*frame.repeated].layer_groups;
  }
  gof_.frames = make_shared_owned<const Vector<InterFrame>>(std::move(frames_));
  return std::move(gof_);
}

}  // namespace rlpc
