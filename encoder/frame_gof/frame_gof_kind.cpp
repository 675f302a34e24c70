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

#include "common/frame_gof/recon/frame_recon.h"
#include "common/mesh/coded_meshes.h"
#include "encoder/frame_gof/frame_coding.h"
#include "encoder/frame_gof/frame_settings.h"
#include "encoder/frame_gof/repeated_frames.h"
#include "encoder/gof/split_coder.h"

namespace rlpc {
namespace {

// tuned (off: 1): GOFs of frames are tried where trajectories number at least this fraction of
// their maximum. Below, trajectories of all frames are the better basis.
constexpr double kManyTrajectories = 0.3;

// Positions of all frames of a span, as a decoder outputs them.
class DecodedSpan {
 public:
  DecodedSpan(std::uint32_t num_vertices, std::uint32_t num_frames)
      : values_(3 * std::size_t{num_vertices}),
        positions_(std::make_shared<std::vector<std::int32_t>>(values_ * num_frames)) {}

  std::span<std::int32_t> frame(std::uint32_t f) const {
    return std::span(*positions_).subspan(f * values_, values_);
  }
  DecodeFrame decoder() const {
    return [span = *this](std::uint32_t f, std::span<std::int32_t> out) {
      std::copy_n(span.frame(f).begin(), span.values_, out.begin());
    };
  }

 private:
  std::size_t values_;
  std::shared_ptr<std::vector<std::int32_t>> positions_;
};

// coded: in coding order. Frames of higher temporal layers are absent.
DecodeFrame decode_cut(const CodedMesh& mesh, const FrameSettings& s,
                       const std::vector<CodedFrame>& coded, int position_bits,
                       std::uint32_t temporal_layers) {
  const DecodedSpan decoded(mesh.num_vertices(), static_cast<std::uint32_t>(coded.size()));
  const FrameOrder order(s.pattern, static_cast<std::uint32_t>(coded.size()));
  FrameRecon recon(mesh, s, position_bits);
  for (std::uint32_t place = 0; place < order.num_frames(); ++place) {
    const FramePlace& next = order[place];
    const bool is_there = s.pattern.temporal_layer(next.depth) < temporal_layers;
    recon.decode(next, order.last_use(next.frame), is_there ? coded[place] : CodedFrame{});
    recon.positions(decoded.frame(next.frame));
  }
  return decoded.decoder();
}

class FrameGofCoder : public GofCoder {
 public:
  FrameGofCoder(const SequenceMesh& mesh, const CodedMesh& layers,
                const EncoderSettings& settings, const GofFrames& frames)
      : mesh_(mesh), layers_(layers), settings_(settings), frames_(frames) {}

  bool needs_frames(double /*step*/, double /*analysis_step*/) const override { return true; }
  void release_analysis() override {}
  EncodedGof encode(double step, double /*analysis_step*/) override;

 private:
  const std::vector<std::uint32_t>& repeats();

  const SequenceMesh& mesh_;
  const CodedMesh& layers_;
  const EncoderSettings& settings_;
  const GofFrames& frames_;
  std::vector<std::uint32_t> repeats_;  // by place in coding order: distance, or 0
};

// The same for each step.
const std::vector<std::uint32_t>& FrameGofCoder::repeats() {
  if (repeats_.empty()) {
    const std::size_t values = 3 * std::size_t{frames_.num_vertices};
    const std::uint64_t most = mesh_.header.level().max_gof_factors / values;
    repeats_ = repeat_distances(
        settings_.frames.pattern, frames_.xyz, values,
        static_cast<std::uint32_t>(std::min<std::uint64_t>(most, frames_.num_frames)));
  }
  return repeats_;
}

EncodedGof FrameGofCoder::encode(double step, double /*analysis_step*/) {
  FrameSettings s = choose_frame_settings(mesh_.header, settings_, layers_, step);
  s.max_repeat_distance = *std::max_element(repeats().begin(), repeats().end());
  const std::size_t values = 3 * std::size_t{frames_.num_vertices};
  const GofHeader header{GofKind::kFrames, frames_.first_frame, frames_.num_frames};
  const DecodedSpan decoded(frames_.num_vertices, frames_.num_frames);
  EncodedGof encoded;
  encoded.units.push_back({UnitType::kGof, write_frame_gof_unit(header, s)});
  FrameCoding coding(layers_, s, mesh_.header, frames_.num_frames);
  auto coded = std::make_shared<std::vector<CodedFrame>>();
  const bool has_cuts = s.pattern.temporal_layers > 1;
  for (std::uint32_t i = 0; i < frames_.num_frames; ++i) {
    const std::uint32_t f = coding.next_frame();
    CodedFrame* const copy = has_cuts ? &coded->emplace_back() : nullptr;
    if (repeats()[i] > 0) {
      encoded.units.push_back(coding.repeat(repeats()[i], decoded.frame(f), copy));
      continue;
    }
    auto units =
        coding.code(std::span(frames_.xyz).subspan(f * values, values), decoded.frame(f), copy);
    std::move(units.begin(), units.end(), std::back_inserter(encoded.units));
  }
  encoded.frame = decoded.decoder();
  if (has_cuts) {
    encoded.cut = [layers = &layers_, s, coded, bits = mesh_.header.position_bits](int most) {
      return decode_cut(*layers, s, *coded, bits, static_cast<std::uint32_t>(most));
    };
  }
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
