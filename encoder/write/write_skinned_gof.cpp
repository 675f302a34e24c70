#include "encoder/write/write_skinned_gof.h"

#include <algorithm>
#include <cassert>
#include <memory>
#include <utility>

#include "common/bitstream/bit_writer.h"
#include "common/int_math.h"
#include "common/skinned_gof/influences.h"
#include "common/skinned_gof/slice_models.h"
#include "encoder/write/section_writer.h"
#include "encoder/write/write_gof_header.h"

namespace rlpc {
namespace {

void write_between(SectionWriter& section, const SkinnedGof& gof,
                   std::array<BitModel, kMaxBetween>& models, int between) {
  if (gof.track_levels > 0) section.truncated_unary(models, between);
}

std::vector<TrackPlace> order_of(const SkinnedGof& gof, int between) {
  return track_order(gof.num_frames, gof.track_levels, between);
}

// 6.11.1 bone_section( )
std::vector<std::uint8_t> write_bone_section(const SkinnedGof& gof, int position_bits) {
  SectionWriter section;
  BoneModels models;
  std::vector<std::uint32_t> rotation_mean(gof.num_frames, 0);
  std::vector<std::uint32_t> origin_mean(gof.num_frames, 0);
  for (std::size_t b = 0; b < gof.bones.size(); ++b) {
    const Bone& bone = gof.bones[b];
    assert(bone.parent < static_cast<std::int32_t>(b));
    if (b > 0) section.bypass(ceil_log2(b + 1), static_cast<std::uint32_t>(bone.parent + 1));
    for (const std::int32_t x : bone.pivot) {
      section.bypass(rest_bits(position_bits),
                     static_cast<std::uint32_t>(x + (1 << (rest_bits(position_bits) - 1))));
    }
    section.bin(models.rotation_flag, bone.rotation_flag);
    section.bin(models.origin_flag, bone.origin_flag);
    if (bone.rotation_flag) {
      section.bypass(8, bone.rotation_step_idx);
      section.truncated_unary(models.rotation_order, bone.rotation_order - 1);
      write_between(section, gof, models.rotation_between, bone.rotation_between);
      section.track(models.rotation, rotation_mean, order_of(gof, bone.rotation_between),
                    bone.rotation_residual);
    }
    if (bone.origin_flag) {
      section.bypass(8, bone.origin_step_idx);
      section.truncated_unary(models.origin_order, bone.origin_order);
      write_between(section, gof, models.origin_between, bone.origin_between);
      section.track(models.origin, origin_mean, order_of(gof, bone.origin_between),
                    bone.origin_residual);
    }
  }
  return section.finish();
}

// 6.12 slice_unit( ): writes the slices of a GOF in order.
class SliceWriter {
 public:
  SliceWriter(const SkinnedGof& gof, const CodedMesh& mesh)
      : gof_(gof), mesh_(mesh), trajectory_mean_(gof.num_frames, 0) {}

  std::vector<std::uint8_t> write(std::uint32_t group, std::uint32_t layers);

 private:
  void header_value(SectionWriter& section, HeaderField field, int value, int previous) {
    section.header_value(models_.header, models_.header_mean[static_cast<std::size_t>(field)],
                         value, previous);
  }
  void trajectory(SectionWriter& section, const Trajectory& trajectory);
  void influences(SectionWriter& section, std::uint32_t v, InfluencePrediction& prediction);
  void spatial_residuals(SectionWriter& section, std::uint32_t v, std::uint32_t group);

  const SkinnedGof& gof_;
  const CodedMesh& mesh_;
  SliceModels models_;
  Trajectory previous_;
  std::vector<std::uint32_t> trajectory_mean_;
  std::unique_ptr<VertexModels> vertex_models_;
  std::unique_ptr<VertexModels> models_of_group_;
  std::unique_ptr<VertexContexts> contexts_;
};

// 6.12.1 trajectory( )
void SliceWriter::trajectory(SectionWriter& section, const Trajectory& trajectory) {
  header_value(section, HeaderField::kScaleIdx, trajectory.scale_idx, previous_.scale_idx);
  header_value(section, HeaderField::kSpatialBits, trajectory.spatial_bits,
               previous_.spatial_bits);
  header_value(section, HeaderField::kTemporalBits, trajectory.temporal_bits,
               previous_.temporal_bits);
  previous_.scale_idx = trajectory.scale_idx;
  previous_.spatial_bits = trajectory.spatial_bits;
  previous_.temporal_bits = trajectory.temporal_bits;
  section.truncated_unary(models_.temporal_predictor, trajectory.temporal_predictor);
  for (int k = 0; k < trajectory.temporal_predictor - kMaxPredictorOrder; ++k) {
    const int weight = trajectory.temporal_weight[static_cast<std::size_t>(k)];
    section.bypass(9, static_cast<std::uint32_t>(weight + kTemporalWeightOffset));
  }
  write_between(section, gof_, models_.temporal_between, trajectory.temporal_between);
  section.track(models_.trajectory, trajectory_mean_,
                order_of(gof_, trajectory.temporal_between), trajectory.residual);
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
  const std::size_t size = factor_group(gof_, group).size();
  contexts_->start(v);
  for (std::size_t k = 0; k < size; ++k) {
    const std::int32_t residual = gof_.vertex_residual[group][v * size + k];
    ResidualModels& models = (*vertex_models_)[contexts_->activity()];
    section.residual(models, contexts_->expected(), residual);
    contexts_->update(residual);
  }
}

std::vector<std::uint8_t> SliceWriter::write(std::uint32_t group, std::uint32_t layers) {
  BitWriter w;
  w.ue(group);
  w.ue(layers);
  w.byte_alignment();
  SectionWriter section;
  const FactorGroup factors = factor_group(gof_, group);
  if (layers == 0) {
    if (group > 0) {
      header_value(section, HeaderField::kNumComponents, static_cast<int>(factors.size()), 1);
      for (std::size_t l = factors.first; l < factors.end; ++l) {
        trajectory(section, gof_.trajectories[l - kRestFactors]);
      }
    }
    vertex_models_ = group > 1 ? std::make_unique<VertexModels>(*models_of_group_)
                               : std::make_unique<VertexModels>();
    contexts_ = std::make_unique<VertexContexts>(mesh_, factors.size());
  }
  InfluencePrediction prediction(gof_.influences, static_cast<std::uint32_t>(gof_.bones.size()),
                                 gof_.weight_bits);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < layers; ++j) first += gof_.layer_group_size[j];
  for (const std::uint32_t v :
       mesh_.vertices_of_layers(first, first + gof_.layer_group_size[layers])) {
    if (group == 0) influences(section, v, prediction);
    spatial_residuals(section, v, group);
  }
  if (layers == 0) models_of_group_ = std::make_unique<VertexModels>(*vertex_models_);
  w.append(section.finish());
  return w.take();
}

// 6.5 gof( ) and 6.11 bones_of_gof( )
std::vector<std::uint8_t> write_bones_of_gof(const SkinnedGof& gof,
                                             const SequenceHeader& header) {
  BitWriter w;
  write_gof_header(w, gof, header.profile_idc);
  w.ue(static_cast<std::uint32_t>(gof.bones.size()) - 1);
  w.u(5, static_cast<std::uint32_t>(gof.fraction_bits));
  w.u(3, static_cast<std::uint32_t>(gof.weight_bits));
  w.ue(gof.rest_step - 1);
  w.ue(gof.num_component_groups);
  if (header.profile_idc >= kProfileHigh) {
    w.u(3, static_cast<std::uint32_t>(gof.track_levels));
  }
  w.u(2, static_cast<std::uint32_t>(gof.prediction));
  if (gof.prediction == Prediction::kLayers) {
    w.u(4, static_cast<std::uint32_t>(gof.weights.damping_log2));
    w.u(4, static_cast<std::uint32_t>(gof.weights.outer_weight));
    w.u(4, static_cast<std::uint32_t>(gof.weights.outer_scale));
    if (header.profile_idc >= kProfileHigh) w.ue(gof.weights.num_adaptive_factors);
    w.ue(static_cast<std::uint32_t>(gof.layer_group_size.size()) - 1);
    for (std::size_t j = 0; j + 1 < gof.layer_group_size.size(); ++j) {
      w.ue(gof.layer_group_size[j] - 1);
    }
    for (const std::uint8_t step : gof.layer_step) w.u(4, step - 1U);
  }
  w.byte_alignment();
  w.append(write_bone_section(gof, header.position_bits));
  return w.take();
}

}  // namespace

SkinnedGofPayloads write_skinned_gof(const SkinnedGof& gof, const CodedMesh& mesh,
                                     const SequenceHeader& header) {
  SkinnedGofPayloads payloads;
  payloads.gof = write_bones_of_gof(gof, header);
  SliceWriter writer(gof, mesh);
  for (std::uint32_t group = 0; group < gof.slice_layers.size(); ++group) {
    for (std::uint32_t layers = 0; layers < gof.slice_layers[group]; ++layers) {
      payloads.slices.push_back(writer.write(group, layers));
    }
  }
  return payloads;
}

}  // namespace rlpc
