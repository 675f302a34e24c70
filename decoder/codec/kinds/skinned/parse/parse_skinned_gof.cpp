#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"
#include "decoder/codec/kinds/skinned/parse/bone_parser.h"
#include "decoder/codec/kinds/skinned/parse/parse_slice.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {
namespace {

// 7.11.1 Bone section: without trajectories, R-LVL-05 cannot be broken.
static_assert(std::all_of(kLevels.begin(), kLevels.end(), [](const Level& level) {
  return 6 * std::uint64_t{level.max_clusters} * level.max_gof_frames +
             3 * std::uint64_t{level.max_vertices} <=
         level.max_gof_factors;
}));

}  // namespace

// Checks NumFactors and the memory.
void SkinnedGofParser::count_factors(SectionReader& section, const Factors& factors,
                                     const char* element) {
  num_factors_ += factors.spatial * header_.num_vertices + factors.track_values;
  memory_bytes_ += memory_of_spatial(header_.num_vertices, factors.spatial) +
                   memory_of_tracks(factors.track_values);
  if (section.failed()) return;
  if (num_factors_ > header_.level().max_gof_factors) section.fail("R-LVL-05", element);
  section.check_memory(memory_, memory_bytes_, element);
}

// 6.11.1 bone_section( )
void SkinnedGofParser::bone_section(BitReader& r) {
  SectionReader section(r, "bone_section");
  const bool has_tracks = unit_ == Unit::kGof;
  memory_bytes_ += memory_of_vertices(header_.num_vertices, gof_.rest.order_flag);
  count_factors(section, {kRestFactors, factors_of_bones()}, "bone_section");
  if (section.failed()) return;
  BoneParser parser(section, header_, gof_);
  for (std::uint32_t b = 0; b < gof_.bones.size() && !section.failed(); ++b) {
    gof_.bones[b] = parser.bone(b);
    if (has_tracks) parser.tracks(gof_.bones[b]);
    parser.check_overrun(has_tracks);
  }
  section.finish();
}

// 6.13.1 track_section( )
void SkinnedGofParser::track_section(BitReader& r) {
  SectionReader section(r, "track_section");
  if (gof_.num_local_groups > 0) {
    memory_bytes_ += memory_of_adaptive_weights(header_.num_vertices);
  }
  count_factors(section, {0, factors_of_bones()}, "track_section");
  if (section.failed()) return;
  BoneParser parser(section, header_, gof_);
  for (Bone& bone : gof_.bones) {
    parser.tracks(bone);
    parser.check_overrun();
    if (section.failed()) return;
  }
  section.finish();
}

void SkinnedGofParser::SliceState::start(std::uint32_t num_frames, std::uint32_t first_group) {
  first_own_group = first_group;
  models = {};
  previous = {};
  trajectory_mean.assign(num_frames, 0);
  contexts.reset();
  last_group = 0;
  last_temporal_layer = 0;
}

// Parses the part of a skinned GOF or shared rig that begins with rig_header( ).
Result<bool> SkinnedGofParser::rig(BitReader& r) {
  const std::uint32_t num_layers = meshes_[Prediction::kLayers].num_layers();
  const std::uint32_t num_bones = parse_rig_header(r, header_, num_layers, gof_);
  if (r.error()) return *r.error();
  mesh_ = &meshes_[gof_.prediction];
  if (gof_.prediction != Prediction::kLayers) {
    gof_.layer_group_size = {mesh_->num_layers()};
    gof_.layer_step.assign(mesh_->num_layers(), kMaxLayerStep);
  }
  gof_.bones.resize(num_bones);
  bone_section(r);
  if (r.error()) return *r.error();

  // 8.14.1 StartSlices( )
  state_.start(gof_.num_frames, 1);
  kept_.end_component_group = cut_.max_components == 0 ? 1 : gof_.num_component_groups + 1;
  kept_.end_layer_group = layer_groups_that_stay(gof_.layer_group_size, cut_);
  gof_.slice_layers.assign(std::size_t{gof_.num_component_groups} + 1, 0);
  start_temporal_layers();
  gof_.influences.assign(header_.num_vertices, {});
  gof_.vertex_residual.emplace_back(kRestFactors * std::size_t{header_.num_vertices});
  if (gof_.rest.counterparts_flag) gof_.counterparts.resize(header_.num_vertices);
  return true;
}

// 8.14.1 StartTemporalLayers( )
void SkinnedGofParser::start_temporal_layers() {
  if (gof_.num_temporal_layers > 1) gof_.temporal_layers.assign(gof_.slice_layers.size(), 0);
  kept_.end_temporal_layer = cut_.max_temporal_layers;
}

Result<bool> SkinnedGofParser::gof(BitReader& r, const GofHeader& header,
                                   const RigSlots& rigs) {
  return properties_of(header.kind).has_rig ? tracks(r, header, rigs) : bones(r, header, rigs);
}

// 6.11 bones_of_gof( )
Result<bool> SkinnedGofParser::bones(BitReader& r, const GofHeader& gof_header,
                                     const RigSlots& rigs) {
  gof_ = {};
  static_cast<GofHeader&>(gof_) = gof_header;
  unit_ = Unit::kGof;
  num_factors_ = 0;
  memory_bytes_ = memory_of_rigs(rigs);
  if (header_.profile_idc >= kProfileHigh) parse_levels_of_tracks(r, gof_);
  return rig(r);
}

// 6.13 rig( )
Result<bool> SkinnedGofParser::rig(BitReader& r, const RigSlots& rigs) {
  gof_ = {};
  gof_.num_frames = 0;
  unit_ = Unit::kRig;
  gof_.rig_idx = parse_rig_idx(r);
  num_factors_ = rigs.num_factors(gof_.rig_idx);
  memory_bytes_ = memory_of_rigs(rigs);  // including the rig that it replaces
  return rig(r);
}

// 6.13.1 tracks_of_gof( )
Result<bool> SkinnedGofParser::tracks(BitReader& r, const GofHeader& gof_header,
                                      const RigSlots& rigs) {
  gof_ = {};
  static_cast<GofHeader&>(gof_) = gof_header;
  unit_ = Unit::kTracks;
  const std::uint64_t at = r.bit_pos();
  gof_.rig_idx = parse_rig_idx(r);
  gof_.rig = rigs.slots[gof_.rig_idx];
  if (!gof_.rig) r.fail(Errc::kUnsupported, "R-MOD-01", "rig_idx", at);
  if (r.error()) return *r.error();
  load_rig();
  parse_tracks_header(r, gof_.num_component_groups, gof_);
  r.byte_alignment();
  if (r.error()) return *r.error();
  num_factors_ = rigs.num_factors(kMaxRigs);
  memory_bytes_ = memory_of_rigs(rigs);
  track_section(r);
  if (r.error()) return *r.error();

  // 8.16.2 StartTracks( )
  const std::uint32_t num_groups = gof_.num_component_groups + gof_.num_local_groups;
  state_.start(gof_.num_frames, gof_.num_component_groups + 1);
  gof_.slice_layers.assign(std::size_t{num_groups} + 1, 0);
  gof_.slice_layers[0] = gof_.rig->slice_layers[0];
  start_temporal_layers();
  gof_.vertex_residual.emplace_back();
  // Groups that the cut leaves of the shared rig; of a complete one, local groups follow.
  const bool is_complete = gof_.rig->group_end.size() == gof_.num_component_groups + 1;
  kept_.end_component_group = cut_.max_components == SliceCut::kAll || is_complete
                                  ? num_groups + 1
                                  : static_cast<std::uint32_t>(gof_.rig->group_end.size());
  kept_.end_layer_group = layer_groups_that_stay(gof_.layer_group_size, cut_);
  return true;
}

// 8.16.2 LoadRig( )
void SkinnedGofParser::load_rig() {
  const SharedRig& rig = *gof_.rig;
  gof_.fraction_bits = rig.fraction_bits;
  gof_.weight_bits = rig.weight_bits;
  gof_.prediction = rig.prediction;
  gof_.weights = rig.weights;
  gof_.layer_group_size = rig.layer_group_size;
  gof_.layer_step = rig.layer_step;
  gof_.stretch_flag = rig.stretch_flag;
  gof_.bones = rig.bones;
  gof_.num_component_groups = rig.num_component_groups;
  gof_.group_end = {rig.group_end.back()};
  gof_.is_cut = rig.is_cut;
  mesh_ = &meshes_[gof_.prediction];
}

std::shared_ptr<const SharedRig> SkinnedGofParser::finish_rig() {
  return make_shared_owned<SharedRig>(std::move(static_cast<SharedRig&>(gof_)));
}

// 8.14.1 MayFollow( group, index )
bool SkinnedGofParser::may_follow(const SliceEntry& slice) const {
  const std::uint32_t group = slice.component_group_idx;
  const std::uint32_t layers = slice.layer_group_idx;
  const std::uint32_t temporal = slice.temporal_layer_idx;
  if (temporal < state_.last_temporal_layer) return false;
  if (temporal > 0) {
    return temporal_layers(group) == temporal &&
           (group == 0 || temporal_layers(group - 1) > temporal);
  }
  if (group < state_.last_group || layers != gof_.slice_layers[group]) return false;
  if (has_only_tracks(group) &&
      (group == 0 || layers > 0 || gof_.rig->slice_layers[group] == 0)) {
    return false;
  }
  return group == 0 || gof_.slice_layers[group - 1] > layers;
}

// 8.14.1: TemporalLayers[ group ]
std::uint32_t SkinnedGofParser::temporal_layers(std::uint32_t group) const {
  const bool has_first = group == 0 || gof_.slice_layers[group] > 0;
  return has_first ? 1 + gof_.temporal_layers[group] : 0;
}

SliceCounts SkinnedGofParser::slice_counts() const {
  return {gof_.num_component_groups + gof_.num_local_groups,
          static_cast<std::uint32_t>(gof_.layer_group_size.size()),
          static_cast<std::uint32_t>(gof_.num_temporal_layers)};
}

Result<bool> SkinnedGofParser::slice(BitReader& r, std::uint64_t unit_bit_pos,
                                     Vector<SliceEntry>& slices) {
  if (auto ok = slice(r, unit_bit_pos); !ok) return ok;
  if (last_slice_) slices.push_back(*last_slice_);
  return true;
}

bool SkinnedGofParser::drops(BitReader& r) {
  const SliceEntry slice = parse_slice_header(r, slice_counts());
  if (r.error() || kept_.has(slice)) return false;
  gof_.is_cut = true;
  return true;
}

// 6.12 slice_unit( )
Result<bool> SkinnedGofParser::slice(BitReader& r, std::uint64_t unit_bit_pos) {
  SliceEntry slice = parse_slice_header(r, slice_counts());
  if (r.error()) return *r.error();
  last_slice_.reset();
  if (!kept_.has(slice)) {
    gof_.is_cut = true;
    return true;
  }
  if (!may_follow(slice)) {
    r.fail(Errc::kInvalid, "R-SLI-02", "slice_unit", unit_bit_pos);
  }
  r.byte_alignment();
  if (r.error()) return *r.error();
  const std::size_t trajectories_before = gof_.trajectories.size();
  SliceParser(*this, r, slice).parse();
  if (r.error()) return *r.error();
  // The number of trajectories in a group is known only from its slice.
  if (slice.component_group_idx >= kept_.end_component_group) {
    gof_.is_cut = true;
    return true;
  }
  const std::size_t count = gof_.trajectories.size() - trajectories_before;
  slice.num_trajectories = static_cast<std::uint32_t>(count);
  last_slice_ = slice;
  return true;
}

}  // namespace rlpc
