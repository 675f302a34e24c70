// Analysis of a span of skinned GOFs: quantised bones, influences and rest positions, and the
// principal components of the residual of bone motion (inverse of clauses 8.10 to 8.13).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/codec/kinds/skinned/recon/bones.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/skinned/tracks/track_coding.h"
#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/rig.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

enum class Rounding : std::uint8_t {
  kCheapest,  // all residuals by rate and distortion
  kDeadZone,  // spatial residuals with a dead zone, the others by rate and distortion
  kNearest,   // all residuals to nearest, for a target of the maximum error
};

struct SkinnedSettings {
  Prediction prediction = Prediction::kLayers;
  int weight_bits = kWeightBits;
  int damping_log2 = kDampingLog2;
  int outer_weight = kOuterRing;
  int outer_scale = kOuterRing;
  std::uint32_t num_adaptive_factors = 0;   // maximum (8.15)
  RestTools rest = RestTools::kPrediction;  // tools allowed
  bool layer_steps = true;                  // finer steps in coarser layers
  int track_levels = 0;                     // 0: tracks are not hierarchical
  int temporal_layers = 1;                  // at most track_levels + 1
  bool temporal_weights = true;  // transmitted weights besides the fixed predictors of 8.2.2
  Rounding rounding = Rounding::kCheapest;
  bool draft = false;        // code tracks only as well as comparing candidates needs
  bool cobra_steps = false;  // temporal steps of Vasa and Skala 2009; else equal distortion
  std::uint32_t component_groups = 0;     // 0: chosen by size
  std::uint32_t layer_groups = 0;         // 0: chosen by size
  std::vector<std::uint32_t> layer_cuts;  // EncoderSettings::main
  std::size_t max_trajectories = 1024;
  std::size_t min_trajectories = 0;  // coded even if they are not worth their bits

  // tuned: Bits of a quantised influence of a bone. Finer weights cost bits at every vertex;
  // coarser ones leave errors where bones meet.
  static constexpr int kWeightBits = 6;
  // tuned (off: 0): Binary logarithm of the divisor that sets the damping of the geometry
  // weights (8.11): the larger, the less damping; 0 switches these weights off. Damping keeps
  // weights moderate where a vertex lies nearly in line with its neighbours.
  static constexpr int kDampingLog2 = 8;
  // tuned (off: 0): Weight and scale of the outer ring in the geometry weights (8.11). The
  // outer ring adds curvature to the prediction.
  static constexpr int kOuterRing = 3;
};

TrackOptions track_options(const SkinnedSettings& settings);

struct SkinnedAnalysis {
  SharedRig rig;  // no trajectories or geometry weights; bones without motion
  // The GOFs of the span, with their bones; without trajectories.
  std::vector<SkinnedGof> gofs;
  std::vector<BoneMotion> bones;                  // decoded values, in all frames
  std::array<std::vector<std::int32_t>, 3> rest;  // decoded values
  ComponentsByRow pc;
  double step_of_components = 0.0;  // step of the analysis that found the components
  std::vector<float> spatial_left;  // find_spatial_left()
};

// Chooses all steps so that every coded value adds about the same squared error, step^2 / 12,
// to the sum over all coordinates of all frames. step: grid units.
//
//   before  an analysis of the same rig with other tools, for the same step or one nearby, or
//           null: its principal components and, in a draft, its bones are copied
SkinnedAnalysis analyse_skinned_gof(const OrderedMesh& mesh, int position_bits,
                                    const SpanFrames& frames, const Rig& rig,
                                    const SkinnedSettings& settings, double step,
                                    const SkinnedAnalysis* before = nullptr);

}  // namespace rlpc
