// Models and contexts of the motion of patches (clause 9.8.7). The parser and the writer drive
// them in the same way.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "common/codec/bits/bit_model.h"
#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/inter/patch_motion.h"
#include "common/memory/owned.h"

namespace rlpc {

class PatchContexts {
 public:
  // num_depths: depths of the pattern.
  PatchContexts(std::size_t num_patches, std::uint32_t num_depths)
      : states_(num_depths, State(num_patches)) {}

  // Starts a frame that is not the first and repeats no other, with its depth.
  void start_frame(std::uint32_t depth) { depth_ = depth; }
  // Starts a patch, in order; its mode and the residuals of that mode follow.
  void start(std::size_t patch) { patch_ = patch; }

  std::array<BitModel, kPatchModes - 1>& mode_models() {
    return state().mode_models[static_cast<std::size_t>(patch().mode)];
  }
  void set_mode(PatchMode mode) { patch().mode = mode; }

  // Return the expected magnitude of residual i of the motion, with 4 fractional bits, and its
  // models.
  std::uint32_t expected(std::size_t i) const {
    const State& state = states_[depth_];
    return (state.mean[kind(i)] + state.patches[patch_].mean[kind(i)]) >> 5;
  }
  ResidualModels& models(std::size_t i) { return state().residual_models[kind(i)]; }
  // Adapts to a residual. The rates, 5 and 2, matter little: on cesium-man, dembones and
  // q-trex, neighbouring rates change bytes by no more than the search for the target error, 2
  // %; so do half and twice the first mean.
  void update(std::size_t i, std::int32_t residual) {
    const std::uint32_t magnitude = magnitude_of(residual);
    std::uint32_t& overall = state().mean[kind(i)];
    std::uint32_t& own = patch().mean[kind(i)];
    overall = update_mean(overall, magnitude, 5);
    own = update_mean(own, magnitude, 2);
  }

  // State that update() changes, for encoders that try a motion.
  struct Means {
    std::array<std::uint32_t, 2> overall{};
    std::array<std::uint32_t, 2> own{};
  };
  Means means() const { return {states_[depth_].mean, states_[depth_].patches[patch_].mean}; }
  void set_means(const Means& means) {
    state().mean = means.overall;
    patch().mean = means.own;
  }

 private:
  static constexpr std::uint32_t kFirstMean = 1024;

  struct Patch {
    PatchMode mode = PatchMode::kNeighbours;                    // mode in the previous frame
    std::array<std::uint32_t, 2> mean{kFirstMean, kFirstMean};  // means of offset and matrix
  };
  struct State {
    explicit State(std::size_t num_patches) : patches(num_patches) {}
    Vector<Patch> patches;
    std::array<std::array<BitModel, kPatchModes - 1>, kPatchModes> mode_models;
    std::array<ResidualModels, 2> residual_models;
    std::array<std::uint32_t, 2> mean{kFirstMean, kFirstMean};
  };

  State& state() { return states_[depth_]; }
  Patch& patch() { return state().patches[patch_]; }
  static std::size_t kind(std::size_t i) { return i < kOffsetValues ? 0 : 1; }

  Vector<State> states_;  // [depth]
  std::uint32_t depth_ = 0;
  std::size_t patch_ = 0;
};

}  // namespace rlpc
