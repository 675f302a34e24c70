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
// tuned: Maximum number of vertices of a sample.
constexpr std::uint32_t kMaxVertices = 2500;

// tuned (off: 0): Estimates above the rival by less than this factor may be wrong: at the
// border of a region, vertices have fewer neighbours than in the mesh.
constexpr double kMargin = 1.4;
// tuned (off: 0): Other patterns, patches or the remaining frames save at most this factor.
constexpr double kOthers = 1.25;

std::uint32_t window_of(std::uint32_t num_frames) { return std::min(num_frames, kWindow); }

std::uint32_t vertices_of_sample(std::uint32_t num_vertices, std::uint32_t num_frames) {
  return sample_size(num_vertices,
                     std::min(kVertices * kWindow / window_of(num_frames), kMaxVertices));
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
                         const SpanFrames& frames)
    : num_vertices_(frames.num_vertices),
      num_frames_(frames.num_frames),
      window_{(num_frames_ - window_of(num_frames_)) / 2, window_of(num_frames_)},
      sample_(
          sample_mesh(frames, mesh.triangles, vertices_of_sample(num_vertices_, num_frames_))),
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

// Returns the expected cost of the whole GOF.
SpanCost InterSample::whole(const InterTrial& trial) const {
  SpanCost cost = trial.expected(num_frames_);
  const double scale = static_cast<double>(num_vertices_) / frames_.num_vertices;
  cost.bits *= scale;
  cost.squared_error *= scale;
  return cost;
}

// Codes the window, but ends as soon as the trial needs too much. Returns whether it need not.
bool InterSample::may_follow(InterTrial& trial, const SpanCost& rival) const {
  for (std::uint32_t part = 4; part > 0; part /= 2) {
    trial.code_to(1 + (window_.count - 1 + part - 1) / part);
    if (ratio_at_equal_error(whole(trial), rival) > kMargin * kOthers) return false;
  }
  return true;
}

bool InterSample::is_out_of_reach(double step, const SpanCost& rival) {
  maker_.forget_first_frames();
  auto best = maker_.start({patterns_.front()}, step);
  if (!may_follow(*best, rival)) return true;
  if (patterns_.size() > 1) best = cheapest_of(without_patches(), step);
  pattern_.put(step, best->choice().pattern);
  if (ratio_at_equal_error(whole(*best), rival) <= kMargin) return false;
  std::vector<InterChoice> choices;
  for (const std::uint32_t count : patches_) {
    if (count > 0) choices.push_back({patterns_.front(), patches_of_sample(count)});
  }
  return choices.empty() ||
         ratio_at_equal_error(whole(*cheapest_of(choices, step)), rival) > kMargin;
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
  const auto patches = std::uint64_t{count} * frames_.num_vertices / num_vertices_;
  return static_cast<std::uint32_t>(std::max<std::uint64_t>(patches, 1));
}

}  // namespace rlpc
