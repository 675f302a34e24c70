#include "encoder/frame_encoder.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <string>
#include <utility>

#include "encoder/input/formats/mesh_text.h"
#include "encoder/math/det_math.h"
#include "encoder/sequence/check_settings.h"
#include "encoder/sequence/gof_cuts.h"
#include "encoder/sequence/grid_choice.h"
#include "encoder/sequence/level_choice.h"
#include "encoder/sequence/sequence_coding.h"
#include "encoder/sequence/stream_assembly.h"
#include "encoder/sequence/target_search.h"

namespace rlpc {
namespace {

// The frames of one GOF, as they came.
class GofBuffer final : public FrameSource {
 public:
  GofBuffer(std::uint32_t num_vertices, std::uint32_t num_frames)
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
    return InputError{"a frame rate has no zero in it"};
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
    constexpr float kMost = 0x1p100F;
    const float low = format.box_min[c];
    const float high = format.box_max[c];
    if (low <= high && low >= -kMost && high <= kMost) continue;
    return InputError{std::string("the box has no extent in ") + "xyz"[c] +
                      " within 2^100: " + shortest_text(low) + " to " + shortest_text(high)};
  }
  return std::nullopt;
}

// Later GOFs may need errors this much smaller than the first one, by which the grid is chosen.
// Steps stay far below their largest size.
constexpr double kReserve = 16.0;

}  // namespace

class FrameEncoder::Impl {
 public:
  Impl(FrameFormat format, EncoderSettings settings, ByteSink sink)
      : format_(std::move(format)),
        settings_(std::move(settings)),
        sink_(std::move(sink)),
        metrics_(format_.num_vertices, MetricsAccumulator::kTotals) {}

  std::optional<InputError> prepare();  // of a format that was checked
  std::optional<InputError> add_frame(std::span<const float> xyz);
  InputResult<EncodeReport> finish();
  std::uint32_t num_added() const { return num_added_; }

 private:
  // The encoding of a GOF that comes closest to the target, and where it is.
  struct Best {
    EncodedGof encoded;
    GofBytes bytes;
    double step = 0.0;
    double kg_error_percent = 0.0;
    bool met = false;  // within the target
  };

  std::optional<InputError> check_frame(std::span<const float> xyz) const;
  std::optional<InputError> encode_gof();
  // Replaces the header that prepare() has made.
  void use_header(const SequenceHeader& header);
  // With the grid for the finest error that matters.
  SequenceHeader header_for(double finest) const;
  InputResult<Best> search(const GofSpan& span, double rms_spread);
  InputResult<Best> search_first(const GofSpan& span, double rms_spread);
  double measured(const Metrics& metrics, const GofBytes& gof) const;
  std::optional<InputError> keep_to_level(const LevelNeeds& needs);
  std::uint64_t fixed_bytes() const;
  InputError fail(InputError error) {
    failure_ = error;
    return error;
  }

  FrameFormat format_;
  EncoderSettings settings_;
  ByteSink sink_;
  SequenceHeader header_;
  std::vector<GofSpan> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;
  std::optional<GofBuffer> buffer_;
  MetricsAccumulator metrics_;
  double fixed_bits_per_frame_ = 0.0;  // of all that is no GOF
  std::uint32_t num_added_ = 0;
  std::size_t num_coded_ = 0;  // GOFs
  double last_step_ = 0.0;     // grid steps; 0: none yet
  EncodeReport report_;
  std::optional<InputError> failure_;
};

std::optional<InputError> FrameEncoder::Impl::prepare() {
  if (auto error = check_settings(settings_)) return error;
  header_.profile_idc = settings_.profile == Profile::kMain ? kProfileMain : kProfileBaseline;
  header_.num_vertices = format_.num_vertices;
  header_.num_triangles = static_cast<std::uint32_t>(format_.triangles.size());
  header_.num_frames = format_.num_frames;
  header_.frame_rate = format_.frame_rate;
  spans_ = equal_gofs(header_.num_frames, longest_gof(settings_));
  std::uint32_t longest = 0;
  for (const GofSpan& span : spans_) longest = std::max(longest, span.count);
  if (auto error = choose_level(header_, longest, format_.least_level)) return error;
  // GOFs that come later can have all that is asked for.
  if (auto error = raise_level(header_.level_idc, LevelNeeds(settings_), longest)) return error;
  coding_.emplace(header_, settings_, format_.triangles);
  format_.triangles = {};
  return std::nullopt;
}

// The index as large as it gets with GOFs that meet the target in bits.
std::uint64_t FrameEncoder::Impl::fixed_bytes() const {
  const std::uint64_t without = stream_->overhead_bytes();
  if (settings_.target.kind != Target::kBpvf) return without;
  std::vector<GofEntry> largest;
  for (const GofSpan& span : spans_) {
    const double bits = settings_.target.value * header_.num_vertices * span.count;
    largest.push_back({span.count, static_cast<std::uint64_t>(std::min(bits / 8.0, 0x1p31))});
  }
  return without + stream_->index_bytes(largest);
}

std::optional<InputError> FrameEncoder::Impl::check_frame(std::span<const float> xyz) const {
  const std::string frame = "frame " + std::to_string(num_added_) + " (from 0)";
  if (num_added_ == header_.num_frames) {
    return InputError{frame + " is one more than the number of frames announced, " +
                      std::to_string(header_.num_frames)};
  }
  if (xyz.size() != 3 * std::size_t{header_.num_vertices}) {
    return InputError{frame + " has " + std::to_string(xyz.size()) + " values; " +
                      std::to_string(header_.num_vertices) + " vertices have " +
                      std::to_string(3 * std::size_t{header_.num_vertices})};
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
  if (!buffer_) buffer_.emplace(header_.num_vertices, spans_[num_coded_].count);
  buffer_->add(xyz);
  ++num_added_;
  if (!buffer_->is_full()) return std::nullopt;
  if (auto error = encode_gof()) return fail(*error);
  return std::nullopt;
}

double FrameEncoder::Impl::measured(const Metrics& metrics, const GofBytes& gof) const {
  switch (settings_.target.kind) {
    case Target::kKg:
      return metrics.kg_error_percent;
    case Target::kMaxError:
      return metrics.max_error;
    case Target::kBpvf:
      return (8.0 * static_cast<double>(gof.size()) / gof.num_frames + fixed_bits_per_frame_) /
             header_.num_vertices;
    case Target::kNone:
      break;
  }
  return 0.0;
}

void FrameEncoder::Impl::use_header(const SequenceHeader& header) {
  header_ = header;
  coding_->follow_grid();
  stream_.emplace(header_, settings_, coding_->connectivity());
  fixed_bits_per_frame_ = 8.0 * static_cast<double>(fixed_bytes()) / header_.num_frames;
}

SequenceHeader FrameEncoder::Impl::header_for(double finest) const {
  Extent extent;
  std::copy_n(format_.box_min.begin(), 3, extent.min.begin());
  std::copy_n(format_.box_max.begin(), 3, extent.max.begin());
  SequenceHeader header = header_;
  set_grid(header, choose_grid(extent, finest));
  return header;
}

InputResult<FrameEncoder::Impl::Best> FrameEncoder::Impl::search(const GofSpan& span,
                                                                 double rms_spread) {
  const GofSpan all{0, span.count};
  const auto frames = coding_->read_frames(*buffer_, all);
  if (!frames) return frames.error();
  GofMemory memory;
  const auto coder = coding_->make_coder(*frames, span.first, memory);
  TargetSearch search = search_for(settings_, header_, rms_spread);
  const bool for_kg = settings_.target.kind == Target::kKg;
  const double spread = rms_spread * exact_exp2(-header_.grid.log2_step);
  const auto expected = [&] {
    if (!for_kg) return TargetSearch::Expected{};
    return expected_kg({coder.get()},
                       spread * spread * static_cast<double>(frames->xyz.size()));
  };
  if (last_step_ > 0.0) {
    search.begin_at(last_step_);  // GOFs are much alike
  } else if (for_kg) {
    coder->analyse(search.analysis_step());
    if (const auto by_analysis = expected()) search.begin_at(by_analysis);
  }
  std::optional<Best> best;
  while (!search.finished()) {
    ++report_.trials;
    Best trial{coder->encode(search.step(), search.analysis_step()), {}, search.step()};
    MetricsAccumulator metrics(header_.num_vertices, MetricsAccumulator::kTotals);
    auto hash_unit = coding_->measure(*buffer_, all, trial.encoded, metrics);
    if (!hash_unit) return hash_unit.error();
    trial.bytes = {span.count, write_gof_units(trial.encoded), std::move(*hash_unit)};
    trial.kg_error_percent = metrics.result().kg_error_percent;
    const bool better =
        search.report(measured(metrics.result(), trial.bytes), trial.bytes.size(), expected());
    if (better || !best) best = std::move(trial);
  }
  best->met = search.met();
  return std::move(*best);
}

// The first GOF sets the grid; where the target is a rate, by the error that this allows.
InputResult<FrameEncoder::Impl::Best> FrameEncoder::Impl::search_first(const GofSpan& span,
                                                                       double rms_spread) {
  use_header(header_for(finest_error(settings_.target, rms_spread) / kReserve));
  auto best = search(span, rms_spread);
  if (!best || settings_.target.kind != Target::kBpvf) return best;
  const double error = rms_spread * best->kg_error_percent / 100.0;
  const SequenceHeader finer = header_for(error / kReserve);
  if (finer.position_bits <= header_.position_bits) return best;
  use_header(finer);
  return search(span, rms_spread);
}

// The first GOF sets the level, with a reserve; the others keep to it.
std::optional<InputError> FrameEncoder::Impl::keep_to_level(const LevelNeeds& needs) {
  const GofSpan& span = spans_[num_coded_];
  if (num_coded_ == 0) return raise_level(header_.level_idc, needs.with_reserve(), span.count);
  std::uint32_t needed = header_.level_idc;
  if (auto error = raise_level(needed, needs, span.count)) return error;
  if (needed == header_.level_idc) return std::nullopt;
  return InputError{"frames " + std::to_string(span.first) + " to " +
                    std::to_string(span.first + span.count - 1) + " need level " +
                    std::to_string(needed) +
                    " (specification, Annex B), but the stream was begun at level " +
                    std::to_string(header_.level_idc) +
                    ": encode again with that as the least level, or with fewer components"};
}

std::optional<InputError> FrameEncoder::Impl::encode_gof() {
  const GofSpan& span = spans_[num_coded_];
  const auto extent = measure_extent(*buffer_);
  if (!extent) return extent.error();
  const auto best = num_coded_ == 0 ? search_first(span, extent->rms_spread)
                                    : search(span, extent->rms_spread);
  if (!best) return best.error();
  report_.target_met = report_.target_met && best->met;
  last_step_ = best->step;
  report_.clusters += best->encoded.clusters;
  report_.components += best->encoded.components;
  if (auto error = keep_to_level(LevelNeeds(best->encoded))) return error;
  if (auto hash = coding_->measure(*buffer_, {0, span.count}, best->encoded, metrics_); !hash) {
    return hash.error();
  }
  const bool written = (num_coded_ > 0 || stream_->write_lead(header_, sink_)) &&
                       stream_->write_gof(best->bytes, sink_);
  if (!written) return InputError{"the stream could not be written"};
  ++num_coded_;
  buffer_.reset();
  return std::nullopt;
}

InputResult<EncodeReport> FrameEncoder::Impl::finish() {
  if (failure_) return *failure_;
  if (num_added_ < header_.num_frames) {
    return fail({"the stream ends after " + std::to_string(num_added_) + " of " +
                 std::to_string(header_.num_frames) + " frames announced"});
  }
  if (!stream_->write_end(sink_)) return fail({"the stream could not be written"});
  stream_->describe(header_, coding_->connectivity(), report_);
  report_.metrics = metrics_.result();
  if (settings_.baseline.qu == 0) {
    report_.step = last_step_ * exact_exp2(header_.grid.log2_step);
  }
  failure_ = InputError{"the stream is finished already"};
  return std::move(report_);
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
