// The choice of bones for one GOF of the Main profile, by Lagrangian cost on coded bits.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/coded_mesh.h"
#include "common/mesh.h"
#include "encoder/bone_fit.h"
#include "encoder/bone_gof_encoder.h"
#include "encoder/gof_coder.h"
#include "encoder/gof_frames.h"
#include "encoder/rig.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

struct BoneContext {
  const CodedMesh& mesh;
  std::span<const Triangle> triangles;  // decoded order
  int position_bits;
};

// The bones of a GOF, and the step that they were chosen for.
struct RigChoice {
  Rig rig;
  double step;
  int times = 1;  // that bones have been chosen

  // Whether others should be chosen for a step.
  bool is_far(double other) const {
    constexpr double kFar = 1.6;
    constexpr int kMostTimes = 3;
    return times < kMostTimes && (other > kFar * step || other * kFar < step);
  }
};

class BoneGofSearch : public GofCoder {
 public:
  // All but the number are kept by reference. choice: that of an earlier search of the same
  // GOF, or none; the first encode() makes it.
  BoneGofSearch(const BoneContext& context, const GofFrames& frames, std::uint32_t first_frame,
                const EncoderSettings& settings, std::optional<RigChoice>& choice);

  EncodedGof encode(double step, double analysis_step) override;

 private:
  struct Cached {
    double step;  // that it was made for
    BoneAnalysis analysis;
  };

  BoneAnalysis analyse(const Rig& rig, double step) const;
  double cost(const BoneAnalysis& analysis, double step) const;
  struct Promise {
    std::uint32_t count = 0;  // bones
    double part = 2.0;        // expected cost, of that without bones
  };

  BoneFit fit(std::size_t influences, double step) const;
  BoneFit quick_fit(std::size_t influences, double step) const;
  Promise promise(std::size_t influences, double step) const;
  Rig quick_choice(double step) const;
  double consider(Rig rig, double step, double& least);
  void choose(double step);

  const BoneContext& context_;
  const GofFrames& frames_;
  std::uint32_t first_frame_;
  BoneSettings settings_;
  Preset preset_;
  std::uint32_t bones_;  // 0: chosen
  std::uint32_t max_influences_;
  std::optional<RigChoice>& choice_;
  std::optional<Cached> cached_;
};

}  // namespace rlpc
