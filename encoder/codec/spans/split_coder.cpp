#include "encoder/codec/spans/split_coder.h"

#include <algorithm>
#include <utility>

#include "common/parallel/for_each.h"

namespace rlpc {

SpanFrames frames_in_gof(const SpanFrames& frames, const FrameRange& gof) {
  SpanFrames part{frames.num_vertices, gof.count, {}, frames.first_frame + gof.first, 1};
  part.xyz.assign(frames.at(gof.first, 0),
                  frames.at(gof.first, 0) + std::size_t{3} * frames.num_vertices * gof.count);
  return part;
}

namespace {

// Decodes the frames of all parts, one after the other.
DecodeFrame frames_of_all(const std::vector<FrameRange>& gofs,
                          std::vector<DecodeFrame> decoders) {
  return [gofs, decoders = std::move(decoders)](std::uint32_t f,
                                                std::span<std::int32_t> positions) {
    std::size_t g = 0;
    while (f >= gofs[g].first + gofs[g].count) ++g;
    decoders[g](f - gofs[g].first, positions);
  };
}

}  // namespace

SplitCoder::SplitCoder(const SpanFrames& frames, const MakeCoder& make) : frames_(frames) {
  for (std::uint32_t g = 0; g < frames.num_gofs; ++g) {
    parts_.push_back(std::make_unique<Part>());
    parts_.back()->coder = make(parts_.back()->frames);
  }
}

bool SplitCoder::needs_frames(double step, double analysis_step) const {
  return std::any_of(parts_.begin(), parts_.end(), [&](const auto& part) {
    return part->coder->needs_frames(step, analysis_step);
  });
}

EncodedSpan SplitCoder::encode(double step, double analysis_step) {
  const std::vector<FrameRange> gofs = frames_.gofs();
  std::vector<EncodedSpan> encoded_parts(gofs.size());
  for_each(gofs.size(), [&](std::size_t g) {
    Part& part = *parts_[g];
    if (part.coder->needs_frames(step, analysis_step)) {
      part.frames = frames_in_gof(frames_, gofs[g]);
    }
    encoded_parts[g] = part.coder->encode(step, analysis_step);
    part.frames.xyz = {};
  });
  EncodedSpan all;
  all.squared_error = 0.0;
  std::vector<DecodeFrame> decoders;
  std::vector<DecodeCut> cuts;
  for (EncodedSpan& encoded : encoded_parts) {
    for (auto& unit : encoded.units) all.units.push_back(std::move(unit));
    if (encoded.cut) cuts.push_back(std::move(encoded.cut));
    decoders.push_back(std::move(encoded.frame));
    if (!encoded.squared_error) all.squared_error.reset();
    if (all.squared_error) *all.squared_error += *encoded.squared_error;
    all.choices.insert(all.choices.end(), encoded.choices.begin(), encoded.choices.end());
    all.num_factors = std::max(all.num_factors, encoded.num_factors);
    all.adaptive_values = std::max(all.adaptive_values, encoded.adaptive_values);
    all.clusters += encoded.clusters;
    all.max_clusters = std::max(all.max_clusters, encoded.max_clusters);
    all.components += encoded.components;
    all.max_components = std::max(all.max_components, encoded.max_components);
  }
  if (cuts.size() == gofs.size()) {
    all.cut = [gofs, cuts = std::move(cuts)](int layers) {
      std::vector<DecodeFrame> part_decoders;
      for (const DecodeCut& cut : cuts) part_decoders.push_back(cut(layers));
      return frames_of_all(gofs, std::move(part_decoders));
    };
  }
  all.frame = frames_of_all(gofs, std::move(decoders));
  return all;
}

std::optional<double> SplitCoder::step_in_reach(double step, const SpanCost& rival) {
  constexpr std::size_t kAsked = 2;  // fixed: time; GOFs of a span resemble each other
  const std::vector<FrameRange> gofs = frames_.gofs();
  const std::size_t count = std::min(gofs.size(), kAsked);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t g = (2 * i + 1) * gofs.size() / (2 * count);
    Part& part = *parts_[g];
    const double share = static_cast<double>(gofs[g].count) / frames_.num_frames;
    part.frames = frames_in_gof(frames_, gofs[g]);
    const auto found =
        part.coder->step_in_reach(step, {share * rival.bits, share * rival.squared_error});
    part.frames.xyz = {};
    if (found) return found;
  }
  return std::nullopt;
}

void SplitCoder::keep_num_components() {
  for (const auto& part : parts_) part->coder->keep_num_components();
}

void SplitCoder::release_analysis() {
  for (const auto& part : parts_) part->coder->release_analysis();
}

}  // namespace rlpc
