#include "encoder/codec/kinds/inter/trial_maker.h"

#include <cstddef>
#include <limits>
#include <span>

#include "encoder/codec/kinds/inter/first_frame.h"

namespace rlpc {
namespace {

// fixed: A unit costs some 13 bytes besides its residuals, 0.3 % of this.
constexpr std::size_t kUnitBytes = 4096;

UnitLimits unit_limits(const EncoderSettings& settings) {
  constexpr auto kAny = std::numeric_limits<std::uint32_t>::max();
  const auto& frames = settings.inter.frames_per_unit;
  return frames ? UnitLimits{*frames, kAny} : UnitLimits{kAny, kUnitBytes};
}

}  // namespace

std::unique_ptr<InterTrial> TrialMaker::start(const InterChoice& choice, double step) {
  InterSettings chosen = choose_frame_settings(mesh_.header, settings_, layers_, choice.pattern,
                                               step * choice.step_scale);
  set_patches(chosen, patches(choice.num_patches));
  return std::make_unique<InterTrial>(
      layers_, mesh_.header, frames_, chosen, unit_limits(settings_), choice,
      residual_rule(settings_, choice.pattern), num_frames_, first_frame(chosen));
}

const PatchOfVertex& TrialMaker::patches(std::uint32_t count) {
  PatchOfVertex& patches = patches_[count];
  if (patches.empty()) {
    patches = divide_into_patches(mesh_.header, settings_, frames_, mesh_.triangles, count);
  }
  return patches;
}

std::shared_ptr<const RestEncoding> TrialMaker::first_frame(const InterSettings& chosen) {
  const auto found = first_frames_.find(chosen.first_step);
  if (found != first_frames_.end()) return found->second;
  const auto xyz = std::span(frames_.xyz).first(3 * std::size_t{frames_.num_vertices});
  return first_frames_[chosen.first_step] =
             code_first_frame(layers_, chosen, mesh_.header, settings_, xyz);
}

}  // namespace rlpc
