#include "decoder/parse/parse_skinned_gof.h"

#include <algorithm>
#include <utility>

#include "common/int_math.h"
#include "common/skinned_gof/influences.h"
#include "decoder/parse/parse_component_header.h"
#include "decoder/parse/parse_track.h"
#include "decoder/parse/section_reader.h"

namespace rlpc {
namespace {

// Bytes per factor: as a residual with its magnitude, as a value, and laid out for the sums.
constexpr std::uint64_t kBytesPerFactor = 18;

// 7.11.1 Bone section: without trajectories, R-LVL-05 cannot be broken.
static_assert(std::all_of(kLevels.begin(), kLevels.end(), [](const Level& level) {
  return 6 * std::uint64_t{level.max_clusters} * level.max_gof_frames +
             3 * std::uint64_t{level.max_vertices} <=
         level.max_gof_factors;
}));

// 6.11.2 bone( b )
class BoneParser {
 public:
  BoneParser(SectionReader& section, const SequenceHeader& header, const SkinnedGof& gof)
      : section_(section),
        header_(header),
        gof_(gof),
        rotation_mean_(gof.num_frames, 0),
        origin_mean_(gof.num_frames, 0) {}

  Bone parse(std::uint32_t b) {
    Bone bone;
    if (b > 0) {
      const std::uint32_t parent_plus1 = section_.bypass(ceil_log2(b + 1), "bone_parent_plus1");
      if (parent_plus1 > b) section_.fail("R-BON-04", "bone_parent_plus1");
      bone.parent = static_cast<std::int32_t>(std::min(parent_plus1, b)) - 1;
    }
    for (std::int32_t& x : bone.pivot) {
      const std::uint32_t value = section_.bypass(header_.position_bits + 5, "bone_pivot");
      x = static_cast<std::int32_t>(value) - (1 << (header_.position_bits + 4));
    }
    bone.rotation_flag = section_.bin(models_.rotation_flag, "rotation_flag");
    bone.origin_flag = section_.bin(models_.origin_flag, "origin_flag");
    if (bone.rotation_flag) {
      bone.rotation_step_idx = step_idx("rotation_step_idx");
      bone.rotation_order =
          section_.truncated_unary(models_.rotation_order, "rotation_order_minus1") + 1;
      bone.rotation_between = between(models_.rotation_between, "rotation_between");
      bone.rotation_residual = parse_track(section_, models_.rotation, rotation_mean_,
                                           order(bone.rotation_between), "rotation_residual");
    }
    if (bone.origin_flag) {
      bone.origin_step_idx = step_idx("origin_step_idx");
      bone.origin_order = section_.truncated_unary(models_.origin_order, "origin_order");
      bone.origin_between = between(models_.origin_between, "origin_between");
      bone.origin_residual = parse_track(section_, models_.origin, origin_mean_,
                                         order(bone.origin_between), "origin_residual");
    }
    return bone;
  }

 private:
  std::uint32_t step_idx(const char* element) {
    const std::uint32_t idx = section_.bypass(8, element);
    if (idx > kMaxStepIdx) section_.fail("R-BON-05", element);
    return std::min(idx, kMaxStepIdx);
  }

  int between(std::array<BitModel, kMaxBetween>& models, const char* element) {
    return gof_.track_levels > 0 ? section_.truncated_unary(models, element) : 0;
  }
  std::vector<TrackPlace> order(int between) const {
    return track_order(gof_.num_frames, gof_.track_levels, between);
  }

  SectionReader& section_;
  const SequenceHeader& header_;
  const SkinnedGof& gof_;
  BoneModels models_;
  std::vector<std::uint32_t> rotation_mean_;
  std::vector<std::uint32_t> origin_mean_;
};

}  // namespace

// 6.11 layers_of_gof( )
void SkinnedGofParser::layers(BitReader& r) {
  gof_.layer_group_size = {mesh_->num_layers()};
  gof_.layer_step.assign(mesh_->num_layers(), kMaxLayerStep);
  if (gof_.prediction != Prediction::kLayers) return;
  gof_.weights.damping_log2 = static_cast<int>(r.u(4, "damping_log2"));
  gof_.weights.outer_weight = static_cast<int>(r.u(4, "outer_weight"));
  gof_.weights.outer_scale = static_cast<int>(r.u(4, "outer_scale"));
  if (header_.profile_idc >= kProfileHigh) {
    gof_.weights.num_adaptive_factors =
        r.ue("num_adaptive_factors", {0, header_.level().max_components}, "R-BON-06");
  }
  const std::int64_t num_layers = mesh_->num_layers();
  const std::uint32_t num_groups =
      r.ue("num_layer_groups_minus1", {0, num_layers - 1}, "R-BON-03") + 1;
  if (r.error()) return;
  gof_.layer_group_size.assign(num_groups, 1);
  std::int64_t left = num_layers;
  for (std::uint32_t j = 0; j + 1 < num_groups; ++j) {
    const std::int64_t groups_after = num_groups - j - 1;
    gof_.layer_group_size[j] =
        r.ue("layer_group_layers_minus1", {0, left - groups_after - 1}, "R-BON-03") + 1;
    left -= gof_.layer_group_size[j];
  }
  gof_.layer_group_size.back() = static_cast<std::uint32_t>(left);
  for (std::uint8_t& step : gof_.layer_step) {
    step = static_cast<std::uint8_t>(r.u(4, "layer_step_minus1") + 1);
  }
}

// 6.11.1 bone_section( )
void SkinnedGofParser::bone_section(BitReader& r) {
  SectionReader section(r, "bone_section");
  num_factors_ = 6 * std::uint64_t{gof_.bones.size()} * gof_.num_frames +
                 3 * std::uint64_t{header_.num_vertices};
  if (section.failed()) return;
  const std::uint64_t needed_bytes =
      num_factors_ * kBytesPerFactor + sizeof(Influences) * std::uint64_t{header_.num_vertices};
  if (needed_bytes > max_memory_bytes_) section.fail_memory("bone_section", needed_bytes);
  if (section.failed()) return;
  BoneParser parser(section, header_, gof_);
  for (std::uint32_t b = 0; b < gof_.bones.size() && !section.failed(); ++b) {
    gof_.bones[b] = parser.parse(b);
    section.check_overrun("origin_residual");
  }
  section.finish();
}

void SkinnedGofParser::SliceState::start(std::uint32_t num_frames) {
  models = {};
  previous = {};
  trajectory_mean.assign(num_frames, 0);
  contexts.reset();
  last_group = 0;
}

// 6.11 bones_of_gof( )
Result<bool> SkinnedGofParser::bones(BitReader& r, const GofHeader& gof_header) {
  gof_ = {};
  static_cast<GofHeader&>(gof_) = gof_header;
  const Level& level = header_.level();
  const std::uint32_t num_bones =
      r.ue("num_bones_minus1", {0, std::int64_t{level.max_clusters} - 1}, "R-LVL-06") + 1;
  gof_.fraction_bits =
      static_cast<int>(r.u(5, "fraction_bits", {0, kMaxFractionBits}, "R-GOF-03"));
  gof_.weight_bits = static_cast<int>(r.u(3, "weight_bits"));
  gof_.rest_step = r.ue("rest_step_minus1", {0, kMaxRestStep - 1}, "R-BON-01") + 1;
  gof_.num_component_groups =
      r.ue("num_component_groups", {0, kMaxComponentGroups}, "R-BON-02");
  if (header_.profile_idc >= kProfileHigh) {
    gof_.track_levels = static_cast<int>(r.u(3, "track_levels"));
  }
  gof_.prediction = static_cast<Prediction>(r.u(2, "prediction_idc"));
  if (r.error()) return *r.error();
  mesh_ = &meshes_[gof_.prediction];
  layers(r);
  r.byte_alignment();
  if (r.error()) return *r.error();
  gof_.bones.resize(num_bones);
  bone_section(r);
  if (r.error()) return *r.error();

  state_.start(gof_.num_frames);
  kept_.end_component_group = cut_.max_components == 0 ? 1 : gof_.num_component_groups + 1;
  kept_.end_layer_group = layer_groups_that_stay(gof_.layer_group_size, cut_.max_layers);
  is_cut_ = false;
  gof_.slice_layers.assign(std::size_t{gof_.num_component_groups} + 1, 0);
  gof_.influences.assign(header_.num_vertices, {});
  gof_.vertex_residual.emplace_back(kRestFactors * std::size_t{header_.num_vertices});
  return true;
}

// 8.14.1 MayFollow( group, index )
bool SkinnedGofParser::may_follow(std::uint32_t group, std::uint32_t layers) const {
  if (group < state_.last_group || layers != gof_.slice_layers[group]) return false;
  return group == 0 || gof_.slice_layers[group - 1] > layers;
}

// The section of a slice.
class SkinnedGofParser::SliceParser {
 public:
  SliceParser(SkinnedGofParser& parser, BitReader& r, std::uint32_t group, std::uint32_t layers)
      : parser_(parser),
        gof_(parser.gof_),
        state_(parser.state_),
        section_(r, "slice_section"),
        group_(group),
        layers_(layers) {}

  void parse();

 private:
  bool failed() const { return section_.failed(); }
  void group_components();
  void trajectory(Trajectory& trajectory);
  void start();
  void influences(std::uint32_t v, InfluencePrediction& prediction);
  void spatial_residuals(std::uint32_t v);

  SkinnedGofParser& parser_;
  SkinnedGof& gof_;
  SliceState& state_;
  SectionReader section_;
  std::uint32_t group_;
  std::uint32_t layers_;
};

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
  parser_.num_factors_ += static_cast<std::uint64_t>(count) *
                          (parser_.header_.num_vertices + 3 * std::uint64_t{gof_.num_frames});
  if (parser_.num_factors_ > level.max_gof_factors) {
    section_.fail("R-LVL-05", "num_group_components_minus1");
  } else if (parser_.num_factors_ * kBytesPerFactor > parser_.max_memory_bytes_) {
    section_.fail_memory("num_group_components_minus1", parser_.num_factors_ * kBytesPerFactor);
  }
  for (int l = 0; l < count && !failed(); ++l) {
    gof_.trajectories.emplace_back();
    trajectory(gof_.trajectories.back());
    section_.check_overrun("trajectory_residual");
  }
}

// 6.12.1 trajectory( )
void SkinnedGofParser::SliceParser::trajectory(Trajectory& trajectory) {
  Trajectory& before = state_.previous;
  parse_component_header(section_, state_.models.header, state_.models.header_mean, before,
                         trajectory);
  if (failed()) return;
  before.scale_idx = trajectory.scale_idx;
  before.spatial_bits = trajectory.spatial_bits;
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
  trajectory.residual =
      parse_track(section_, state_.models.trajectory, state_.trajectory_mean,
                  track_order(gof_.num_frames, gof_.track_levels, trajectory.temporal_between),
                  "trajectory_residual");
}

// 9.8.1 StartSlice( )
void SkinnedGofParser::SliceParser::start() {
  if (layers_ > 0) return;
  if (group_ > 1) {
    state_.vertex_models = std::make_unique<VertexModels>(*state_.models_of_group);
  } else {
    state_.vertex_models = std::make_unique<VertexModels>();
  }
  if (group_ > 0) {
    gof_.group_end.push_back(kRestFactors + gof_.trajectories.size());
    const std::size_t size = gof_.group_end[group_] - gof_.group_end[group_ - 1];
    gof_.vertex_residual.emplace_back(size * parser_.header_.num_vertices);
  }
  const std::size_t size =
      gof_.group_end[group_] - (group_ > 0 ? gof_.group_end[group_ - 1] : 0);
  state_.contexts.emplace(*parser_.mesh_, size);
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
  std::vector<std::int32_t>& residuals = gof_.vertex_residual[group_];
  const std::size_t size = residuals.size() / parser_.header_.num_vertices;
  VertexContexts& contexts = *state_.contexts;
  contexts.start(v);
  struct Context {
    VertexContexts& contexts;
    VertexModels& of_activity;
    ResidualModels& models() { return of_activity[contexts.activity()]; }
    std::uint32_t expected() const { return contexts.expected(); }
    void update(std::int32_t value) { contexts.update(value); }
  };
  section_.residuals(Context{contexts, *state_.vertex_models},
                     std::span(residuals).subspan(v * size, size), "vertex_residual");
}

void SkinnedGofParser::SliceParser::parse() {
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
    spatial_residuals(v);
    section_.check_overrun("vertex_residual");
    if (failed()) return;
  }
  section_.finish();
  if (failed()) return;
  // 9.8.1 EndSlice( )
  if (layers_ == 0) {
    state_.models_of_group = std::make_unique<VertexModels>(*state_.vertex_models);
  }
  gof_.slice_layers[group_] = layers_ + 1;
  state_.last_group = group_;
}

// 6.12 slice_unit( )
Result<bool> SkinnedGofParser::slice(BitReader& r, std::uint64_t unit_bit_pos) {
  const std::uint32_t group =
      r.ue("component_group_idx", {0, gof_.num_component_groups}, "R-SLI-01");
  const std::uint32_t layers =
      r.ue("layer_group_idx", {0, static_cast<std::int64_t>(gof_.layer_group_size.size()) - 1},
           "R-SLI-01");
  if (r.error()) return *r.error();
  last_slice_.reset();
  if (!kept_.has(group, layers)) {
    is_cut_ = true;
    return true;
  }
  if (!may_follow(group, layers)) {
    r.fail(Errc::kInvalid, "R-SLI-02", "slice_unit", unit_bit_pos);
  }
  r.byte_alignment();
  if (r.error()) return *r.error();
  const std::size_t trajectories_before = gof_.trajectories.size();
  SliceParser(*this, r, group, layers).parse();
  if (r.error()) return *r.error();
  // The number of trajectories in a group is known only from its slice.
  if (group >= kept_.end_component_group) {
    is_cut_ = true;
    return true;
  }
  const std::size_t count = gof_.trajectories.size() - trajectories_before;
  last_slice_ = SliceEntry{group, layers, static_cast<std::uint32_t>(count), 0};
  return true;
}

}  // namespace rlpc
