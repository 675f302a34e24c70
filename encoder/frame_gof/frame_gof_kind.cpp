#include "encoder/frame_gof/frame_gof_kind.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/mesh/coded_meshes.h"
#include "encoder/frame_gof/frame_coding.h"
#include "encoder/gof/split_coder.h"

namespace rlpc {
namespace {

// The geometry weights, 8.11, which learned weights start from.
// tuned (off: 0): Binary logarithm of their damping.
constexpr int kFrameDamping = 6;
// tuned (off: 0): The weight of near vertices, 1/16. Learned weights hardly depend on it;
// without learning, frames take 1 to 7 % more bytes if it is 0.
constexpr int kNearWeight = 3;
// tuned (off: 0): How much the weights of near vertices change, 1/16.
constexpr int kNearScale = 3;
// tuned (off: 0): Binary logarithm of the variance with which weights are first learned from
// the first frame, whose offsets then have 10 bits.
constexpr int kPrime = 6;

// tuned (off: 1): GOFs of frames are tried where trajectories number at least this fraction of
// their maximum. Below, trajectories of all frames are the better basis.
constexpr double kManyTrajectories = 0.3;

class FrameGofCoder : public GofCoder {
 public:
  FrameGofCoder(const SequenceMesh& mesh, const CodedMesh& layers,
                const EncoderSettings& settings, const GofFrames& frames)
      : mesh_(mesh), layers_(layers), settings_(settings), frames_(frames) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  void release_analysis() override {}
  EncodedGof encode(double step, double /*analysis_step*/) override;

 private:
  FrameSettings settings_for(double step) const;

  const SequenceMesh& mesh_;
  const CodedMesh& layers_;
  const EncoderSettings& settings_;
  const GofFrames& frames_;
};

FrameSettings FrameGofCoder::settings_for(double step) const {
  FrameSettings s;
  s.reference = settings_.frames.reference;
  s.exact_flag = settings_.target.kind == Target::kLossless;
  if (!s.exact_flag) {
    s.step = static_cast<std::uint32_t>(
        std::clamp(std::floor(step * kExactFrameStep + 0.5), 1.0, double{kMaxFrameStep}));
  }
  s.weights = {kFrameDamping, kNearWeight, kNearScale, 0};
  s.learning_flag = settings_.frames.learning &&
                    mesh_.header.num_vertices <= mesh_.header.level().max_learning_vertices;
  s.prime_log2 = s.learning_flag ? kPrime : 0;
  s.layer_group_size = {layers_.num_layers()};
  s.layer_step.assign(layers_.num_layers(), kMaxLayerStep);
  return s;
}

EncodedGof FrameGofCoder::encode(double step, double /*analysis_step*/) {
  const FrameSettings s = settings_for(step);
  const std::size_t values = 3 * std::size_t{frames_.num_vertices};
  const GofHeader header{GofKind::kFrames, frames_.first_frame, frames_.num_frames};
  auto positions = std::make_shared<std::vector<std::int32_t>>(values * frames_.num_frames);
  EncodedGof encoded;
  encoded.units.push_back({UnitType::kGof, write_frame_gof_unit(header, s)});
  FrameCoding coding(layers_, s, mesh_.header.position_bits);
  for (std::uint32_t f = 0; f < frames_.num_frames; ++f) {
    auto units = coding.code(std::span(frames_.xyz).subspan(f * values, values),
                             std::span(*positions).subspan(f * values, values));
    std::move(units.begin(), units.end(), std::back_inserter(encoded.units));
  }
  encoded.frame = [positions, values](std::uint32_t f, std::span<std::int32_t> out) {
    const auto first = positions->begin() + static_cast<std::ptrdiff_t>(f * values);
    std::copy_n(first, values, out.begin());
  };
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
