#include "encoder/dry_run.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "encoder/codec/sequence/check_settings.h"
#include "encoder/codec/sequence/memory_need.h"
#include "encoder/codec/sequence/sequence_coding.h"
#include "encoder/complete_settings.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {
namespace {

constexpr std::uint32_t kStretches = 8;        // fixed: of a dry run
constexpr std::uint64_t kStretchFrames = 128;  // fixed: of a dry run

// Concatenates kStretches evenly spaced stretches of a sequence, each of `stretch` frames.
class StretchSource final : public FrameSource {
 public:
  StretchSource(FrameSource& source, std::uint32_t stretch)
      : FrameSource({source.num_vertices(),
                     kStretches * stretch,
                     source.frame_rate(),
                     source.triangles(),
                     {},
                     {},
                     {},
                     source.attributes(),
                     source.asset(),
                     source.materials(),
                     source.memory_bytes()}),
        source_(source),
        stretch_(stretch) {
    // Frames have other numbers in the sample.
    drop_later_normals();
  }

  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    return source_.read_frame(frame_of(frame), xyz);
  }
  std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz) override {
    return source_.read_exact(frame_of(frame), xyz);
  }
  bool is_finer_than_floats() const override { return source_.is_finer_than_floats(); }

 private:
  std::uint32_t frame_of(std::uint32_t frame) const {
    const std::uint64_t spare = source_.num_frames() - stretch_;
    const std::uint64_t first = spare * (frame / stretch_) / (kStretches - 1);
    return static_cast<std::uint32_t>(first) + frame % stretch_;
  }

  FrameSource& source_;
  std::uint32_t stretch_;
};

// Returns settings for the sample: clips keep their names, but not their frames.
EncoderSettings settings_of_sample(EncoderSettings settings, std::uint32_t num_frames) {
  for (std::size_t i = 0; i < settings.clips.size(); ++i) {
    settings.clips[i].first_frame = static_cast<std::uint32_t>(i % num_frames);
    settings.clips[i].num_frames = 1;
  }
  return settings;
}

// Returns frames per stretch: a multiple of the GOF length, so that the sample has GOFs of that
// length.
std::uint64_t stretch_frames(std::uint64_t gof_frames) {
  if (gof_frames >= kStretchFrames) return gof_frames;
  return kStretchFrames / gof_frames * gof_frames;
}

}  // namespace

InputResult<Expectation> expect_encoding(FrameSource& source, const EncoderSettings& settings,
                                         const Progress& progress) {
  const EncoderSettings complete = complete_settings(settings, source.clips(), source.asset());
  const ByteSink discard = [](std::span<const std::uint8_t>) { return true; };
  const std::uint64_t stretch = stretch_frames(longest_gof(complete, source.num_vertices()));
  if (source.num_frames() <= kStretches * std::max(stretch, kStretchFrames)) {
    auto report = encode(source, complete, discard, progress);
    if (!report) return report.error();
    return Expectation{std::move(*report), source.num_frames()};
  }
  if (auto error = check_clips(complete.clips, source.num_frames())) return *error;
  StretchSource sample(source, static_cast<std::uint32_t>(stretch));
  auto encoded =
      encode(sample, settings_of_sample(complete, sample.num_frames()), discard, progress);
  if (!encoded) return encoded.error();
  EncodeReport& report = *encoded;
  const double scale = static_cast<double>(source.num_frames()) / sample.num_frames();
  const std::uint64_t encoded_bytes = report.bytes;
  const std::uint64_t once = 8 * report.bytes - report.bits.gofs -
                             report.bits.hashes;  // independent of the number of frames
  for (std::uint64_t* bits : {&report.bits.gofs, &report.bits.hashes}) {
    *bits =
        8 * static_cast<std::uint64_t>(std::llround(static_cast<double>(*bits) / 8 * scale));
  }
  report.bytes = (once + report.bits.gofs + report.bits.hashes) / 8;
  for (TemporalCut& cut : report.temporal_cuts) {
    cut.bytes = report.bytes - static_cast<std::uint64_t>(std::llround(
                                   static_cast<double>(encoded_bytes - cut.bytes) * scale));
  }
  report.header.num_frames = source.num_frames();
  report.bpvf =
      bits_per_vertex_per_frame(report.bytes, source.num_vertices(), source.num_frames());
  for (std::uint32_t* count : {&report.num_gofs, &report.clusters, &report.components}) {
    *count = static_cast<std::uint32_t>(std::llround(*count * scale));
  }
  for (PatternCount& pattern_count : report.patterns) {
    pattern_count.gofs = static_cast<std::uint32_t>(std::llround(pattern_count.gofs * scale));
  }
  return Expectation{std::move(report), sample.num_frames()};
}

}  // namespace rlpc
