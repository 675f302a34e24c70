// Random legal skinned GOFs, for tests. Fields are often at the ends of their ranges.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/skinned/influences.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/rest/counterparts.h"
#include "common/codec/syntax/sequence_header.h"

namespace rlpc {

struct SkinnedGofSizes {
  std::uint32_t max_vertices = 40;
  std::uint32_t max_frames = 8;
  std::uint32_t max_bones = 6;
  std::uint32_t max_groups = 4;
  std::uint32_t max_components = 4;  // per group
  bool rest_order = true;            // allowed; some GOFs have it
  bool temporal_layers = true;       // allowed; some GOFs have them
};

class RandomSkinnedGof {
 public:
  RandomSkinnedGof(unsigned seed, const SkinnedGofSizes& sizes) : state_(seed) {
    make_mesh(sizes);
    make_header(sizes);
    const OrderedMesh mesh = coded_mesh();
    make_layers_of_gof(mesh);
    for (std::uint32_t b = 0; b < gof.bones.size(); ++b) make_bone(b);
    if (sizes.rest_order) make_rest();
    make_slices(mesh, sizes);
    if (gof.num_temporal_layers > 1) drop_temporal_layers();
    make_influences(mesh);
  }

  SequenceHeader header;
  std::vector<Triangle> triangles;
  Topology topology;
  VertexLayers layers;
  std::optional<RestOrder> rest_order;
  SkinnedGof gof;

  OrderedMesh coded_mesh() const { return {gof.prediction, topology, layers, &*rest_order}; }

  // Sets the residuals of temporal layers without slices to 0.
  void drop_absent_residuals() {
    if (gof.temporal_layers.empty()) return;
    for (Bone& bone : gof.bones) {
      drop_residuals(bone.rotation_residual, bone.rotation_between, gof.temporal_layers[0]);
      drop_residuals(bone.origin_residual, bone.origin_between, gof.temporal_layers[0]);
      drop_residuals(bone.stretch_residual, bone.stretch_between, gof.temporal_layers[0]);
    }
    for (std::size_t group = 1; group < gof.group_end.size(); ++group) {
      for (std::size_t l = gof.group_end[group - 1]; l < gof.group_end[group]; ++l) {
        Trajectory& t = gof.trajectories[l - kRestFactors];
        drop_residuals(t.residual, t.temporal_between, gof.temporal_layers[group]);
      }
    }
  }

 private:
  static constexpr int kResidualBits = 28;  // maximum width of a magnitude
  static_assert(kMaxResidual == (1U << kResidualBits) - 1);

  // Returns the high bits of Knuth's linear congruential generator.
  std::uint32_t random() {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return static_cast<std::uint32_t>(state_ >> 33);
  }
  std::uint32_t below(std::uint32_t n) { return n == 0 ? 0 : random() % n; }
  bool coin() { return random() % 2 == 0; }
  int between(int min, int max) {
    const auto kind = random() % 6;
    if (kind == 0) return min;
    if (kind == 1) return max;
    return min + static_cast<int>(below(static_cast<std::uint32_t>(max - min + 1)));
  }
  // Returns a residual within `bits` bits, but occasionally of any size.
  std::int32_t residual(int bits) {
    if (random() % 64 == 0) bits = kResidualBits;
    const std::uint32_t range = std::uint32_t{1} << bits;
    const auto magnitude =
        static_cast<std::int32_t>(random() % 32 == 0 ? range - 1 : below(range));
    return coin() ? magnitude : -magnitude;
  }
  TrackResiduals track() {
    TrackResiduals residuals(gof.num_frames);
    const int bits = between(0, kResidualBits);
    for (Vec3i& r : residuals) {
      for (std::int32_t& x : r) x = residual(bits);
    }
    return residuals;
  }

  int order_of_track() { return gof.track_levels > 0 ? between(0, kMaxBetween) : 0; }

  // Makes a sheet with holes and stray triangles.
  void make_mesh(const SkinnedGofSizes& sizes) {
    const std::uint32_t n = 1 + below(sizes.max_vertices);
    const std::uint32_t width = 1 + below(8);
    for (std::uint32_t v = 0; v + width + 1 < n; ++v) {
      if (random() % 16 != 0) triangles.push_back({v, v + 1, v + width + 1});
      if (random() % 16 != 0) triangles.push_back({v, v + width + 1, v + width});
    }
    for (std::uint32_t i = below(4); i > 0; --i)
      triangles.push_back({below(n), below(n), below(n)});
    topology = make_topology(n, triangles);
    layers = rlpc::make_layers(n, triangles);
    rest_order.emplace(topology, triangles);
    header.num_vertices = n;
    header.num_triangles = static_cast<std::uint32_t>(triangles.size());
  }

  void make_header(const SkinnedGofSizes& sizes) {
    header.profile_idc = kProfileMain;
    header.num_frames = 1 + below(1000);
    header.position_bits = between(kMinPositionBits, kMaxPositionBits);
    gof.first_frame = below(header.num_frames);
    gof.num_frames = 1 + below(std::min(sizes.max_frames, header.num_frames - gof.first_frame));
    gof.fraction_bits = between(0, kMaxFractionBits);
    gof.weight_bits = between(0, kMaxWeightBits);
    gof.rest_step = static_cast<std::uint32_t>(between(1, static_cast<int>(kMaxRestStep)));
    gof.prediction = static_cast<Prediction>(below(4));
    gof.bones.resize(1 + below(sizes.max_bones));
    if (coin()) header.profile_idc = kProfileHigh;
    if (header.profile_idc == kProfileHigh) gof.stretch_flag = coin();
    if (header.profile_idc == kProfileHigh && coin()) {
      gof.track_levels = between(0, kMaxTrackLevels);
      if (coin() && sizes.temporal_layers)
        gof.num_temporal_layers = 1 + between(0, gof.track_levels);
    }
  }

  void make_layers_of_gof(const OrderedMesh& mesh) {
    gof.layer_group_size = {mesh.num_layers()};
    gof.layer_step.assign(mesh.num_layers(), kMaxLayerStep);
    if (gof.prediction != Prediction::kLayers) return;
    gof.weights.damping_log2 = between(0, 15);
    gof.weights.outer_weight = between(0, 15);
    gof.weights.outer_scale = between(0, 15);
    if (header.profile_idc >= kProfileHigh) gof.weights.num_adaptive_factors = below(12);
    gof.layer_group_size.clear();
    for (std::uint32_t left = mesh.num_layers(); left > 0;
         left -= gof.layer_group_size.back()) {
      gof.layer_group_size.push_back(1 + below(left));
    }
    for (std::uint8_t& step : gof.layer_step) {
      step = static_cast<std::uint8_t>(between(1, kMaxLayerStep));
    }
  }

  void make_bone(std::uint32_t b) {
    Bone& bone = gof.bones[b];
    bone.parent = static_cast<std::int32_t>(below(b + 1)) - 1;
    const int max = 1 << (header.position_bits + 4);
    for (std::int32_t& x : bone.pivot) x = between(-max, max - 1);
    bone.rotation_flag = coin();
    bone.origin_flag = coin();
    if (bone.rotation_flag) {
      bone.rotation_step_idx = static_cast<std::uint32_t>(between(0, kMaxStepIdx));
      bone.rotation_order = between(1, kMaxPredictorOrder);
      bone.rotation_between = order_of_track();
      bone.rotation_residual = track();
    }
    if (bone.origin_flag) {
      bone.origin_step_idx = static_cast<std::uint32_t>(between(0, kMaxStepIdx));
      bone.origin_order = between(0, kMaxPredictorOrder);
      bone.origin_between = order_of_track();
      bone.origin_residual = track();
    }
    if (gof.stretch_flag) bone.stretch = static_cast<Stretch>(below(3));
    if (bone.stretch == Stretch::kOwnAxes) {
      constexpr int kMax = 1 << (kStretchAxisBits - 1);
      for (std::int32_t& x : bone.stretch_axes) x = between(-kMax, kMax - 1);
    }
    if (bone.stretch != Stretch::kNone) {
      bone.stretch_step_idx = static_cast<std::uint32_t>(between(0, kMaxStepIdx));
      bone.stretch_order = between(0, kMaxPredictorOrder);
      bone.stretch_between = order_of_track();
      bone.stretch_residual = track();
    }
  }

  // Each component group has at most as many temporal layers as the previous one, and none
  // without its trajectories.
  void drop_temporal_layers() {
    auto present = static_cast<std::uint32_t>(gof.num_temporal_layers) - 1;
    for (const std::uint32_t num_layers : gof.slice_layers) {
      const bool is_first = gof.temporal_layers.empty();
      if (random() % 4 == 0) present = below(present + 1);
      if (!is_first && num_layers == 0) present = 0;
      gof.temporal_layers.push_back(present);
    }
    drop_absent_residuals();
  }
  void drop_residuals(TrackResiduals& residuals, int between, std::uint32_t present) const {
    if (residuals.empty()) return;
    for (int layer = static_cast<int>(present) + 1; layer < gof.num_temporal_layers; ++layer) {
      for (const TrackPlace& at : places_of_layer(track_frames(gof), between, layer)) {
        residuals[at.frame] = {};
      }
    }
  }

  void make_rest() {
    if (header.profile_idc < kProfileHigh || coin()) return;
    gof.rest.order_flag = true;
    gof.rest.edge_weight = between(0, 63);
    gof.rest.ring_weight = between(0, 63);
    gof.rest.axes_flag = coin();
    gof.rest.counterparts_flag = coin();
  }

  // Makes any legal counterpart at each vertex whose slice is present.
  void make_counterparts() {
    gof.counterparts.resize(header.num_vertices);
    if (gof.slice_layers[0] == 0) return;
    Counterparts counterparts(*rest_order);
    for (const std::uint32_t v : rest_order->order()) {
      Counterpart& choice = gof.counterparts[v];
      const auto num_hinges = static_cast<std::uint32_t>(rest_order->hinges(v).size());
      counterparts.start(v);
      choice.flag = counterparts.is_inherited() && random() % 4 != 0;
      if (!choice.flag && num_hinges > 0 && counterparts.num_listed() > 0 && coin()) {
        choice.new_flag = true;
        choice.mirrored = coin();
        choice.hinge = static_cast<std::uint8_t>(below(num_hinges));
        choice.idx = below(static_cast<std::uint32_t>(counterparts.num_listed()));
        counterparts.set_new(choice);
      }
      counterparts.finish(choice.flag || choice.new_flag);
    }
  }

  Trajectory make_trajectory() {
    Trajectory t;
    t.scale_idx = between(0, kMaxScaleIdx);
    t.spatial_bits = between(1, kMaxSpatialBits);
    t.temporal_bits = between(1, kMaxTemporalBits);
    t.temporal_predictor = between(0, kMaxTemporalPredictor);
    t.temporal_between = order_of_track();
    for (int k = 0; k < t.temporal_predictor - kMaxPredictorOrder; ++k) {
      t.temporal_weight[static_cast<std::size_t>(k)] =
          static_cast<std::int16_t>(between(-kTemporalWeightOffset, kTemporalWeightOffset - 1));
    }
    t.residual = track();
    return t;
  }

  // Makes slices, none to all: each group has at most as many layers as the previous one.
  void make_slices(const OrderedMesh& mesh, const SkinnedGofSizes& sizes) {
    gof.num_component_groups = below(sizes.max_groups + 1);
    gof.slice_layers.clear();
    auto present = static_cast<std::uint32_t>(gof.layer_group_size.size());
    for (std::uint32_t group = 0; group <= gof.num_component_groups; ++group) {
      if (random() % 4 == 0) present = below(present + 1);
      gof.slice_layers.push_back(present);
      if (group > 0 && present > 0) {
        for (std::uint32_t l = 1 + below(sizes.max_components); l > 0; --l) {
          gof.trajectories.push_back(make_trajectory());
        }
        gof.group_end.push_back(kRestFactors + gof.trajectories.size());
      }
      if (group == 0 || present > 0) add_residuals(mesh, group, present);
    }
    if (gof.rest.counterparts_flag) make_counterparts();
  }

  void add_residuals(const OrderedMesh& mesh, std::uint32_t group, std::uint32_t present) {
    const std::size_t size = gof.group_end[group] - (group > 0 ? gof.group_end[group - 1] : 0);
    std::vector<std::int32_t> residuals(size * mesh.num_vertices());
    const int bits = between(0, kResidualBits);
    const bool all = group == 0 && gof.rest.order_flag && present > 0;
    const std::uint32_t end = all ? mesh.num_layers() : layers_of(present);
    for (const std::uint32_t v : mesh.vertices_of_layers(0, end)) {
      for (std::size_t k = 0; k < size; ++k) residuals[v * size + k] = residual(bits);
    }
    gof.vertex_residual.push_back(std::move(residuals));
  }

  std::uint32_t layers_of(std::uint32_t groups) const {
    std::uint32_t sum = 0;
    for (std::uint32_t j = 0; j < groups; ++j) sum += gof.layer_group_size[j];
    return sum;
  }

  // Makes influences as a parser would; absent layers have predicted ones.
  void make_influences(const OrderedMesh& mesh) {
    gof.influences.assign(mesh.num_vertices(), {});
    const auto num_bones = static_cast<std::uint32_t>(gof.bones.size());
    InfluencePrediction prediction(gof.influences, num_bones, gof.weight_bits);
    const std::uint32_t present = layers_of(gof.slice_layers[0]);
    for (const std::uint32_t v : mesh.order()) {
      const bool is_coded = mesh.layer_of(v) < present;
      prediction.start(mesh.ring(v));
      while (is_coded && prediction.can_add_bone() && random() % 3 == 0) {
        const std::uint32_t bone = below(num_bones);
        const auto left = static_cast<std::uint32_t>(prediction.weight_left());
        if (prediction.is_new_bone(bone)) {
          prediction.add_extra_bone(bone, 1 + static_cast<int>(below(left)));
        }
      }
      for (std::size_t k = 1; k < prediction.num_candidates(); ++k) {
        const bool changes = is_coded && prediction.has_residual() && coin();
        prediction.add_candidate(k, changes ? between(-128, 128) : 0);
      }
      gof.influences[v] = prediction.finish();
    }
  }

  std::uint64_t state_;
};

}  // namespace rlpc
