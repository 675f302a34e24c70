#include "encoder/codec/kinds/inter/inter_sample.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/kinds/inter/pattern_search.h"
#include "encoder/codec/spans/lagrangian.h"

namespace rlpc {
namespace {

// tuned: Frames of a sample. They hold a whole period of the longest pattern.
constexpr std::uint32_t kWindow = 65;
// tuned: Vertices of a sample with kWindow frames; more if there are fewer frames.
constexpr std::uint32_t kVertices = 1800;
// tuned: Maximum number of vertices of a sample, unless more are asked for.
constexpr std::uint32_t kMaxVertices = 2500;

// tuned (off: 0): Other patterns, patches or the remaining frames save at most this factor.
constexpr double kOthers = 1.25;

std::uint32_t window_of(std::uint32_t num_frames) { return std::min(num_frames, kWindow); }

// Returns how many patches of the size of `count` in `of` vertices a mesh has; 0 only for 0.
std::uint32_t scaled_patches(std::uint32_t count, std::uint32_t num_vertices,
                             std::uint32_t of) {
  const auto scaled = std::uint64_t{count} * num_vertices / of;
  return static_cast<std::uint32_t>(std::max<std::uint64_t>(scaled, count > 0 ? 1 : 0));
}

// Returns settings that code the first frame of a sample by the usual weights.
EncoderSettings settings_of_sample(EncoderSettings settings) {
  settings.preset = Preset::kFast;
  settings.inter.rest =
      std::min(settings.inter.rest.value_or(RestTools::kOrder), RestTools::kOrder);
  return settings;
}

}  // namespace

InterSample::InterSample(const SequenceMesh& mesh, const EncoderSettings& settings,
                         const SpanFrames& frames, std::uint32_t max_vertices)
    : num_vertices_(frames.num_vertices),
      num_frames_(frames.num_frames),
      window_{(num_frames_ - window_of(num_frames_)) / 2, window_of(num_frames_)},
      sample_(
          sample_mesh(frames, mesh.triangles, sample_size(frames.num_vertices, max_vertices))),
      frames_(sample_.frames_of(frames, window_)),
      patterns_(patterns_of(settings, mesh.header.open_end_flag, frames.num_frames)),
      patches_(patches_of(settings, mesh.header.open_end_flag, frames.num_frames)),
      settings_(settings_of_sample(settings)),
      topology_(make_topology(frames_.num_vertices, sample_.triangles)),
      meshes_(topology_, sample_.triangles, true),
      mesh_{mesh.header, topology_, sample_.triangles},
      maker_(mesh_, meshes_[Prediction::kLayers], settings_, frames_, num_frames_) {}

bool InterSample::saves_time(std::uint32_t num_vertices) {
  return num_vertices > 2 * kSmallestSample;
}

std::uint32_t InterSample::usual_vertices(std::uint32_t num_frames) {
  return std::min(kVertices * kWindow / window_of(num_frames), kMaxVertices);
}

// Returns the expected cost of the whole GOF.
SpanCost InterSample::whole(const InterTrial& trial) const {
  SpanCost cost = trial.expected(num_frames_);
  const double scale = static_cast<double>(num_vertices_) / frames_.num_vertices;
  cost.bits *= scale;
  cost.squared_error *= scale;
  return cost;
}

// Codes the window, but ends as soon as the trial clearly needs too much.
bool InterSample::is_far_off(InterTrial& trial, const SpanCost& rival, double limit) const {
  for (std::uint32_t part = 4; part > 0; part /= 2) {
    trial.code_to(1 + (window_.count - 1 + part - 1) / part);
    if (ratio_at_equal_error(whole(trial), rival) > limit * kOthers) return true;
  }
  return false;
}

InterSample::Estimate InterSample::at_equal_error(std::unique_ptr<InterTrial> trial,
                                                  double step, const SpanCost& rival) {
  InterChoice choice = trial->choice();
  const double scale = scale_to(rival.squared_error, whole(*trial).squared_error);
  if (scale != 1.0) {
    choice.step_scale *= scale;
    maker_.forget_first_frames();
    trial = maker_.start(choice, step);
    trial->code_to(window_.count);
  }
  choice.num_patches = scaled_patches(choice.num_patches, num_vertices_, num_vertices());
  return {choice, ratio_at_equal_error(whole(*trial), rival)};
}

std::optional<InterSample::Estimate> InterSample::cheapest_choice(double step,
                                                                  const SpanCost& rival,
                                                                  double limit) {
  maker_.forget_first_frames();
  auto best = maker_.start({patterns_.front()}, step);
  if (is_far_off(*best, rival, limit)) return std::nullopt;
  if (patterns_.size() > 1) best = cheapest_of(without_patches(), step);
  pattern_.put(step, best->choice().pattern);
  const Estimate without = at_equal_error(std::move(best), step, rival);
  if (without.ratio <= limit) return without;
  std::vector<InterChoice> choices;
  for (const std::uint32_t count : patches_) {
    if (count > 0) choices.push_back({patterns_.front(), patches_of_sample(count)});
  }
  if (choices.empty()) return std::nullopt;
  maker_.forget_first_frames();
  const Estimate with = at_equal_error(cheapest_of(choices, step), step, rival);
  if (with.ratio <= limit) return with;
  return std::nullopt;
}

InterSample::Estimate InterSample::estimate(const InterChoice& choice, double step,
                                            const SpanCost& rival) {
  InterChoice part = choice;
  part.num_patches = patches_of_sample(choice.num_patches);
  auto trial = maker_.start(part, step);
  trial->code_to(window_.count);
  return at_equal_error(std::move(trial), step, rival);
}

const FramePattern& InterSample::cheapest_pattern(double step) {
  if (patterns_.size() == 1) return patterns_.front();
  return pattern_.get(step, [&] {
    maker_.forget_first_frames();
    return cheapest_of(without_patches(), step)->choice().pattern;
  });
}

std::vector<InterChoice> InterSample::without_patches() const {
  std::vector<InterChoice> choices;
  for (const FramePattern& pattern : patterns_) choices.push_back({pattern});
  return choices;
}

std::unique_ptr<InterTrial> InterSample::cheapest_of(const std::vector<InterChoice>& choices,
                                                     double step) {
  auto trial = cheapest(choices, window_.count,
                        [&](const InterChoice& choice) { return maker_.start(choice, step); });
  trial->code_to(window_.count);
  return trial;
}

// Returns the number of patches of the sample that are as large as `count` of the whole mesh.
std::uint32_t InterSample::patches_of_sample(std::uint32_t count) const {
  return scaled_patches(count, num_vertices(), num_vertices_);
}

}  // namespace rlpc
