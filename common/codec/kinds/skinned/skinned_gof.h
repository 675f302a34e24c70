// 6.11 to 6.13: skinned GOFs and shared rigs with their slices. Passed from the parser to
// reconstruction, and from the analysis to the writer.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/codec/components/component_limits.h"
#include "common/codec/components/track_order.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh/weight_settings.h"
#include "common/codec/rest/rest_shape.h"
#include "common/codec/syntax/gof_header.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::uint32_t kMaxRestStep = 1U << 16;
inline constexpr std::uint32_t kMaxComponentGroups = 255;
inline constexpr std::uint32_t kMaxRigs = 8;  // shared rigs at a time
inline constexpr int kMaxWeightBits = 7;
inline constexpr std::uint32_t kMaxStepIdx = 239;
inline constexpr int kStretchAxisBits = 16;
inline constexpr int kMaxInfluences = 8;
inline constexpr int kMaxExtraBones = 4;  // per vertex
inline constexpr int kMaxTemporalWeights = 3;
inline constexpr int kTemporalWeightOffset = 256;
// Largest value of temporal_predictor: orders, then 1 to kMaxTemporalWeights weights.
inline constexpr int kMaxTemporalPredictor = 7;

// stretch_idc (7.11.2): the axes along which a bone stretches.
enum class Stretch : std::uint8_t {
  kNone = 0,
  kRestAxes = 1,  // those of the rest shape
  kOwnAxes = 2,   // those that stretch_axes turn them to
};

// Residuals of a series of three coordinates, in steps; [num_gof_frames].
using TrackResiduals = Vector<Vec3i>;

struct Bone {
  std::int32_t parent = -1;  // index of an earlier bone; -1: root
  Vec3i pivot{};             // 1/16 grid units, signed, position_bits + 5 bits
  bool rotation_flag = false;
  std::uint32_t rotation_step_idx = 0;
  int rotation_order = 1;    // 1 to kMaxPredictorOrder
  int rotation_between = 0;  // 0 to kMaxBetween
  TrackResiduals rotation_residual;
  bool origin_flag = false;
  std::uint32_t origin_step_idx = 0;
  int origin_order = 0;    // 0 to kMaxPredictorOrder
  int origin_between = 0;  // 0 to kMaxBetween
  TrackResiduals origin_residual;
  Stretch stretch = Stretch::kNone;
  Vec3i stretch_axes{};  // vector part of a quaternion, 15 fractional bits; kOwnAxes
  std::uint32_t stretch_step_idx = 0;
  int stretch_order = 0;    // 0 to kMaxPredictorOrder
  int stretch_between = 0;  // 0 to kMaxBetween
  TrackResiduals stretch_residual;

  bool operator==(const Bone&) const = default;
};

struct Influence {
  std::uint16_t bone = 0;
  std::uint16_t weight = 0;  // above 0; the weights of a vertex sum to 2^weight_bits
  bool operator==(const Influence&) const = default;
};

// Influences of a vertex, at most kMaxInfluences, in coding order.
struct Influences {
  std::array<Influence, kMaxInfluences> list{};
  std::uint8_t size = 0;

  const Influence* begin() const { return list.data(); }
  const Influence* end() const { return list.data() + size; }
  bool operator==(const Influences& other) const {
    return std::equal(begin(), end(), other.begin(), other.end());
  }
};

struct Trajectory {
  int scale_idx = 0;
  int spatial_bits = 1;
  int temporal_bits = 1;
  int temporal_predictor = 0;  // 0 to kMaxTemporalPredictor
  int temporal_between = 0;    // 0 to kMaxBetween
  std::array<std::int16_t, kMaxTemporalWeights> temporal_weight{};  // 6 fractional bits
  TrackResiduals residual;
  bool trajectory_flag = true;  // false: does not occur in the GOF; no other element is coded

  bool operator==(const Trajectory&) const = default;
};

// 6.13: rig of a skinned GOF: all that depends on vertices. In a shared rig, bones and
// trajectories have no motion. Values of absent slices are zero; reconstruction then predicts
// the influences (8.14.1).
struct SharedRig {
  int fraction_bits = 0;
  int weight_bits = 0;
  std::uint32_t rest_step = 1;  // 1/16 grid units
  Prediction prediction = Prediction::kLayers;
  WeightSettings weights;
  bool stretch_flag = false;  // bones can stretch
  RestSettings rest;
  Vector<std::uint32_t> layer_group_size;  // [num_layer_groups] layers
  Vector<std::uint8_t> layer_step;         // [layer], 1 to kMaxLayerStep
  Vector<Bone> bones;
  std::uint32_t num_component_groups = 0;
  // [group]: end of each component group in the spatial factors; [0] is kRestFactors. Groups
  // without any slice are absent.
  Vector<std::size_t> group_end{kRestFactors};
  Vector<std::uint32_t> slice_layers;  // [group]: number of layer groups present
  Vector<Trajectory> trajectories;
  Vector<Influences> influences;  // [num_vertices]
  // [num_vertices]; empty without counterparts.
  Vector<Counterpart> counterparts;
  // [group][num_vertices * factors of the group]: residuals, in steps of the layer.
  Vector<Vector<std::int32_t>> vertex_residual;
  bool is_cut = false;  // slices were dropped on request (SliceCut)

  bool operator==(const SharedRig&) const = default;
};

struct SkinnedGof : GofHeader, SharedRig {
  SkinnedGof() { kind = GofKind::kSkinned; }

  int track_levels = 0;         // levels of hierarchical tracks above 0; 0 to kMaxTrackLevels
  int num_temporal_layers = 1;  // 1 to track_levels + 1
  // [group]: number of temporal layers after the first that have a slice; empty if the GOF has
  // none. Residuals of absent slices are zero.
  Vector<std::uint32_t> temporal_layers;
  // 6.13.1: the shared rig in use, which has all that depends on vertices; null for other
  // kinds. Settings, bones and leading trajectories of the GOF are then those of the rig, with
  // motion; slice_layers counts the component groups of both; group_end and vertex_residual are
  // those of the local component groups, with [0] as the end of the last group of the rig.
  std::shared_ptr<const SharedRig> rig;
  std::uint32_t rig_idx = 0;
  std::uint32_t num_local_groups = 0;

  bool operator==(const SkinnedGof&) const = default;
};

inline TrackFrames track_frames(const SkinnedGof& gof) {
  return {gof.num_frames, gof.track_levels, gof.num_temporal_layers};
}

// Range [first, end) of the declared spatial factors of a GOF or shared rig.
struct FactorGroup {
  std::size_t first = 0;
  std::size_t end = kRestFactors;
  std::size_t size() const { return end - first; }
};
inline FactorGroup factor_group(const SharedRig& rig, std::size_t group) {
  return {group == 0 ? 0 : rig.group_end[group - 1], rig.group_end[group]};
}

// 8.16.1: returns the count of a shared rig in FactorsOfRigs( ).
inline std::uint64_t num_factors(const SharedRig& rig) {
  return (kRestFactors + rig.trajectories.size()) * rig.influences.size();
}

}  // namespace rlpc
