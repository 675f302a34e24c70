// The choice of bones for one GOF of the Main profile, by Lagrangian cost on coded bits.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/coded_mesh.h"
#include "common/mesh/mesh.h"
#include "encoder/gof/gof_coder.h"
#include "encoder/gof/gof_frames.h"
#include "encoder/rlpc_encoder.h"
#include "encoder/skinned_gof/fit/bone_fit.h"
#include "encoder/skinned_gof/fit/rig.h"
#include "encoder/skinned_gof/quantise/skinned_gof_encoder.h"

namespace rlpc {

struct SkinnedContext {
  std::vector<CodedMesh> meshes;        // by Prediction
  std::span<const Triangle> triangles;  // decoded order
  int position_bits;
};

// What bones were looked for: so many, with vertices that follow so many; 0 of one.
struct BoneCounts {
  std::uint32_t bones = 0;
  std::uint32_t influences = 0;
};

// Bones and tools of a GOF, and the step that they were chosen for.
struct SkinnedChoice {
  Rig rig;
  BoneCounts counts;
  SkinnedSettings settings;
  double step = 0.0;
  int times = 0;  // that there was a choice

  // Whether others should be chosen for a step.
  bool is_far(double other) const {
    constexpr double kFar = 1.6;
    constexpr int kMostTimes = 3;
    return times < kMostTimes && (other > kFar * step || other * kFar < step);
  }
};

class SkinnedGofSearch : public GofCoder {
 public:
  // All but the number are kept by reference. choice: that of an earlier search of the same
  // GOF, or none; the first encode() makes it.
  SkinnedGofSearch(const SkinnedContext& context, const GofFrames& frames,
                   std::uint32_t first_frame, const EncoderSettings& settings,
                   std::optional<SkinnedChoice>& choice);

  void analyse(double analysis_step) override;
  std::optional<double> expected_error(double step) const override;
  bool needs_frames(double step, double analysis_step) const override;
  EncodedGof encode(double step, double analysis_step) override;

 private:
  struct Cached {
    double step;  // that it was made for
    SkinnedAnalysis analysis;
  };

  SkinnedAnalysis analyse(const SkinnedChoice& choice, double step) const;
  SkinnedGof code(const SkinnedAnalysis& analysis, const SkinnedSettings& settings,
                  double step) const;
  double cost(const SkinnedAnalysis& analysis, const SkinnedSettings& settings,
              double step) const;
  struct BoneEstimate {
    std::uint32_t count = 0;                                // bones
    double cost = std::numeric_limits<double>::infinity();  // expected
    double translation = 0.0;                               // the same without bones
    std::vector<double> costs;                              // the same of all numbers tried
  };

  BoneFit fit(std::size_t influences, double step) const;
  BoneFit quick_fit(std::size_t influences, double step) const;
  BoneEstimate estimate(std::size_t influences, double step) const;
  bool follows(double step) const;
  void analyse_for(double step);
  void choose_one_bone();
  double consider(Rig rig, const BoneCounts& counts);
  void consider(const SkinnedSettings& settings);
  void choose_bones();
  void choose_bones_near(const BoneCounts& counts, bool finer);
  bool can_have(std::uint32_t count) const;
  bool grow(BoneFit& fit, std::uint32_t count) const;
  void try_estimated_bones(std::uint32_t influences, const BoneEstimate& estimate,
                           double without);
  void try_bones(BoneFit& full, std::uint32_t influences, std::span<const std::uint32_t> counts,
                 std::uint32_t likely);
  void choose_prediction();
  void choose(double step);

  const SkinnedContext& context_;
  const GofFrames& frames_;
  std::uint32_t first_frame_;
  MainTools tools_;
  SkinnedSettings usual_;
  Preset preset_;
  double threshold_factor_;  // the higher, the less bones have to estimate to be tried
  std::uint32_t max_influences_;
  std::optional<SkinnedChoice>& choice_;
  std::optional<Cached> cached_;
  double least_ = 0.0;  // cost of the choice so far
};

}  // namespace rlpc
