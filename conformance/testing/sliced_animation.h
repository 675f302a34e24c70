// Small streams of the Main profile with all of its syntax, for tests that decode thousands of
// times. The encoder would not write them: their residuals are noise.
#pragma once

#include <algorithm>
#include <cstdint>
#include <random>
#include <variant>
#include <vector>

#include "common/codec/kinds/cluster/recon/cluster_recon.h"
#include "common/codec/kinds/skinned/recon/skinned_recon.h"
#include "common/codec/mesh/topology.h"
#include "conformance/testing/small_animation.h"
#include "encoder/codec/write/write_cluster_gof.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/codec/write/write_skinned_gof.h"
#include "encoder/codec/write/write_stream.h"

namespace rlpc {

class SlicedAnimation {
 public:
  SlicedAnimation()
      : code_(write_connectivity(kVertices, tube())),
        topology_(make_topology(kVertices, code_.triangles)),
        layers_(make_layers(kVertices, code_.triangles)) {
    header_.profile_idc = kProfileMain;
    header_.num_vertices = kVertices;
    header_.num_triangles = static_cast<std::uint32_t>(code_.triangles.size());
    header_.position_bits = 12;
  }

  // Has two GOFs: one with vertex layers, two layer groups and two component groups; one with
  // parallelograms and an absent slice.
  StreamBytes stream() {
    SkinnedGof cut = gof(kGofFrames, Prediction::kParallelogram);
    cut.slice_layers = {1, 1, 0};
    return stream_of({gof(0, Prediction::kLayers), cut});
  }
  // Has a bone that moves no vertex, and a trajectory that is zero.
  StreamBytes idle_stream() {
    SkinnedGof idle = gof(kGofFrames, Prediction::kNone);
    idle.bones.push_back(bone(3));
    for (Vec3i& residual : idle.trajectories.back().residual) residual = {};
    return stream_of({gof(0, Prediction::kParallelograms), idle});
  }
  // Has cluster GOFs and skinned GOFs in turn.
  StreamBytes mixed_stream() {
    std::vector<OneGof> gofs;
    for (std::uint32_t g = 0; g < 7; ++g) {
      if (g % 2 == 0) {
        gofs.emplace_back(clusters(g * kGofFrames));
      } else {
        gofs.emplace_back(gof(g * kGofFrames, Prediction::kLayers));
      }
    }
    return stream_of(gofs);
  }

 protected:
  static constexpr std::uint32_t kRings = 4;
  static constexpr std::uint32_t kVertices = 5 * kRings;
  static constexpr std::uint32_t kGofFrames = 2;
  static constexpr std::uint32_t kGroups = 2;
  using OneGof = std::variant<ClusterGof, SkinnedGof>;

  StreamBytes stream_of(const std::vector<OneGof>& gofs) {
    StreamBytes bytes = lead(static_cast<std::uint32_t>(gofs.size()));
    for (const OneGof& any : gofs) {
      std::visit([&](const auto& gof) { append_gof(bytes, gof); }, any);
    }
    append(bytes, UnitType::kEndOfSequence, write_end_of_sequence(0));
    return bytes;
  }
  // The units before the first GOF.
  StreamBytes lead(std::uint32_t num_gofs) {
    header_.num_frames = num_gofs * kGofFrames;
    StreamBytes bytes = write_stream_header(header_.profile_idc);
    append(bytes, UnitType::kSequenceHeader, write_sequence_header(header_));
    append(bytes, UnitType::kConnectivity, code_.payload);
    return bytes;
  }
  static std::vector<Triangle> tube() { return bending_tube(kRings, 1).triangles(); }
  static void append(StreamBytes& bytes, UnitType type, const Bytes& payload) {
    const Bytes unit = write_unit(type, payload);
    bytes.insert(bytes.end(), unit.begin(), unit.end());
  }
  std::int32_t number(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(random_() % static_cast<unsigned>(high - low + 1));
  }
  TrackResiduals track() {
    TrackResiduals residuals(kGofFrames);
    for (Vec3i& residual : residuals) {
      for (std::int32_t& x : residual) x = number(-3, 3);
    }
    return residuals;
  }

  // A cluster with a local frame, and one without.
  ClusterGof clusters(std::uint32_t first_frame) {
    ClusterGof gof;
    gof.first_frame = first_frame;
    gof.num_frames = kGofFrames;
    gof.fraction_bits = 4;
    gof.seed_step = 30;
    gof.clusters.resize(2);
    gof.clusters[0].lcf_flag = true;
    gof.clusters[0].seed_vertex = {0, 7, 13};
    gof.cluster_of_vertex.assign(kVertices, 1);
    std::fill_n(gof.cluster_of_vertex.begin(), kVertices / 2, std::uint16_t{0});
    for (const std::uint32_t v : gof.clusters[0].seed_vertex) {
      gof.cluster_of_vertex[v] = kSeedCluster;
      gof.seed_tracks.push_back({v, 0, track()});
    }
    const ClusterMembers members = cluster_members(gof);
    for (std::size_t i = 0; i < 2; ++i) {
      Component component;
      component.scale_idx = 60;
      component.spatial_bits = 9;
      component.temporal_bits = 12;
      component.temporal_predictor = 1;
      component.spatial_predictor = SpatialPredictor::kParallelogram;
      component.temporal_residual.assign(kGofFrames, number(100, 300));
      component.spatial_residual.resize(3 * members.vertices[i].size());
      for (std::int32_t& x : component.spatial_residual) x = number(-30, 30);
      gof.clusters[i].components.push_back(component);
    }
    return gof;
  }
  SkinnedGof gof(std::uint32_t first_frame, Prediction prediction) {
    SkinnedGof gof;
    gof.first_frame = first_frame;
    gof.num_frames = kGofFrames;
    gof.fraction_bits = 3;
    gof.weight_bits = 4;
    gof.rest_step = 20;
    gof.prediction = prediction;
    gof.bones.resize(3);
    for (std::size_t b = 0; b < gof.bones.size(); ++b) gof.bones[b] = bone(b);
    gof.num_component_groups = kGroups;
    gof.layer_group_size = {1};
    gof.layer_step = {16};
    if (prediction == Prediction::kLayers) {
      gof.weights.damping_log2 = 5;
      gof.weights.outer_weight = gof.weights.outer_scale = 3;
      gof.layer_group_size = {1, layers_.num_layers - 1};
      gof.layer_step.assign(layers_.num_layers, 12);
    }
    const auto layer_groups = static_cast<std::uint32_t>(gof.layer_group_size.size());
    gof.slice_layers.assign(kGroups + 1, layer_groups);
    gof.influences.resize(kVertices);
    for (Influences& influences : gof.influences) {
      const auto weight = static_cast<std::uint16_t>(number(1, 15));
      const auto first = static_cast<std::uint16_t>(number(0, 2));
      influences.list[0] = {first, weight};
      influences.list[1] = {static_cast<std::uint16_t>((first + 1) % 3),
                            static_cast<std::uint16_t>(16 - weight)};
      influences.size = 2;
    }
    gof.vertex_residual.push_back(vertex_residuals(kRestFactors, 60));
    for (std::size_t group = 1; group <= kGroups; ++group) {
      for (std::size_t l = 0; l < group; ++l) gof.trajectories.push_back(trajectory(5 * group));
      gof.group_end.push_back(kRestFactors + gof.trajectories.size());
      gof.vertex_residual.push_back(vertex_residuals(group, 4));
    }
    return gof;
  }
  Bone bone(std::size_t b) {
    Bone bone;
    bone.parent = static_cast<std::int32_t>(b) - 1;
    bone.pivot = {number(-900, 900), number(-900, 900), 0};
    bone.rotation_flag = b != 1;
    bone.origin_flag = b != 2;
    bone.rotation_step_idx = 200;
    bone.origin_step_idx = 20;
    if (bone.rotation_flag) bone.rotation_residual = track();
    if (bone.origin_flag) bone.origin_residual = track();
    return bone;
  }
  Trajectory trajectory(std::size_t temporal_predictor) {
    Trajectory trajectory;
    trajectory.scale_idx = 60;
    trajectory.spatial_bits = 9;
    trajectory.temporal_bits = 12;
    trajectory.temporal_predictor = static_cast<int>(temporal_predictor % 8);
    trajectory.temporal_weight = {50, -7, 3};
    trajectory.residual = track();
    return trajectory;
  }
  std::vector<std::int32_t> vertex_residuals(std::size_t factors, std::int32_t max) {
    std::vector<std::int32_t> residuals(factors * kVertices);
    for (std::int32_t& x : residuals) x = number(-max, max);
    return residuals;
  }

  // Appends the GOF unit, its slices, and the hash of each frame.
  void append_gof(StreamBytes& bytes, const SkinnedGof& gof) const {
    const OrderedMesh mesh(gof.prediction, topology_, layers_);
    const SkinnedGofPayloads payloads = write_skinned_gof(gof, mesh, header_);
    append(bytes, UnitType::kGof, payloads.first);
    for (const Bytes& slice : payloads.slices) append(bytes, UnitType::kSlice, slice);
    append(bytes, UnitType::kGofHash, write_gof_hash(hashes(mesh, gof), true));
  }
  void append_gof(StreamBytes& bytes, const ClusterGof& gof) const {
    append(bytes, UnitType::kGof, write_cluster_gof(gof, header_, topology_));
    const ClusterRecon recon(header_, topology_, gof);
    append(bytes, UnitType::kGofHash, write_gof_hash(hashes(recon), true));
  }
  // Returns the hashes of the GOF as decoded, without trajectories of groups with absent
  // slices.
  std::vector<std::uint32_t> hashes(const OrderedMesh& mesh, SkinnedGof gof) const {
    while (gof.slice_layers[gof.group_end.size() - 1] == 0) {
      gof.group_end.pop_back();
      gof.vertex_residual.pop_back();
    }
    gof.trajectories.resize(gof.group_end.back() - kRestFactors);
    return hashes(SkinnedRecon(mesh, gof, header_.position_bits));
  }
  template <class Recon>
  static std::vector<std::uint32_t> hashes(const Recon& recon) {
    std::vector<std::uint32_t> crcs;
    std::vector<std::int32_t> positions(std::size_t{3} * kVertices);
    for (std::uint32_t f = 0; f < kGofFrames; ++f) {
      recon.frame(f, positions);
      crcs.push_back(crc32_of_positions(positions));
    }
    return crcs;
  }

  std::mt19937 random_{1};
  ConnectivityCode code_;
  Topology topology_;
  VertexLayers layers_;
  SequenceHeader header_;
};

inline StreamBytes sliced_stream() { return SlicedAnimation().stream(); }
inline StreamBytes mixed_stream() { return SlicedAnimation().mixed_stream(); }

}  // namespace rlpc
