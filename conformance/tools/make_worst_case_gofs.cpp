// Makes GOFs with as many factors, bones and influences as possible, of the widths that take a
// decoder longest.
#include <span>

#include "common/codec/kinds/skinned/influences.h"
#include "conformance/tools/make_worst_case.h"

namespace rlpc::worst_case {
namespace {

// The greatest widths: both factors have two limbs in memory, and each product is four.
constexpr int kSpatialBits = kMaxSpatialBits;
constexpr int kTemporalBits = kMaxTemporalBits;
constexpr int kScaleIdx = 100;

Trajectory make_trajectory(std::uint32_t num_frames, Noise& noise) {
  Trajectory trajectory;
  trajectory.spatial_bits = kSpatialBits;
  if (num_frames == 0) return trajectory;
  trajectory.scale_idx = kScaleIdx;
  trajectory.temporal_bits = kTemporalBits;
  trajectory.temporal_predictor = kMaxTemporalPredictor;
  trajectory.temporal_weight = {255, -256, 255};
  trajectory.residual = noise.track(num_frames);
  return trajectory;
}

void add_tracks(Bone& bone, std::uint32_t num_frames, Noise& noise) {
  bone.rotation_order = kMaxPredictorOrder;
  bone.origin_order = kMaxPredictorOrder;
  bone.rotation_residual = noise.track(num_frames);
  bone.origin_residual = noise.track(num_frames);
}

// Makes the most influences that can be coded, of bones that are rare around the vertex: 4
// extra bones, and 4 of the bones in its ring.
class InfluenceMaker {
 public:
  InfluenceMaker(std::vector<Influences>& influences, std::uint32_t num_bones, Noise& noise)
      : influences_(influences),
        prediction_(influences, num_bones, kMaxWeightBits),
        num_bones_(num_bones),
        noise_(noise) {}

  void set(std::uint32_t v, std::span<const std::uint32_t> ring) {
    constexpr int kWeight = (1 << kMaxWeightBits) / kMaxInfluences;
    prediction_.start(ring);
    while (prediction_.can_add_bone()) {
      std::uint32_t bone = noise_.below(num_bones_);
      while (!prediction_.is_new_bone(bone)) bone = (bone + 1) % num_bones_;
      prediction_.add_extra_bone(bone, kWeight);
    }
    const std::size_t count = prediction_.num_candidates();
    for (std::size_t k = 1; k < count; ++k) {
      const int weight = k + 3 >= count ? kWeight : 0;
      const bool coded = prediction_.has_residual();
      prediction_.add_candidate(k, coded ? weight - prediction_.candidate_mean(k) : 0);
    }
    influences_[v] = prediction_.finish();
  }

 private:
  std::vector<Influences>& influences_;
  InfluencePrediction prediction_;
  std::uint32_t num_bones_;
  Noise& noise_;
};

// num_frames: 0 for a shared rig.
void fill_rig(SharedRig& rig, const Size& size, const OrderedMesh& mesh, Noise& noise,
              std::uint32_t num_frames) {
  rig.fraction_bits = kMaxFractionBits;
  rig.weight_bits = kMaxWeightBits;
  rig.rest_step = 1;
  rig.weights = {5, 8, 8, size.adaptive_factors};
  rig.layer_group_size = {mesh.num_layers()};
  rig.layer_step.assign(mesh.num_layers(), 1);
  for (std::uint32_t b = 0; b < size.bones; ++b) {
    Bone& bone = rig.bones.emplace_back();
    bone.parent = static_cast<std::int32_t>(b) - 1;
    bone.rotation_flag = bone.origin_flag = true;
    if (num_frames > 0) add_tracks(bone, num_frames, noise);
  }
  rig.influences.resize(size.vertices);
  InfluenceMaker influences(rig.influences, size.bones, noise);
  for (const std::uint32_t v : mesh.order()) influences.set(v, mesh.ring(v));
  // A single component group, all of whose values are reconstructed together.
  rig.num_component_groups = 1;
  rig.slice_layers = {1, 1};
  for (std::uint32_t l = 0; l < size.components; ++l)
    rig.trajectories.push_back(make_trajectory(num_frames, noise));
  rig.group_end.push_back(kRestFactors + size.components);
  for (const std::size_t count : {kRestFactors, std::size_t{size.components}})
    rig.vertex_residual.push_back(noise.residuals(count * size.vertices));
}

}  // namespace

std::vector<std::int32_t> Noise::residuals(std::size_t count) {
  std::vector<std::int32_t> list(count);
  for (std::int32_t& x : list) x = residual();
  return list;
}

TrackResiduals Noise::track(std::uint32_t num_frames) {
  TrackResiduals list(num_frames);
  for (Vec3i& at : list) {
    for (std::int32_t& x : at) x = residual();
  }
  return list;
}

ClusterGof make_clusters(const Size& size, Noise& noise) {
  ClusterGof gof;
  gof.num_frames = size.frames;
  gof.fraction_bits = kMaxFractionBits;
  gof.seed_predictor = kMaxPredictorOrder;
  gof.seed_coupling_flag = true;
  gof.clusters.resize(size.bones);
  gof.cluster_of_vertex.assign(size.vertices, 0);
  Cluster& cluster = gof.clusters[0];
  cluster.lcf_flag = true;
  for (std::uint32_t k = 0; k < 3; ++k) {
    cluster.seed_vertex[k] = k;
    gof.cluster_of_vertex[k] = kSeedCluster;
    gof.seed_tracks.push_back({k, 0, noise.track(size.frames)});
  }
  cluster.components.resize(size.components);
  for (Component& component : cluster.components) {
    component.scale_idx = kScaleIdx;
    component.spatial_bits = kSpatialBits;
    component.temporal_bits = kTemporalBits;
    component.temporal_predictor = kMaxPredictorOrder;
    component.spatial_predictor = SpatialPredictor::kParallelogram;
    component.temporal_residual = noise.residuals(size.frames);
    component.spatial_residual = noise.residuals(3 * (std::size_t{size.vertices} - 3));
  }
  return gof;
}

SkinnedGof make_bones(const Size& size, const OrderedMesh& mesh, Noise& noise) {
  SkinnedGof gof;
  gof.num_frames = size.frames;
  fill_rig(gof, size, mesh, noise, size.frames);
  return gof;
}

SharedRig make_rig(const Size& size, const OrderedMesh& mesh, Noise& noise) {
  SharedRig rig;
  fill_rig(rig, size, mesh, noise, 0);
  rig.rest = {false, true, 8, 8, true, true};
  rig.counterparts.resize(size.vertices);
  rig.stretch_flag = true;
  for (Bone& bone : rig.bones) {
    bone.stretch = Stretch::kOwnAxes;
    for (std::int32_t& x : bone.stretch_axes) x = static_cast<std::int32_t>(noise.below(32768));
  }
  return rig;
}

SkinnedGof make_tracks(const Size& size, const SharedRig& rig, Noise& noise) {
  SkinnedGof gof;
  gof.kind = GofKind::kSharedRig;
  gof.num_frames = size.frames;
  gof.track_levels = kMaxTrackLevels;
  gof.num_component_groups = rig.num_component_groups;
  gof.layer_group_size = rig.layer_group_size;
  gof.prediction = rig.prediction;
  gof.slice_layers = rig.slice_layers;
  gof.stretch_flag = rig.stretch_flag;
  gof.bones = rig.bones;
  for (Bone& bone : gof.bones) {
    add_tracks(bone, size.frames, noise);
    bone.stretch_order = kMaxPredictorOrder;
    bone.stretch_residual = noise.track(size.frames);
    bone.rotation_between = bone.origin_between = bone.stretch_between = kMaxBetween;
  }
  for (std::uint32_t l = 0; l < size.components; ++l) {
    gof.trajectories.push_back(make_trajectory(size.frames, noise));
    gof.trajectories.back().temporal_between = kMaxBetween;
  }
  gof.group_end = {rig.group_end.back()};
  gof.vertex_residual.emplace_back();
  return gof;
}

// Makes an explicit pattern of the longest period, whose frames all have two references except
// the last. All but a few have depth 0, so that filters of all temporal layers learn from them.
InterSettings make_frames(const Size& size, const OrderedMesh& mesh) {
  InterSettings s;
  s.pattern.kind = FramePattern::kExplicit;
  s.pattern.entries.push_back({kMaxExplicitPeriod, {0, 0}, 0});
  for (std::uint32_t offset = 1; offset < kMaxExplicitPeriod; ++offset) {
    const std::uint32_t min = kMaxExplicitPeriod - size.components;
    s.pattern.entries.push_back(
        {offset, {offset - 1, kMaxExplicitPeriod}, offset > min ? offset - min : 0});
  }
  s.pattern.temporal_layers = size.components;
  s.step.assign(s.pattern.num_depths(), 1);
  s.learning_flag = true;
  s.weights = {15, 15, 15, 0};
  s.prime_log2 = 15;
  s.max_earlier_distance = size.repeats;
  s.layer_group_size = {mesh.num_layers()};
  s.layer_step.assign(mesh.num_layers(), 1);
  s.rest = {false, true, 8, 8, true, true};
  s.num_patches = size.bones;
  for (std::uint32_t v = 0; s.num_patches > 0 && v < size.vertices; ++v) {
    s.patch_of_vertex.push_back(static_cast<std::uint16_t>(v % s.num_patches));
  }
  return s;
}

}  // namespace rlpc::worst_case
