// Analysis of one GOF of the Main profile: bones, influences and rest positions, quantised, and
// the principal components of what they leave (clauses 8.10 to 8.13 backwards).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/recon/bones.h"
#include "common/skinned_gof/skinned_gof.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/math/principal_components.h"
#include "encoder/skinned_gof/fit/rig.h"

namespace rlpc {

enum class Rounding : std::uint8_t {
  kCheapest,  // by rate and distortion
  kDeadZone,  // of spatial residuals; others likewise by rate and distortion
  kNearest,   // where the largest error counts
};

struct SkinnedSettings {
  Prediction prediction = Prediction::kLayers;
  int weight_bits = kWeightBits;
  int damping_log2 = kDampingLog2;
  int outer_weight = kOuterRing;
  int outer_scale = kOuterRing;
  bool layer_steps = true;       // finer steps in coarser layers
  bool temporal_weights = true;  // not only the orders of 8.2.2
  Rounding rounding = Rounding::kCheapest;
  bool cobra_steps = false;            // of temporal values; else of equal distortion
  std::uint32_t component_groups = 0;  // 0: as many as suit
  std::uint32_t layer_groups = 0;
  std::size_t max_trajectories = 1024;

  static constexpr int kWeightBits = 6;   // tuned: of an influence
  static constexpr int kDampingLog2 = 8;  // tuned (off: 0): of geometry weights
  static constexpr int kOuterRing = 3;    // tuned (off: 0): weight and scale of the outer ring
};

// Bones, influences and rest positions of a GOF, quantised, and the principal components of
// what they leave of the motion.
struct SkinnedAnalysis {
  SkinnedGof gof;  // without trajectories and geometry weights
  std::vector<BoneMotion> bones;
  std::array<std::vector<std::int32_t>, 3> rest;  // as decoded
  ComponentsByRow pc;
};

// Every coded value adds about the same squared error, step^2 / 12, to the sum over all
// coordinates of all frames.
SkinnedAnalysis analyse_skinned_gof(const CodedMesh& mesh, int position_bits,
                                    const GofFrames& frames, const Rig& rig,
                                    const SkinnedSettings& settings, double step);

// Energy below which a trajectory costs more than it saves, whatever its temporal vector costs.
double least_energy(double step, std::uint32_t num_vertices);

}  // namespace rlpc
