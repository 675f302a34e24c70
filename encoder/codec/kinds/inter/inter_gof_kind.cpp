#include "encoder/codec/kinds/inter/inter_gof_kind.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "encoder/codec/kinds/inter/inter_sample.h"
#include "encoder/codec/kinds/inter/inter_trial.h"
#include "encoder/codec/kinds/inter/pattern_search.h"
#include "encoder/codec/kinds/inter/trial_maker.h"
#include "encoder/codec/spans/split_coder.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {
namespace {

// tuned (off: 0): Estimates above the rival by less than this factor may be wrong: at the
// border of a region, vertices have fewer neighbours than in the mesh.
constexpr double kMargin = 1.4;
// tuned (off: 0): A sample with this many times as many vertices is asked then, if it is a
// small part of the mesh.
constexpr std::uint32_t kLarger = 4;
// tuned (off: 0): Its estimates above the rival by less than this factor may be wrong.
constexpr double kLargerMargin = 1.0;

// Choices at a step hold for all steps within kAnalysisServes.
class InterSpanCoder : public SpanCoder {
 public:
  InterSpanCoder(const SequenceMesh& mesh, const OrderedMesh& layers,
                 const EncoderSettings& settings, const SpanFrames& frames)
      : mesh_(mesh),
        settings_(settings),
        frames_(frames),
        maker_(mesh, layers, settings, frames, frames.num_frames) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  void release_analysis() override {}
  EncodedSpan encode(double step, double /*analysis_step*/) override;
  std::optional<double> step_in_reach(double step, const SpanCost& rival) override;

 private:
  void choose(double step, const StartTrial& start);
  InterSample& sample();

  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  const SpanFrames& frames_;
  TrialMaker maker_;
  std::unique_ptr<InterSample> sample_;
  std::vector<InterChoice> choices_;  // still to be compared
  double chosen_at_ = 0.0;            // step at which choices were made
};

EncodedSpan InterSpanCoder::encode(double step, double /*analysis_step*/) {
  const Stage stage("inter GOFs");
  const StartTrial start = [&](const InterChoice& choice) {
    return maker_.start(choice, step);
  };
  maker_.forget_first_frames();
  if (choices_.empty() || !is_within(kAnalysisServes, step, chosen_at_)) {
    chosen_at_ = step;
    choose(step, start);
  }
  EncodedSpan encoded = cheapest(choices_, frames_.num_frames, start)->finish();
  choices_ = encoded.choices;
  return encoded;
}

// Chooses the number of patches first; patterns are then compared with it. If that takes long,
// a sample chooses the pattern, and some frames the number of patches.
void InterSpanCoder::choose(double step, const StartTrial& start) {
  const bool is_open_ended = mesh_.header.open_end_flag;
  const std::uint32_t num_frames = frames_.num_frames;
  const auto numbers = patches_of(settings_, is_open_ended, num_frames);
  auto patterns = patterns_of(settings_, is_open_ended, num_frames);
  std::uint32_t patches = numbers.front();
  if (settings_.preset != Preset::kSlow && InterSample::saves_time(frames_.num_vertices)) {
    const auto compared = choices_of_patches({patterns.front()}, numbers);
    patches = cheapest_at_start(compared, num_frames, start).num_patches;
    if (patterns.size() > 1) patterns = {sample().cheapest_pattern(step)};
  } else if (numbers.size() > 1) {
    const auto compared = choices_of_patches(patterns, numbers);
    patches = cheapest(compared, num_frames, start)->choice().num_patches;
  }
  choices_.clear();
  for (const FramePattern& pattern : patterns) choices_.push_back({pattern, patches});
}

std::optional<double> InterSpanCoder::step_in_reach(double step, const SpanCost& rival) {
  const Stage stage("inter GOFs");
  auto found = sample().cheapest_choice(step, rival, kMargin);
  if (!found) return std::nullopt;
  const std::uint32_t larger = kLarger * sample().num_vertices();
  if (frames_.num_vertices > 2 * larger) {
    InterSample large(mesh_, settings_, frames_, larger);
    found = large.estimate(found->choice, step, rival);
    if (found->ratio > kLargerMargin) return std::nullopt;
  }
  return step * found->choice.step_scale;
}

// Returns the sample, which is made once.
InterSample& InterSpanCoder::sample() {
  if (!sample_) {
    const std::uint32_t count = InterSample::usual_vertices(frames_.num_frames);
    sample_ = std::make_unique<InterSample>(mesh_, settings_, frames_, count);
  }
  return *sample_;
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
