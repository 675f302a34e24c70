#include "encoder/codec/sequence/span_encoder.h"

#include <algorithm>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/sequence/check_frames.h"
#include "encoder/codec/sequence/choices/grid_choice.h"
#include "encoder/codec/sequence/format_header.h"
#include "encoder/codec/sequence/memory_need.h"
#include "encoder/codec/sequence/normals_target.h"

namespace rlpc {
namespace {

// Frames are held until their span is encoded.
constexpr SourceMemory kHeldFrames{.bytes_of_position =
                                       3 * (sizeof(float) + sizeof(double))};  // fixed: memory

}  // namespace

// Makes spans of as many GOFs as may be held, all of about the same length.
void SpanEncoder::make_spans(const SequenceHeader& header) {
  const std::uint32_t gof_length = longest_gof(settings_, header.num_vertices);
  std::uint32_t longest = longest_span(settings_, header, kHeldFrames);
  if (format_.max_held_frames > 0) {
    longest = std::min(longest, std::max(gof_length, format_.max_held_frames));
  }
  spans_ = is_open_ended() ? std::vector<FrameRange>{{0, longest, 1}}
                           : equal_gofs(header.num_frames, longest);
  divide_spans(spans_, gof_length);
}

FrameRange SpanEncoder::current() const {
  if (!is_open_ended()) return spans_[coded_.spans];
  // All but the last have the same length.
  const std::uint32_t held = buffer_ ? buffer_->num_frames() : spans_.front().count;
  std::vector<FrameRange> span{{num_added_ - num_held_, held, 1}};
  divide_spans(span, longest_gof(settings_, format_.num_vertices));
  return span.front();
}

std::optional<InputError> SpanEncoder::prepare() {
  SequenceHeader header = header_of(format_, settings_);
  make_spans(header);
  std::uint32_t longest = 0;
  for (const FrameRange& span : spans_) longest = std::max(longest, span.count);
  const auto threads = check_memory(settings_, header, longest, 0, kHeldFrames);
  if (!threads) return threads.error();
  num_threads_ = *threads;
  longest_gof_ = longest_gof(spans_);
  if (auto error = choose_level(header, longest_gof_, format_.least_level)) return error;
  // The level must allow later GOFs to have all clusters, bones and components of the settings.
  if (auto error = raise_level(header.level_idc, LevelNeeds(settings_), longest_gof_)) {
    return error;
  }
  coded_.cuts.assign(settings_.temporal_layers() - 1,
                     MetricsAccumulator(header.num_vertices, MetricsAccumulator::kTotals));
  coding_.emplace(header, settings_, format_.triangles);
  attributes_.emplace(format_.attributes, format_.triangles, settings_, coding_->connectivity(),
                      header.num_frames != 1);
  format_.triangles = {};
  return std::nullopt;
}

// Returns bits outside the GOFs, per frame. If the target is a rate, the index has its largest
// size for GOFs that meet the target.
double SpanEncoder::fixed_bits_per_frame() const {
  constexpr double kMaxBytes = 0x1p31;  // fixed: largest GOF in an index
  std::uint64_t bytes = stream_->overhead_bytes();
  if (is_open_ended()) {
    constexpr std::uint64_t kBytesOfEntry = 8;  // fixed: about, for a GOF in an index
    const FrameRange span = current();
    const std::uint64_t lead = coded_.spans == 0 ? bytes : 0;
    return 8.0 * static_cast<double>(lead + kBytesOfEntry * span.num_gofs) / span.count;
  }
  if (settings_.target.kind == Target::kBpvf) {
    std::vector<GofEntry> largest;
    for (const FrameRange& span : spans_) {
      for (const FrameRange& gof : equal_ranges(span.count, span.num_gofs)) {
        const double bits = settings_.target.value * format_.num_vertices * gof.count;
        largest.push_back(
            {gof.count, static_cast<std::uint64_t>(std::min(bits / 8.0, kMaxBytes))});
      }
    }
    bytes += stream_->index_bytes(std::move(largest));
  }
  return 8.0 * static_cast<double>(bytes) / format_.num_frames;
}

std::optional<InputError> SpanEncoder::add_frame(std::span<const float> xyz,
                                                 std::span<const double> exact) {
  if (failure_) return failure_;
  if (auto error = check_frame(format_, num_added_, xyz, exact)) return fail(*error);
  if (!buffer_) {
    const std::uint32_t count = current().count;
    buffer_.emplace(format_.num_vertices, count);
  }
  buffer_->add(xyz, exact);
  ++num_added_;
  ++num_held_;
  if (!buffer_->is_full()) return std::nullopt;
  if (auto error = encode_span()) return fail(*error);
  return std::nullopt;
}

void SpanEncoder::use_header(const SequenceHeader& header) {
  coding_->set_header(header);
  stream_.emplace(header, settings_, coding_->connectivity());
}

SequenceHeader SpanEncoder::header_for(double finest) const {
  SequenceHeader header = coding_->header();
  set_grid_of_box(header, format_, settings_.target, finest);
  return header;
}

InputResult<TargetResult> SpanEncoder::search(const FrameRange& span, double rms_spread) {
  SpanBatch batch(*coding_, *buffer_, {{0, span.count, span.num_gofs}},
                  {.first_frame = span.first,
                   .keep_decoded = true,
                   .kept_frames = attributes_->frames(),
                   .rig = rig_,
                   .has_followers = is_open_ended() || coded_.spans + 1 < spans_.size(),
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
InputResult<TargetResult> SpanEncoder::search_first(const FrameRange& span, double rms_spread) {
  use_header(header_for(finest_error(settings_.target, rms_spread)));
  if (attributes_->has_sets() && settings_.target.kind == Target::kBpvf) {
    // The size of attributes is part of the rate.
    std::vector<std::uint32_t> held = attributes_->frames();
    std::erase_if(held, [&](std::uint32_t frame) { return frame >= span.count; });
    const auto frames = coding_->nearest_frames(*buffer_, held);
    if (!frames) return frames.error();
    attributes_->encode(*frames, *stream_);
  }
  auto best = search(span, rms_spread);
  if (!best || settings_.target.kind != Target::kBpvf) return best;
  const double error = rms_spread * best->trial.metrics.kg_error_percent / 100.0;
  const SequenceHeader finer = header_for(error);
  if (finer.position_bits <= coding_->header().position_bits) return best;
  use_header(finer);
  return search(span, rms_spread);
}

// Sets the level with a reserve at the first span. Error: a later one needs a higher level.
std::optional<InputError> SpanEncoder::keep_to_level(const LevelNeeds& needs) {
  const FrameRange span = current();
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

std::optional<InputError> SpanEncoder::encode_span() {
  const Threads threads(num_threads_);
  const FrameRange span = current();
  const auto extent = measure_extent(*buffer_);
  if (!extent) return extent.error();
  if (coded_.spans == 0 && settings_.target.max_normals > 0.0) {
    const auto kg = expected_kg(*buffer_, coding_->normal_triangles(), settings_.target);
    if (!kg) return kg.error();
    settings_.target.expected_kg = *kg;
  }
  const auto best = coded_.spans == 0 ? search_first(span, extent->rms_spread)
                                      : search(span, extent->rms_spread);
  if (!best) return best.error();
  const SpanResult& coded = best->trial.spans.front();
  coded_.report.target_met = coded_.report.target_met && best->met;
  coded_.report.clusters += coded.clusters;
  coded_.report.components += coded.components;
  count_patterns(coded.choices, coded_.report.patterns);
  coded_.step = best->step;
  if (auto error = keep_to_level(coded.needs)) return error;
  std::mutex reading;
  const SharedSource source{*buffer_, reading};
  const FrameRange frames{0, span.count, span.num_gofs};
  const auto hashes = coding_->measure(source, frames, coded.frame, coded_.metrics);
  if (!hashes) return hashes.error();
  for (std::size_t i = 0; i < coded_.cuts.size(); ++i) {
    const auto cut =
        coding_->measure(source, frames, coded.cut(static_cast<int>(i) + 1), coded_.cuts[i]);
    if (!cut) return cut.error();
  }
  if (coded.rig) rig_ = coded.rig;
  if (auto error = write(coded)) return error;
  ++coded_.spans;
  num_held_ = 0;
  buffer_.reset();
  return std::nullopt;
}

std::optional<InputError> SpanEncoder::write(const SpanResult& span) {
  const ByteSink keep = out_.collector();
  if (coded_.spans == 0) {
    attributes_->encode(span.kept, *stream_);
    stream_->write_lead(coding_->header(), keep);
  }
  bool is_first = coded_.spans == 0;
  for (const GofBytes& gof : span.gofs) {
    stream_->write_gof(gof, keep);
    if (!std::exchange(is_first, false)) continue;
    if (auto error = out_.check_contents(attributes_->has_sets())) return error;
  }
  StreamVerifier& verifier =
      out_.verifier(coding_->header(), coding_->connectivity(), num_threads_);
  verifier.measure_normals(coding_->normal_triangles());
  if (auto error = verifier.check_frames(*buffer_, 0, buffer_->num_frames())) return error;
  return out_.pass_on(sink_);
}

InputResult<EncodeReport> SpanEncoder::finish() {
  if (failure_) return *failure_;
  if (auto error = check_count(format_, num_added_)) return fail(*error);
  if (buffer_) {  // the rest of an open-ended stream
    SpanBuffer::Frames rest = buffer_->take();
    buffer_.emplace(format_.num_vertices, std::move(rest));
    if (auto error = encode_span()) return fail(*error);
  }
  stream_->write_end(out_.collector());
  EncodeReport& report = coded_.report;
  stream_->describe(coding_->header(), coding_->connectivity(), report);
  report.metrics = coded_.metrics.result();
  report.largest_rounding = out_.largest_rounding();
  if (auto error = out_.finish(report.metrics, sink_)) return fail(*error);
  report.target_met = report.target_met && meets_rate(settings_.target, report);
  report.attributes = attributes_->reports();
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

}  // namespace rlpc
