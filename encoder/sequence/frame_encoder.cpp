#include "encoder/frame_encoder.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/input/formats/mesh_text.h"
#include "encoder/math/det_math.h"
#include "encoder/sequence/check_settings.h"
#include "encoder/sequence/choices/gof_cuts.h"
#include "encoder/sequence/choices/grid_choice.h"
#include "encoder/sequence/choices/level_choice.h"
#include "encoder/sequence/choices/lossless_grid.h"
#include "encoder/sequence/gof_batch.h"
#include "encoder/sequence/sequence_coding.h"
#include "encoder/sequence/stream_assembly.h"
#include "encoder/sequence/target_loop.h"

namespace rlpc {
namespace {

// Buffers the frames of one span as they are added.
class SpanBuffer final : public FrameSource {
 public:
  SpanBuffer(std::uint32_t num_vertices, std::uint32_t num_frames)
      : FrameSource({num_vertices, num_frames, {}, {}}) {
    xyz_.reserve(3 * std::size_t{num_vertices} * num_frames);
  }

  void add(std::span<const float> xyz) { xyz_.insert(xyz_.end(), xyz.begin(), xyz.end()); }
  bool is_full() const { return xyz_.size() == 3 * std::size_t{num_vertices()} * num_frames(); }
  std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) override {
    std::copy_n(&xyz_[frame * xyz.size()], xyz.size(), xyz.begin());
    return std::nullopt;
  }

 private:
  std::vector<float> xyz_;
};

std::optional<InputError> check_format(const FrameFormat& format) {
  if (format.num_vertices == 0) return InputError{"a mesh has at least one vertex"};
  if (format.num_frames == 0 || format.num_frames > kMaxFrames) {
    return InputError{"a sequence has 1 to " + std::to_string(kMaxFrames) + " frames, not " +
                      std::to_string(format.num_frames)};
  }
  if (format.frame_rate.numerator == 0 || format.frame_rate.denominator == 0) {
    return InputError{"the frame rate has a zero numerator or denominator"};
  }
  if (format.least_level < 1 || format.least_level > kMaxLevelIdc) {
    return InputError{"levels are 1 to " + std::to_string(kMaxLevelIdc) + ", not " +
                      std::to_string(format.least_level)};
  }
  for (std::size_t t = 0; t < format.triangles.size(); ++t) {
    for (const std::uint32_t v : format.triangles[t]) {
      if (v < format.num_vertices) continue;
      return InputError{"triangle " + std::to_string(t) + " (from 0) has vertex " +
                        std::to_string(v) + " of " + std::to_string(format.num_vertices)};
    }
  }
  for (std::size_t c = 0; c < 3; ++c) {
    constexpr float kMost = 0x1p100F;  // fixed: largest coordinate
    const float low = format.box_min[c];
    const float high = format.box_max[c];
    if (low <= high && low >= -kMost && high <= kMost) continue;
    return InputError{std::string("the box has no extent in ") + "xyz"[c] +
                      " within 2^100: " + shortest_text(low) + " to " + shortest_text(high)};
  }
  return std::nullopt;
}

// The grid is chosen for the first span; later ones may need errors smaller by this factor. The
// finer grid keeps steps far below their maximum.
constexpr double kReserve = 16.0;  // fixed: four bits of the grid

}  // namespace

class FrameEncoder::Impl {
 public:
  Impl(FrameFormat format, EncoderSettings settings, ByteSink sink)
      : format_(std::move(format)),
        settings_(std::move(settings)),
        sink_(std::move(sink)),
        coded_(format_.num_vertices) {}

  std::optional<InputError> prepare();  // the format has passed check_format()
  std::optional<InputError> add_frame(std::span<const float> xyz);
  InputResult<EncodeReport> finish();
  std::uint32_t num_added() const { return num_added_; }

 private:
  // The results of all spans so far.
  struct Coded {
    explicit Coded(std::uint32_t num_vertices)
        : metrics(num_vertices, MetricsAccumulator::kTotals) {}

    std::size_t spans = 0;
    double step = 0.0;  // step of the last span, grid steps; 0: none yet
    MetricsAccumulator metrics;
    std::vector<MetricsAccumulator> cuts;  // to 1 temporal layer and more
    EncodeReport report;
  };

  void make_spans(const SequenceHeader& header);
  std::optional<InputError> check_frame(std::span<const float> xyz) const;
  std::optional<InputError> encode_span();
  bool write(const CodedGof& span);  // false: the sink failed
  void use_header(const SequenceHeader& header);
  // The header with the grid for an error of `finest` (units).
  SequenceHeader header_for(double finest) const;
  InputResult<TargetResult> search(const GofSpan& span, double rms_spread);
  InputResult<TargetResult> search_first(const GofSpan& span, double rms_spread);
  std::optional<InputError> keep_to_level(const LevelNeeds& needs);
  double fixed_bits_per_frame() const;
  InputError fail(InputError error) {
    failure_ = error;
    return error;
  }

  FrameFormat format_;
  EncoderSettings settings_;
  ByteSink sink_;
  std::vector<GofSpan> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;  // from the first span on
  std::optional<SpanBuffer> buffer_;
  std::shared_ptr<const KeptModel> model_;  // in force after the last span; null: none
  std::uint32_t num_added_ = 0;
  std::uint32_t longest_gof_ = 0;
  std::uint32_t num_threads_ = 1;
  Coded coded_;
  std::optional<InputError> failure_;
};

// Spans of as many GOFs as may be held, all of about the same length.
void FrameEncoder::Impl::make_spans(const SequenceHeader& header) {
  const std::uint32_t of_gof = longest_gof(settings_);
  std::uint32_t longest = longest_span(settings_, header);
  if (format_.max_held_frames > 0) {
    longest = std::min(longest, std::max(of_gof, format_.max_held_frames));
  }
  spans_ = equal_gofs(header.num_frames, longest);
  divide_spans(spans_, of_gof);
}

std::optional<InputError> FrameEncoder::Impl::prepare() {
  if (auto error = check_settings(settings_)) return error;
  if (settings_.target.kind == Target::kLossless && settings_.target.value == 0.0) {
    return InputError{
        "the grid of frames that are yet to come is not known: lossless coding needs a number "
        "of bits (--lossless BITS)"};
  }
  SequenceHeader header;
  header.profile_idc = static_cast<std::uint32_t>(settings_.profile);
  header.num_vertices = format_.num_vertices;
  header.num_triangles = static_cast<std::uint32_t>(format_.triangles.size());
  header.num_frames = format_.num_frames;
  header.frame_rate = format_.frame_rate;
  make_spans(header);
  std::uint32_t longest = 0;
  for (const GofSpan& span : spans_) longest = std::max(longest, span.count);
  // The buffer holds frames as floats.
  const std::uint64_t buffer_bytes = 12 * std::uint64_t{header.num_vertices} * longest;
  const auto threads = check_memory(settings_, header, longest, 0, buffer_bytes);
  if (!threads) return threads.error();
  num_threads_ = *threads;
  longest_gof_ = longest_gof_of(spans_);
  if (auto error = choose_level(header, longest_gof_, format_.least_level)) return error;
  // The level must allow later GOFs to have all clusters, bones and components of the settings.
  if (auto error = raise_level(header.level_idc, LevelNeeds(settings_), longest_gof_)) {
    return error;
  }
  coded_.cuts.assign(settings_.main.temporal_layers - 1,
                     MetricsAccumulator(header.num_vertices, MetricsAccumulator::kTotals));
  coding_.emplace(header, settings_, format_.triangles);
  format_.triangles = {};
  return std::nullopt;
}

// Bits outside the GOFs, per frame. If the target is a rate, the index is taken at its largest
// size for GOFs that meet the target.
double FrameEncoder::Impl::fixed_bits_per_frame() const {
  constexpr double kMostBytes = 0x1p31;  // fixed: of a GOF in an index
  std::uint64_t bytes = stream_->overhead_bytes();
  if (settings_.target.kind == Target::kBpvf) {
    std::vector<GofEntry> largest;
    for (const GofSpan& span : spans_) {
      for (const GofSpan& gof : equal_spans(span.count, span.num_gofs)) {
        const double bits = settings_.target.value * format_.num_vertices * gof.count;
        largest.push_back(
            {gof.count, static_cast<std::uint64_t>(std::min(bits / 8.0, kMostBytes))});
      }
    }
    bytes += stream_->index_bytes(std::move(largest));
  }
  return 8.0 * static_cast<double>(bytes) / format_.num_frames;
}

std::optional<InputError> FrameEncoder::Impl::check_frame(std::span<const float> xyz) const {
  const std::string frame = "frame " + std::to_string(num_added_) + " (from 0)";
  if (num_added_ == format_.num_frames) {
    return InputError{frame + " is one more than the number of frames announced, " +
                      std::to_string(format_.num_frames)};
  }
  if (xyz.size() != 3 * std::size_t{format_.num_vertices}) {
    return InputError{frame + " has " + std::to_string(xyz.size()) + " values; " +
                      std::to_string(format_.num_vertices) + " vertices have " +
                      std::to_string(3 * std::size_t{format_.num_vertices})};
  }
  for (std::size_t i = 0; i < xyz.size(); ++i) {
    const std::size_t c = i % 3;
    if (xyz[i] >= format_.box_min[c] && xyz[i] <= format_.box_max[c]) continue;
    return InputError{frame + ", vertex " + std::to_string(i / 3) + ": " + "xyz"[c] + " is " +
                      shortest_text(xyz[i]) + ", outside the box announced, " +
                      shortest_text(format_.box_min[c]) + " to " +
                      shortest_text(format_.box_max[c])};
  }
  return std::nullopt;
}

std::optional<InputError> FrameEncoder::Impl::add_frame(std::span<const float> xyz) {
  if (failure_) return failure_;
  if (auto error = check_frame(xyz)) return fail(*error);
  if (!buffer_) buffer_.emplace(format_.num_vertices, spans_[coded_.spans].count);
  buffer_->add(xyz);
  ++num_added_;
  if (!buffer_->is_full()) return std::nullopt;
  if (auto error = encode_span()) return fail(*error);
  return std::nullopt;
}

void FrameEncoder::Impl::use_header(const SequenceHeader& header) {
  coding_->set_header(header);
  stream_.emplace(header, settings_, coding_->connectivity());
}

SequenceHeader FrameEncoder::Impl::header_for(double finest) const {
  Extent extent;
  std::copy_n(format_.box_min.begin(), 3, extent.min.begin());
  std::copy_n(format_.box_max.begin(), 3, extent.max.begin());
  SequenceHeader header = coding_->header();
  const bool is_lossless = settings_.target.kind == Target::kLossless;
  set_grid(header, is_lossless ? grid_of_bits(extent, static_cast<int>(settings_.target.value))
                               : choose_grid(extent, finest));
  return header;
}

InputResult<TargetResult> FrameEncoder::Impl::search(const GofSpan& span, double rms_spread) {
  GofBatch batch(*coding_, *buffer_, {{0, span.count, span.num_gofs}},
                 {.first_frame = span.first,
                  .keep_decoded = true,
                  .model = model_,
                  .has_followers = coded_.spans + 1 < spans_.size(),
                  .metrics = MetricsAccumulator::kTotals});
  auto best = reach_target({.settings = settings_,
                            .header = coding_->header(),
                            .rms_spread = rms_spread,
                            .fixed_bits = fixed_bits_per_frame() * span.count,
                            .first_step = coded_.step,  // spans are usually similar
                            .keeps_level = coded_.spans > 0},
                           batch);
  if (best) coded_.report.trials += best->trials;
  return best;
}

// Searches the first span, which determines the grid. If the target is a rate, the resulting
// error may require a finer grid and a second search.
InputResult<TargetResult> FrameEncoder::Impl::search_first(const GofSpan& span,
                                                           double rms_spread) {
  use_header(header_for(finest_error(settings_.target, rms_spread) / kReserve));
  auto best = search(span, rms_spread);
  if (!best || settings_.target.kind != Target::kBpvf) return best;
  const double error = rms_spread * best->trial.metrics.kg_error_percent / 100.0;
  const SequenceHeader finer = header_for(error / kReserve);
  if (finer.position_bits <= coding_->header().position_bits) return best;
  use_header(finer);
  return search(span, rms_spread);
}

// Sets the level with a reserve at the first span; error if a later one needs a higher level.
std::optional<InputError> FrameEncoder::Impl::keep_to_level(const LevelNeeds& needs) {
  const GofSpan& span = spans_[coded_.spans];
  SequenceHeader header = coding_->header();
  const std::uint32_t level_idc = header.level_idc;
  const bool first = coded_.spans == 0;
  const LevelNeeds wanted = first ? needs.with_reserve() : needs;
  if (auto error = raise_level(header.level_idc, wanted, longest_gof_)) return error;
  if (first) coding_->set_header(header);
  if (first || header.level_idc == level_idc) return std::nullopt;
  return InputError{"frames " + std::to_string(span.first) + " to " +
                    std::to_string(span.first + span.count - 1) + " need level " +
                    std::to_string(header.level_idc) +
                    " (specification, Annex B), but the stream has level " +
                    std::to_string(level_idc) +
                    ": encode again with a higher least level, or with fewer components"};
}

std::optional<InputError> FrameEncoder::Impl::encode_span() {
  const Threads threads(num_threads_);
  const GofSpan& span = spans_[coded_.spans];
  const auto extent = measure_extent(*buffer_);
  if (!extent) return extent.error();
  const auto best = coded_.spans == 0 ? search_first(span, extent->rms_spread)
                                      : search(span, extent->rms_spread);
  if (!best) return best.error();
  const CodedGof& coded = best->trial.gofs.front();
  coded_.report.target_met = coded_.report.target_met && best->met;
  coded_.report.clusters += coded.clusters;
  coded_.report.components += coded.components;
  coded_.step = best->step;
  if (auto error = keep_to_level(coded.needs)) return error;
  std::mutex reading;
  const SharedSource source{*buffer_, reading};
  const GofSpan frames{0, span.count, span.num_gofs};
  const auto hashes = coding_->measure(source, frames, coded.frame, coded_.metrics);
  if (!hashes) return hashes.error();
  for (std::size_t i = 0; i < coded_.cuts.size(); ++i) {
    const auto cut =
        coding_->measure(source, frames, coded.cut(static_cast<int>(i) + 1), coded_.cuts[i]);
    if (!cut) return cut.error();
  }
  if (coded.model) model_ = coded.model;
  if (!write(coded)) return InputError{"the stream could not be written"};
  ++coded_.spans;
  buffer_.reset();
  return std::nullopt;
}

bool FrameEncoder::Impl::write(const CodedGof& span) {
  bool ok = coded_.spans > 0 || stream_->write_lead(coding_->header(), sink_);
  for (const GofBytes& gof : span.gofs) ok = ok && stream_->write_gof(gof, sink_);
  return ok;
}

InputResult<EncodeReport> FrameEncoder::Impl::finish() {
  if (failure_) return *failure_;
  if (num_added_ < format_.num_frames) {
    return fail({"the stream ends after " + std::to_string(num_added_) + " of " +
                 std::to_string(format_.num_frames) + " frames announced"});
  }
  if (!stream_->write_end(sink_)) return fail({"the stream could not be written"});
  EncodeReport& report = coded_.report;
  stream_->describe(coding_->header(), coding_->connectivity(), report);
  report.metrics = coded_.metrics.result();
  for (std::size_t i = 0; i < coded_.cuts.size(); ++i) {
    report.temporal_cuts.push_back({static_cast<std::uint32_t>(i) + 1,
                                    stream_->cut_bytes(i + 1),
                                    coded_.cuts[i].result().kg_error_percent});
  }
  if (settings_.baseline.qu == 0) {
    report.step = coded_.step * exact_exp2(coding_->header().grid.log2_step);
  }
  failure_ = InputError{"the stream is finished already"};
  return std::move(report);
}

InputResult<FrameEncoder> FrameEncoder::create(FrameFormat format, EncoderSettings settings,
                                               ByteSink sink) {
  if (auto error = check_format(format)) return *error;
  auto impl = std::make_unique<Impl>(std::move(format), std::move(settings), std::move(sink));
  if (auto error = impl->prepare()) return *error;
  return FrameEncoder(std::move(impl));
}

FrameEncoder::FrameEncoder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;
FrameEncoder::~FrameEncoder() = default;

std::optional<InputError> FrameEncoder::add_frame(std::span<const float> xyz) {
  return impl_->add_frame(xyz);
}
InputResult<EncodeReport> FrameEncoder::finish() { return impl_->finish(); }
std::uint32_t FrameEncoder::num_added() const { return impl_->num_added(); }

}  // namespace rlpc
