#include "decoder/codec/kinds/skinned/parse/parse_slice.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/memory/owned.h"
#include "decoder/codec/kinds/skinned/parse/bone_parser.h"
#include "decoder/codec/parse/parse_component_header.h"
#include "decoder/codec/parse/parse_rest_residuals.h"
#include "decoder/codec/parse/parse_track.h"
#include "decoder/codec/parse/rig_memory.h"

namespace rlpc {

// 6.12.1 group_components( )
void SkinnedGofParser::SliceParser::group_components() {
  const Level& level = parser_.header_.level();
  const auto left = static_cast<std::int64_t>(level.max_components - gof_.trajectories.size());
  SliceModels& models = state_.models;
  const int count = parse_header_field(section_, models.header, models.header_mean,
                                       HeaderField::kNumComponents, 1, {1, left},
                                       "num_group_components_minus1", "R-SLI-03");
  if (failed()) return;
  const std::uint64_t num_components =
      gof_.trajectories.size() + static_cast<std::size_t>(count);
  if (num_components > parser_.cut_.max_components) {
    parser_.kept_.end_component_group = group_;
    return;
  }
  if (num_components == parser_.cut_.max_components)
    parser_.kept_.end_component_group = group_ + 1;
  count_factors(static_cast<std::uint64_t>(count), 1, "num_group_components_minus1");
  for (int l = 0; l < count && !failed(); ++l) {
    Trajectory& next = gof_.trajectories.emplace_back();
    Trajectory& before = state_.previous;
    if (parser_.unit_ == Unit::kRig) {
      next.spatial_bits = parse_header_field(
          section_, models.header, models.header_mean, HeaderField::kSpatialBits,
          before.spatial_bits, {1, kMaxSpatialBits}, "spatial_bits_delta", "R-GOF-11");
      before.spatial_bits = next.spatial_bits;
      section_.check_overrun("spatial_bits_delta");
      continue;
    }
    parse_component_header(section_, models.header, models.header_mean, before, next);
    before.spatial_bits = next.spatial_bits;
    trajectory(next);
    section_.check_overrun("trajectory_residual");
  }
}

// Counts the factors of `count` trajectories. spatial: number of spatial factors, 0 if they are
// in the shared rig.
void SkinnedGofParser::SliceParser::count_factors(std::uint64_t count, std::uint64_t spatial,
                                                  const char* element) {
  parser_.memory_bytes_ += memory_of_trajectories(count);
  parser_.count_factors(section_, {spatial * count, 3 * count * gof_.num_frames}, element);
}

// 6.13.2 tracks_of_group( )
void SkinnedGofParser::SliceParser::tracks_of_group() {
  const FactorGroup factors = factor_group(*gof_.rig, group_);
  count_factors(factors.size(), 0, "trajectory_flag");
  SliceModels& models = state_.models;
  for (std::size_t l = factors.first; l < factors.end && !failed(); ++l) {
    Trajectory& next = gof_.trajectories.emplace_back();
    next.spatial_bits = gof_.rig->trajectories[l - kRestFactors].spatial_bits;
    next.trajectory_flag = section_.bin(models.trajectory_flag, "trajectory_flag");
    if (next.trajectory_flag) {
      next.scale_idx = parse_header_field(section_, models.header, models.header_mean,
                                          HeaderField::kScaleIdx, state_.previous.scale_idx,
                                          {0, kMaxScaleIdx}, "scale_idx_delta", "R-GOF-10");
      next.temporal_bits =
          parse_header_field(section_, models.header, models.header_mean,
                             HeaderField::kTemporalBits, state_.previous.temporal_bits,
                             {1, kMaxTemporalBits}, "temporal_bits_delta", "R-GOF-12");
      trajectory(next);
    }
    section_.check_overrun("trajectory_residual");
  }
}

// 6.12.1 trajectory( )
void SkinnedGofParser::SliceParser::trajectory(Trajectory& trajectory) {
  Trajectory& before = state_.previous;
  if (failed()) return;
  before.scale_idx = trajectory.scale_idx;
  before.temporal_bits = trajectory.temporal_bits;
  trajectory.temporal_predictor =
      section_.truncated_unary(state_.models.temporal_predictor, "temporal_predictor");
  for (int k = 0; k < trajectory.temporal_predictor - kMaxPredictorOrder; ++k) {
    const std::uint32_t weight = section_.bypass(9, "temporal_weight");
    trajectory.temporal_weight[static_cast<std::size_t>(k)] =
        static_cast<std::int16_t>(static_cast<int>(weight) - kTemporalWeightOffset);
  }
  if (gof_.track_levels > 0) {
    trajectory.temporal_between =
        section_.truncated_unary(state_.models.temporal_between, "temporal_between");
  }
  trajectory.residual.assign(gof_.num_frames, {});
  trajectory_residuals(trajectory);
}

// 6.12.1 trajectory_residuals( layer )
void SkinnedGofParser::SliceParser::trajectory_residuals(Trajectory& trajectory) {
  parse_track(section_, state_.models.trajectory, state_.trajectory_mean,
              places_of_layer(track_frames(gof_), trajectory.temporal_between,
                              static_cast<int>(temporal_layer_)),
              trajectory.residual, "trajectory_residual");
}

// 6.12.5 temporal_slice( )
void SkinnedGofParser::SliceParser::temporal_slice() {
  if (group_ == 0) {
    // 9.8.1 StartTemporalLayer( )
    state_.models.trajectory = {};
    std::fill(state_.trajectory_mean.begin(), state_.trajectory_mean.end(), 0);
    BoneParser parser(section_, parser_.header_, gof_);
    for (Bone& bone : gof_.bones) {
      parser.layer(bone, static_cast<int>(temporal_layer_));
      parser.check_overrun();
      if (failed()) return;
    }
  } else {
    const FactorGroup tracks = parser_.tracks_of(group_);
    for (std::size_t l = tracks.first; l < tracks.end && !failed(); ++l) {
      Trajectory& trajectory = gof_.trajectories[l - kRestFactors];
      if (trajectory.trajectory_flag) trajectory_residuals(trajectory);
      section_.check_overrun("trajectory_residual");
    }
  }
  section_.finish();
  // 9.8.1 EndTemporalSlice( )
  gof_.temporal_layers[group_] = temporal_layer_;
  state_.last_temporal_layer = temporal_layer_;
}

// 9.8.1 StartSlice( )
void SkinnedGofParser::SliceParser::start() {
  if (layers_ > 0) return;
  if (group_ > state_.first_own_group) {
    state_.vertex_models = make_shared_owned<VertexModels>(*state_.models_of_group);
  } else {
    state_.vertex_models = make_shared_owned<VertexModels>();
  }
  if (group_ > 0) {
    gof_.group_end.push_back(kRestFactors + gof_.trajectories.size());
    gof_.vertex_residual.emplace_back(own_factors().size() * parser_.header_.num_vertices);
  }
  state_.contexts.emplace(*parser_.mesh_, own_factors().size());
}

// 6.12.2 influences( v )
void SkinnedGofParser::SliceParser::influences(std::uint32_t v,
                                               InfluencePrediction& prediction) {
  prediction.start(parser_.mesh_->ring(v));
  SliceModels& models = state_.models;
  while (prediction.can_add_bone()) {
    const auto extra = static_cast<std::size_t>(prediction.num_extra_bones());
    if (!section_.bin(models.extra_bone_flag[extra], "extra_bone_flag")) break;
    const std::uint32_t bone = section_.bypass(ceil_log2(gof_.bones.size()), "extra_bone");
    if (bone >= gof_.bones.size() || !prediction.is_new_bone(bone)) {
      section_.fail("R-SLI-04", "extra_bone");
      return;
    }
    const std::uint32_t weight =
        section_.bypass(gof_.weight_bits, "extra_bone_weight_minus1") + 1;
    if (weight > static_cast<std::uint32_t>(prediction.weight_left())) {
      section_.fail("R-SLI-05", "extra_bone_weight_minus1");
      return;
    }
    prediction.add_extra_bone(bone, static_cast<int>(weight));
  }
  for (std::size_t k = 1; k < prediction.num_candidates(); ++k) {
    std::int32_t residual = 0;
    if (prediction.has_residual()) {
      residual = section_.residual(models.weight, prediction.expected(k), "weight_residual");
    }
    prediction.add_candidate(k, residual);
  }
  gof_.influences[v] = prediction.finish();
}

// 6.12.3 spatial_residuals( v )
void SkinnedGofParser::SliceParser::spatial_residuals(std::uint32_t v) {
  Vector<std::int32_t>& residuals = gof_.vertex_residual[parser_.own_group(group_)];
  const std::size_t size = residuals.size() / parser_.header_.num_vertices;
  VertexContexts& contexts = *state_.contexts;
  contexts.start(v);
  struct Context {
    VertexContexts& contexts;
    VertexModels& activity_models;
    ResidualModels& models() { return activity_models[contexts.activity()]; }
    std::uint32_t expected() const { return contexts.expected(); }
    void update(std::int32_t value) { contexts.update(value); }
  };
  section_.residuals(Context{contexts, *state_.vertex_models},
                     std::span(residuals).subspan(v * size, size), "vertex_residual");
}

void SkinnedGofParser::SliceParser::parse() {
  if (temporal_layer_ > 0) return temporal_slice();
  if (parser_.has_only_tracks(group_)) {
    tracks_of_group();
    section_.finish();
    gof_.slice_layers[group_] = gof_.rig->slice_layers[group_];  // 8.16.2 EndTracks( )
    state_.last_group = group_;
    return;
  }
  if (group_ > 0 && layers_ == 0 && !failed()) group_components();
  if (failed() || group_ >= parser_.kept_.end_component_group) return;
  start();
  InfluencePrediction prediction(gof_.influences, static_cast<std::uint32_t>(gof_.bones.size()),
                                 gof_.weight_bits);
  std::uint32_t first = 0;
  for (std::uint32_t j = 0; j < layers_; ++j) first += gof_.layer_group_size[j];
  for (const std::uint32_t v :
       parser_.mesh_->vertices_of_layers(first, first + gof_.layer_group_size[layers_])) {
    if (group_ == 0) influences(v, prediction);
    if (failed()) return;
    if (group_ > 0 || !gof_.rest.order_flag) spatial_residuals(v);
    section_.check_overrun("vertex_residual");
    if (failed()) return;
  }
  if (gof_.rest.order_flag && group_ == 0 && layers_ == 0) {
    parse_rest_residuals(section_, parser_.mesh_->rest_order(), gof_.vertex_residual[0],
                         gof_.counterparts);
  }
  section_.finish();
  if (failed()) return;
  // 9.8.1 EndSlice( )
  if (layers_ == 0) {
    state_.models_of_group = make_shared_owned<VertexModels>(*state_.vertex_models);
  }
  gof_.slice_layers[group_] = layers_ + 1;
  state_.last_group = group_;
}

}  // namespace rlpc
