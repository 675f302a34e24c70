#include "encoder/frame_gof/frame_gof_kind.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/mesh/coded_meshes.h"
#include "encoder/frame_gof/frame_encoding.h"
#include "encoder/frame_gof/frame_settings.h"
#include "encoder/frame_gof/pattern_search.h"
#include "encoder/gof/split_coder.h"

namespace rlpc {
namespace {

// tuned (off: 1): GOFs of frames are tried where trajectories number at least this fraction of
// their maximum. Below, trajectories of all frames are the better basis.
constexpr double kManyTrajectories = 0.3;

// The pattern that is chosen at a step stands for all within kAnalysisServes.
class FrameGofCoder : public GofCoder {
 public:
  FrameGofCoder(const SequenceMesh& mesh, const CodedMesh& layers,
                const EncoderSettings& settings, const GofFrames& frames)
      : mesh_(mesh), layers_(layers), settings_(settings), frames_(frames) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  void release_analysis() override {}
  EncodedGof encode(double step, double /*analysis_step*/) override;

 private:
  const SequenceMesh& mesh_;
  const CodedMesh& layers_;
  const EncoderSettings& settings_;
  const GofFrames& frames_;
  std::vector<FramePattern> patterns_;  // that are still to be compared
  double chosen_at_ = 0.0;              // the step that the pattern was chosen at
};

EncodedGof FrameGofCoder::encode(double step, double /*analysis_step*/) {
  if (patterns_.empty() || !is_within(kAnalysisServes, step, chosen_at_)) {
    chosen_at_ = step;
    patterns_ = patterns_of(settings_, mesh_.header.open_end_flag, frames_.num_frames);
  }
  EncodedGof encoded = encode_cheapest(patterns_, frames_.num_frames, [&](const auto& pattern) {
    return std::make_unique<FrameEncoding>(
        layers_, mesh_.header, frames_,
        choose_frame_settings(mesh_.header, settings_, layers_, pattern, step));
  });
  patterns_ = encoded.patterns;
  return encoded;
}

class FrameGofKind : public GofEncoder {
 public:
  FrameGofKind(const SequenceMesh& mesh, const EncoderSettings& settings)
      : mesh_(mesh), settings_(settings), meshes_(mesh.topology, mesh.triangles, true) {}

  std::unique_ptr<GofCoder> make_coder(const GofFrames& frames) const override {
    if (frames.num_gofs > 1) {
      return std::make_unique<SplitCoder>(
          frames, [this](const GofFrames& of_gof) { return make_coder(of_gof); });
    }
    return std::make_unique<FrameGofCoder>(mesh_, meshes_[Prediction::kLayers], settings_,
                                           frames);
  }

  bool may_win(const GofFrames& frames, std::uint32_t components) const override {
    return components >=
           kManyTrajectories * std::min(frames.num_vertices, 3 * frames.num_frames);
  }

 private:
  const SequenceMesh& mesh_;
  const EncoderSettings& settings_;
  CodedMeshes meshes_;
};

}  // namespace

std::unique_ptr<GofEncoder> make_frame_gof_kind(const SequenceMesh& mesh,
                                                const EncoderSettings& settings) {
  if (settings.profile != Profile::kHigh) return nullptr;
  const bool is_wanted = settings.usable_kinds() == KindChoice::kFrames;
  const bool is_compared = settings.usable_kinds() == KindChoice::kAuto &&
                           settings.preset != Preset::kFast && settings.main == MainTools{};
  if (!is_wanted && !is_compared) return nullptr;
  return std::make_unique<FrameGofKind>(mesh, settings);
}

}  // namespace rlpc
