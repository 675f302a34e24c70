#include "encoder/codec/kinds/inter/inter_gof_kind.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "encoder/codec/kinds/inter/first_frame.h"
#include "encoder/codec/kinds/inter/inter_settings.h"
#include "encoder/codec/kinds/inter/inter_trial.h"
#include "encoder/codec/kinds/inter/pattern_search.h"
#include "encoder/codec/spans/split_coder.h"

namespace rlpc {
namespace {

// tuned (off: 1): Inter GOFs are tried where trajectories number at least this fraction of
// their maximum. Below, trajectories of all frames are the better basis.
constexpr double kManyTrajectories = 0.3;

// fixed: A unit costs some 13 bytes besides its residuals, 0.3 % of this.
constexpr std::size_t kUnitBytes = 4096;

UnitLimits unit_limits(const EncoderSettings& settings) {
  constexpr auto kAny = std::numeric_limits<std::uint32_t>::max();
  const auto& frames = settings.inter.frames_per_unit;
  return frames ? UnitLimits{*frames, kAny} : UnitLimits{kAny, kUnitBytes};
}

// Choices at a step hold for all steps within kAnalysisServes.
class InterSpanCoder : public SpanCoder {
 public:
  InterSpanCoder(const SequenceMesh& mesh, const OrderedMesh& layers,
                 const EncoderSettings& settings, const SpanFrames& frames)
      : mesh_(mesh), layers_(layers), settings_(settings), frames_(frames) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  void release_analysis() override {}
  EncodedSpan encode(double step, double /*analysis_step*/) override;

 private:
  const SequenceMesh& mesh_;
  const OrderedMesh& layers_;
  const EncoderSettings& settings_;
  const SpanFrames& frames_;
  void choose(const StartTrial& start);
  const PatchOfVertex& patches(std::uint32_t count);
  std::shared_ptr<const RestEncoding> first_frame(const InterSettings& chosen);

  std::vector<InterChoice> choices_;                // still to be compared
  std::map<std::uint32_t, PatchOfVertex> patches_;  // [number of patches]
  double chosen_at_ = 0.0;                          // step at which choices were made
  // [step of depth 0], for one call of encode().
  std::map<std::uint32_t, std::shared_ptr<const RestEncoding>> first_frames_;
};

EncodedSpan InterSpanCoder::encode(double step, double /*analysis_step*/) {
  const StartTrial start = [&](const InterChoice& choice) {
    InterSettings chosen = choose_frame_settings(mesh_.header, settings_, layers_,
                                                 choice.pattern, step * choice.step_scale);
    set_patches(chosen, patches(choice.num_patches));
    return std::make_unique<InterTrial>(layers_, mesh_.header, frames_, chosen,
                                        unit_limits(settings_), choice, first_frame(chosen));
  };
  first_frames_.clear();
  if (choices_.empty() || !is_within(kAnalysisServes, step, chosen_at_)) {
    chosen_at_ = step;
    choose(start);
  }
  EncodedSpan encoded = cheapest(choices_, frames_.num_frames, start)->finish();
  choices_ = encoded.choices;
  return encoded;
}

// Chooses the number of patches first; patterns are then compared with it.
void InterSpanCoder::choose(const StartTrial& start) {
  const bool is_open_ended = mesh_.header.open_end_flag;
  const auto patterns = patterns_of(settings_, is_open_ended, frames_.num_frames);
  const auto numbers =
      choices_of_patches(patterns, patches_of(settings_, is_open_ended, frames_.num_frames));
  const std::uint32_t patches =
      numbers.size() > 1 ? cheapest(numbers, frames_.num_frames, start)->choice().num_patches
                         : numbers.front().num_patches;
  choices_.clear();
  for (const FramePattern& pattern : patterns) choices_.push_back({pattern, patches});
}

const PatchOfVertex& InterSpanCoder::patches(std::uint32_t count) {
  PatchOfVertex& patches = patches_[count];
  if (patches.empty()) {
    patches = divide_into_patches(mesh_.header, settings_, frames_, mesh_.triangles, count);
  }
  return patches;
}

std::shared_ptr<const RestEncoding> InterSpanCoder::first_frame(const InterSettings& chosen) {
  const auto found = first_frames_.find(chosen.step[0]);
  if (found != first_frames_.end()) return found->second;
  const auto xyz = std::span(frames_.xyz).first(3 * std::size_t{frames_.num_vertices});
  return first_frames_[chosen.step[0]] =
             code_first_frame(layers_, chosen, mesh_.header, settings_, xyz);
}

class InterGofKind : public KindEncoder {
 public:
  InterGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : mesh_(mesh), settings_(settings), meshes_(mesh.topology, mesh.triangles, true) {}

  std::unique_ptr<SpanCoder> make_coder(const SpanFrames& frames) const override {
    if (frames.num_gofs > 1) {
      return std::make_unique<SplitCoder>(
          frames, [this](const SpanFrames& gof_frames) { return make_coder(gof_frames); });
    }
    return std::make_unique<InterSpanCoder>(mesh_, meshes_[Prediction::kLayers], settings_,
                                            frames);
  }

  bool may_win(const SpanFrames& frames, std::uint32_t components) const override {
    return components >=
           kManyTrajectories * std::min(frames.num_vertices, 3 * frames.num_frames);
  }

 private:
  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  OrderedMeshes meshes_;
};

}  // namespace

std::unique_ptr<KindEncoder> make_inter_gof_kind(const SequenceMesh& mesh,
                                                 const EncoderSettings& settings) {
  if (settings.profile != Profile::kHigh) return nullptr;
  const bool is_wanted = settings.usable_kind() == GofKind::kInter;
  const bool is_compared = !settings.usable_kind() && settings.preset != Preset::kFast &&
                           settings.main == MainTools{};
  if (!is_wanted && !is_compared) return nullptr;
  return std::make_unique<InterGofKind>(mesh, settings);
}

}  // namespace rlpc
