#include "encoder/codec/write/write_skinned_gof.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <span>
#include <utility>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/skinned/influences.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "encoder/codec/write/bone_writer.h"
#include "encoder/codec/write/section_writer.h"
#include "encoder/codec/write/write_gof_header.h"
#include "encoder/codec/write/write_layers.h"
#include "encoder/codec/write/write_rest.h"

namespace rlpc {
namespace {

enum class Unit : std::uint8_t { kGof, kRig, kTracks };

// 6.11.1 bone_section( ), 6.13.1 track_section( )
std::vector<std::uint8_t> write_bone_section(const SharedRig& rig, Unit unit,
                                             const TrackFrames& frames, int position_bits) {
  SectionWriter section;
  BoneWriter writer(section, frames, rig.stretch_flag);
  for (std::size_t b = 0; b < rig.bones.size(); ++b) {
    if (unit != Unit::kTracks) writer.bone(rig.bones[b], b, position_bits);
    if (unit != Unit::kRig) writer.tracks(rig.bones[b]);
  }
  return section.finish();
}

// 6.12 slice_unit( ): writes the slices of a GOF or shared rig in order.
class SliceWriter {
 public:
  // shared: the shared rig that a skinned GOF uses.
  SliceWriter(const SharedRig& gof, const OrderedMesh& mesh, Unit unit,
              const TrackFrames& frames, const SharedRig* shared = nullptr)
      : gof_(gof),
        mesh_(mesh),
        unit_(unit),
        frames_(frames),
        shared_(shared),
        trajectory_mean_(frames.count, 0) {}

  // first: payload of the unit before the slices. temporal_layers: as in SkinnedGof.
  SkinnedGofPayloads write_all(std::vector<std::uint8_t> first,
                               std::span<const std::uint32_t> temporal_layers = {});

 private:
  std::uint32_t first_own_group() const {
    return unit_ == Unit::kTracks ? gof_.num_component_groups + 1 : 1;
  }
  // Returns the factors of a component group with vertices.
  FactorGroup factors(std::uint32_t group) const {
    return factor_group(gof_, own_group(group));
  }
  std::size_t own_group(std::uint32_t group) const {
    return unit_ == Unit::kTracks ? group - gof_.num_component_groups : group;
  }
  // Returns the trajectories of a component group of the GOF or of its shared rig, from 1 on.
  FactorGroup tracks_of(std::uint32_t group) const {
    return shared_ != nullptr && group < first_own_group() ? factor_group(*shared_, group)
                                                           : factors(group);
  }
  std::vector<std::uint8_t> write(std::uint32_t group, std::uint32_t layers);
  std::vector<std::uint8_t> temporal_slice(std::uint32_t group, int temporal_layer);
  void trajectory_residuals(SectionWriter& section, const Trajectory& trajectory,
                            int temporal_layer);
  void tracks_of_group(SectionWriter& section, std::uint32_t group);
  void group_components(SectionWriter& section, std::uint32_t group);
  void header_value(SectionWriter& section, HeaderField field, int value, int previous) {
    section.header_value(models_.header, models_.header_mean[static_cast<std::size_t>(field)],
                         value, previous);
  }
  void trajectory(SectionWriter& section, const Trajectory& trajectory);
  void influences(SectionWriter& section, std::uint32_t v, InfluencePrediction& prediction);
  void spatial_residuals(SectionWriter& section, std::uint32_t v, std::uint32_t group);
  void rest_residuals(SectionWriter& section);

  const SharedRig& gof_;
  const OrderedMesh& mesh_;
  Unit unit_;
  TrackFrames frames_;
  const SharedRig* shared_;
  SliceModels models_;
  Trajectory previous_;
  std::vector<std::uint32_t> trajectory_mean_;
  std::unique_ptr<VertexModels> vertex_models_;
  std::unique_ptr<VertexModels> models_of_group_;
  std::unique_ptr<VertexContexts> contexts_;
};

// 6.12.1 trajectory( )
void SliceWriter::trajectory(SectionWriter& section, const Trajectory& trajectory) {
  section.truncated_unary(models_.temporal_predictor, trajectory.temporal_predictor);
  for (int k = 0; k < trajectory.temporal_predictor - kMaxPredictorOrder; ++k) {
    const int weight = trajectory.temporal_weight[static_cast<std::size_t>(k)];
    section.bypass(9, static_cast<std::uint32_t>(weight + kTemporalWeightOffset));
  }
  write_between(section, frames_, models_.temporal_between, trajectory.temporal_between);
  trajectory_residuals(section, trajectory, 0);
}

// 6.12.1 trajectory_residuals( layer )
void SliceWriter::trajectory_residuals(SectionWriter& section, const Trajectory& trajectory,
                                       int temporal_layer) {
  section.track(models_.trajectory, trajectory_mean_,
                places_of_layer(frames_, trajectory.temporal_between, temporal_layer),
                trajectory.residual);
}

// 6.12.5 temporal_slice( )
std::vector<std::uint8_t> SliceWriter::temporal_slice(std::uint32_t group, int temporal_layer) {
  BitWriter w;
  w.u(3, static_cast<std::uint32_t>(temporal_layer));
  w.ue(group);
  w.byte_alignment();
  SectionWriter section;
  if (group == 0) {
    // 9.8.1 StartTemporalLayer( )
    models_.trajectory = {};
    std::fill(trajectory_mean_.begin(), trajectory_mean_.end(), 0);
    BoneWriter writer(section, frames_, gof_.stretch_flag);
    for (const Bone& bone : gof_.bones) writer.layer(bone, temporal_layer);
  } else {
    const FactorGroup group_tracks = tracks_of(group);
    for (std::size_t l = group_tracks.first; l < group_tracks.end; ++l) {
      const Trajectory& trajectory = gof_.trajectories[l - kRestFactors];
      if (trajectory.trajectory_flag) trajectory_residuals(section, trajectory, temporal_layer);
    }
  }
  w.append(section.finish());
  return w.take();
}

// 6.12.1 group_components( )
void SliceWriter::group_components(SectionWriter& section, std::uint32_t group) {
  const FactorGroup group_tracks = factors(group);
  header_value(section, HeaderField::kNumComponents, static_cast<int>(group_tracks.size()), 1);
  for (std::size_t l = group_tracks.first; l < group_tracks.end; ++l) {
    const Trajectory& next = gof_.trajectories[l - kRestFactors];
    const bool has_tracks = unit_ != Unit::kRig;
    if (has_tracks) {
      header_value(section, HeaderField::kScaleIdx, next.scale_idx, previous_.scale_idx);
    }
    header_value(section, HeaderField::kSpatialBits, next.spatial_bits, previous_.spatial_bits);
    if (has_tracks) {
      header_value(section, HeaderField::kTemporalBits, next.temporal_bits,
                   previous_.temporal_bits);
      trajectory(section, next);
    }
    previous_.scale_idx = next.scale_idx;
    previous_.spatial_bits = next.spatial_bits;
    previous_.temporal_bits = next.temporal_bits;
  }
}

// 6.13.2 tracks_of_group( )
void SliceWriter::tracks_of_group(SectionWriter& section, std::uint32_t group) {
  const FactorGroup group_tracks = factor_group(*shared_, group);
  for (std::size_t l = group_tracks.first; l < group_tracks.end; ++l) {
    const Trajectory& next = gof_.trajectories[l - kRestFactors];
    section.bin(models_.trajectory_flag, next.trajectory_flag);
    if (!next.trajectory_flag) continue;
    header_value(section, HeaderField::kScaleIdx, next.scale_idx, previous_.scale_idx);
    header_value(section, HeaderField::kTemporalBits, next.temporal_bits,
                 previous_.temporal_bits);
    trajectory(section, next);
    previous_.scale_idx = next.scale_idx;
    previous_.temporal_bits = next.temporal_bits;
  }
}

// 6.12.2 influences( v )
void SliceWriter::influences(SectionWriter& section, std::uint32_t v,
                             InfluencePrediction& prediction) {
  prediction.start(mesh_.ring(v));
  const auto weight_of = [&](std::uint32_t bone) {
    for (const Influence& influence : gof_.influences[v]) {
      if (influence.bone == bone) return int{influence.weight};
    }
    return 0;
  };
  std::vector<Influence> extra;
  for (const Influence& influence : gof_.influences[v]) {
    if (prediction.is_new_bone(influence.bone)) extra.push_back(influence);
  }
  for (const Influence& influence : extra) {
    assert(prediction.can_add_bone());
    section.bin(models_.extra_bone_flag[static_cast<std::size_t>(prediction.num_extra_bones())],
                true);
    section.bypass(ceil_log2(gof_.bones.size()), influence.bone);
    section.bypass(gof_.weight_bits, static_cast<std::uint32_t>(influence.weight - 1));
    prediction.add_extra_bone(influence.bone, influence.weight);
  }
  if (prediction.can_add_bone()) {
    section.bin(models_.extra_bone_flag[static_cast<std::size_t>(prediction.num_extra_bones())],
                false);
  }
  for (std::size_t k = 1; k < prediction.num_candidates(); ++k) {
    std::int32_t residual = 0;
    if (prediction.has_residual()) {
      residual = weight_of(prediction.candidate(k)) - prediction.candidate_mean(k);
      section.residual(models_.weight, prediction.expected(k), residual);
    }
    prediction.add_candidate(k, residual);
  }
}

// 6.12.3 spatial_residuals( v )
void SliceWriter::spatial_residuals(SectionWriter& section, std::uint32_t v,
                                    std::uint32_t group) {
  const std::size_t size = factors(group).size();
  contexts_->start(v);
  for (std::size_t k = 0; k < size; ++k) {
    const std::int32_t residual = gof_.vertex_residual[own_group(group)][v * size + k];
    ResidualModels& models = (*vertex_models_)[contexts_->activity()];
    section.residual(models, contexts_->expected(), residual);
    contexts_->update(residual);
  }
}

// 6.12.4 rest_residuals( v ), of all vertices
void SliceWriter::rest_residuals(SectionWriter& section) {
  RestWriter writer(mesh_.rest_order());
  for (const std::uint32_t v : mesh_.rest_order().order()) {
    const std::int32_t* const residual = &gof_.vertex_residual[0][v * kRestFactors];
    writer.start(v);
    if (gof_.rest.counterparts_flag) writer.counterpart(section, gof_.counterparts[v]);
    writer.finish(section, {residual[0], residual[1], residual[2]});
  }
}

std::vector<std::uint8_t> SliceWriter::write(std::uint32_t group, std::uint32_t layers) {
  BitWriter w;
  if (frames_.temporal_layers > 1) w.u(3, 0);  // temporal_layer_idx
  w.ue(group);
  w.ue(layers);
  w.byte_alignment();
  SectionWriter section;
  if (group < first_own_group() && unit_ == Unit::kTracks) {
    tracks_of_group(section, group);
    w.append(section.finish());
    return w.take();
  }
  if (layers == 0) {
    if (group > 0) group_components(section, group);
    vertex_models_ = group > first_own_group()
                         ? std::make_unique<VertexModels>(*models_of_group_)
                         : std::make_unique<VertexModels>();
    contexts_ = std::make_unique<VertexContexts>(mesh_, factors(group).size());
  }
  InfluencePrediction prediction(gof_.influences, static_cast<std::uint32_t>(gof_.bones.size()),
                                 gof_.weight_bits);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < layers; ++j) first += gof_.layer_group_size[j];
  for (const std::uint32_t v :
       mesh_.vertices_of_layers(first, first + gof_.layer_group_size[layers])) {
    if (group == 0) influences(section, v, prediction);
    if (group > 0 || !gof_.rest.order_flag) spatial_residuals(section, v, group);
  }
  if (gof_.rest.order_flag && group == 0 && layers == 0) rest_residuals(section);
  if (layers == 0) models_of_group_ = std::make_unique<VertexModels>(*vertex_models_);
  w.append(section.finish());
  return w.take();
}

// Writes all slices. In a skinned GOF with a shared rig, slice_layers only says whether groups
// of the shared rig have a slice.
SkinnedGofPayloads SliceWriter::write_all(std::vector<std::uint8_t> first,
                                          std::span<const std::uint32_t> temporal_layers) {
  SkinnedGofPayloads payloads{std::move(first), {}, {}};
  for (std::uint32_t group = 0; group < gof_.slice_layers.size(); ++group) {
    const bool has_only_tracks = unit_ == Unit::kTracks && group < first_own_group();
    if (has_only_tracks && group == 0) continue;
    const std::uint32_t max = has_only_tracks ? 1 : gof_.slice_layers[group];
    for (std::uint32_t layers = 0; layers < std::min(max, gof_.slice_layers[group]); ++layers) {
      payloads.slices.push_back(write(group, layers));
    }
  }
  payloads.temporal_layer_idx.resize(payloads.slices.size());
  for (int layer = 1; layer < frames_.temporal_layers; ++layer) {
    for (std::uint32_t group = 0; group < temporal_layers.size(); ++group) {
      if (static_cast<int>(temporal_layers[group]) < layer) break;
      payloads.slices.push_back(temporal_slice(group, layer));
      payloads.temporal_layer_idx.push_back(static_cast<std::uint32_t>(layer));
    }
  }
  return payloads;
}

// 6.11 levels_of_tracks( )
void write_levels_of_tracks(BitWriter& w, const TrackFrames& frames) {
  w.u(3, static_cast<std::uint32_t>(frames.levels));
  if (frames.levels > 0) w.u(3, static_cast<std::uint32_t>(frames.temporal_layers - 1));
}

// 6.11 rig_header( )
void write_rig_header(BitWriter& w, const SharedRig& rig, std::uint32_t profile_idc) {
  w.ue(static_cast<std::uint32_t>(rig.bones.size()) - 1);
  w.u(5, static_cast<std::uint32_t>(rig.fraction_bits));
  w.u(3, static_cast<std::uint32_t>(rig.weight_bits));
  w.ue(rig.rest_step - 1);
  w.ue(rig.num_component_groups);
  w.u(2, static_cast<std::uint32_t>(rig.prediction));
  if (rig.prediction == Prediction::kLayers) {
    w.u(4, static_cast<std::uint32_t>(rig.weights.damping_log2));
    w.u(4, static_cast<std::uint32_t>(rig.weights.outer_weight));
    w.u(4, static_cast<std::uint32_t>(rig.weights.outer_scale));
    if (profile_idc >= kProfileHigh) w.ue(rig.weights.num_adaptive_factors);
    write_layer_groups(w, rig.layer_group_size);
    write_layer_steps(w, rig.layer_step);
  }
  if (profile_idc >= kProfileHigh) {
    w.flag(rig.stretch_flag);
    write_rest_settings(w, rig.rest);
  }
}

}  // namespace

SkinnedGofPayloads write_skinned_gof(const SkinnedGof& gof, const OrderedMesh& mesh,
                                     const SequenceHeader& header) {
  BitWriter w;
  const TrackFrames frames = track_frames(gof);
  write_gof_header(w, gof, header.profile_idc);
  if (header.profile_idc >= kProfileHigh) write_levels_of_tracks(w, frames);
  write_rig_header(w, gof, header.profile_idc);
  w.byte_alignment();
  w.append(write_bone_section(gof, Unit::kGof, frames, header.position_bits));
  return SliceWriter(gof, mesh, Unit::kGof, frames).write_all(w.take(), gof.temporal_layers);
}

SkinnedGofPayloads write_shared_rig(const SharedRig& rig, std::uint32_t rig_idx,
                                    const OrderedMesh& mesh, const SequenceHeader& header) {
  BitWriter w;
  w.u(3, rig_idx);
  write_rig_header(w, rig, header.profile_idc);
  w.byte_alignment();
  w.append(write_bone_section(rig, Unit::kRig, {}, header.position_bits));
  return SliceWriter(rig, mesh, Unit::kRig, {}).write_all(w.take());
}

SkinnedGofPayloads write_tracks(const SkinnedGof& gof, const OrderedMesh& mesh,
                                const SequenceHeader& header) {
  BitWriter w;
  const TrackFrames frames = track_frames(gof);
  write_gof_header(w, gof, header.profile_idc);
  w.u(3, gof.rig_idx);
  write_levels_of_tracks(w, frames);
  w.ue(gof.num_local_groups);
  w.byte_alignment();
  w.append(write_bone_section(gof, Unit::kTracks, frames, header.position_bits));
  return SliceWriter(gof, mesh, Unit::kTracks, frames, gof.rig.get())
      .write_all(w.take(), gof.temporal_layers);
}

}  // namespace rlpc
