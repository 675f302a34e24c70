#include "encoder/codec/sequence/low_delay_encoder.h"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <string>
#include <utility>

#include "common/parallel/for_each.h"
#include "encoder/codec/kinds/inter/earlier_frames.h"
#include "encoder/codec/kinds/inter/first_frame.h"
#include "encoder/codec/kinds/inter/inter_settings.h"
#include "encoder/codec/math/det_math.h"
#include "encoder/codec/sequence/check_frames.h"
#include "encoder/codec/sequence/choices/grid_choice.h"
#include "encoder/codec/sequence/choices/level_choice.h"
#include "encoder/codec/sequence/format_header.h"
#include "encoder/codec/sequence/memory_need.h"
#include "encoder/codec/sequence/span_buffer.h"
#include "encoder/codec/stage_clock.h"
#include "encoder/codec/write/write_inter_gof.h"

namespace rlpc {
namespace {

// RMS error of a coordinate over the quantiser step: 0.29 where residuals are rounded to
// nearest, more where many fall into the dead zone. Later steps follow the error (StepControl).
constexpr double kFirstErrorRatio = 0.6;  // fixed: measured, 0.3 to 0.65 on six animations
constexpr double kAim = 0.985;            // fixed: a margin below the KG error

}  // namespace

LowDelayEncoder::LowDelayEncoder(FrameFormat format, EncoderSettings settings, ByteSink sink)
    : format_(std::move(format)),
      settings_(std::move(settings)),
      sink_(std::move(sink)),
      out_(settings_, format_.num_frames == 0),
      keep_(out_.collector()),
      metrics_(format_.num_vertices, MetricsAccumulator::kTotals) {}

std::optional<InputError> LowDelayEncoder::prepare() {
  SequenceHeader header = header_of(format_, settings_);
  const std::uint32_t longest =
      std::min(longest_gof(settings_, format_.num_vertices), header.num_frames);
  // Only one frame of a GOF is held.
  const auto threads = check_memory(settings_, header, 1, 0, {});
  if (!threads) return threads.error();
  num_threads_ = std::clamp(settings_.threads, 1U, kMaxEncoderThreads);
  if (auto error = choose_level(header, longest, format_.least_level)) return error;
  coding_.emplace(header, settings_, format_.triangles);
  // Attributes are written before the first frame is coded.
  settings_.attributes.from_positions = false;
  attributes_.emplace(format_.attributes, format_.triangles, settings_, coding_->connectivity(),
                      header.num_frames != 1);
  meshes_.emplace(coding_->mesh().topology, coding_->mesh().triangles, true);
  format_.triangles = {};
  return std::nullopt;
}

std::optional<InputError> LowDelayEncoder::begin_stream(std::span<const float> xyz) {
  SpanBuffer frame(format_.num_vertices, 1);
  frame.add(xyz, {});
  const auto measured = measure_extent(frame);
  if (!measured) return measured.error();
  SequenceHeader header = coding_->header();
  const Target target = target_for_floats();
  set_grid_of_box(header, format_, target, finest_error(target, measured->rms_spread));
  coding_->set_header(header);
  stream_.emplace(header, settings_, coding_->connectivity());
  const auto frames = coding_->nearest_frames(frame, std::vector<std::uint32_t>{0});
  if (!frames) return frames.error();
  attributes_->encode(*frames, *stream_);
  stream_->write_lead(header, keep_);
  return std::nullopt;
}

std::uint32_t LowDelayEncoder::frames_in_gof() const {
  const std::uint32_t left = coding_->header().num_frames - num_added_;
  const std::uint32_t longest = std::min(longest_gof(settings_, format_.num_vertices), left);
  // GOFs have about the same length if the number of frames is known.
  if (coding_->header().open_end_flag) return longest;
  const std::uint32_t gofs = (left + longest - 1) / longest;
  return (left + gofs - 1) / gofs;
}

// Reduces a maximum error, which is measured from the input's numbers, by the rounding to
// floats.
Target LowDelayEncoder::target_for_floats() const {
  constexpr double kMin = 1e-30;  // fixed: out of reach, if nothing positive is left
  Target target = settings_.target;
  if (target.kind == Target::kMaxError) {
    target.value = std::max(target.value - format_.max_rounding, kMin);
  }
  return target;
}

// Returns the step, in grid steps. rms_spread: RMS of the coordinates about the mean of their
// frame, units; used for the first GOF.
double LowDelayEncoder::step_for(double rms_spread) const {
  const double per_unit = exact_exp2(-coding_->header().grid.log2_step);
  const Target target = target_for_floats();
  if (target.kind == Target::kMaxError) {
    // Coordinates are wrong by half a step, and by half a grid step where they are rounded.
    const double coordinate_error = target.value * per_unit / std::sqrt(3.0);
    return 2.0 * (coordinate_error - 0.5) - 1.0 / kExactInterStep;
  }
  if (step_ > 0.0) return step_ * control_.factor();
  return kAim * target.value / 100.0 * rms_spread * per_unit / kFirstErrorRatio;
}

std::optional<InputError> LowDelayEncoder::begin_gof(std::span<const float> xyz) {
  SpanBuffer frame(format_.num_vertices, 1);
  frame.add(xyz, {});
  const auto extent = measure_extent(frame);
  if (!extent) return extent.error();
  const OrderedMesh& layers = (*meshes_)[Prediction::kLayers];
  step_ = std::max(step_for(extent->rms_spread), 1.0 / kExactInterStep);
  gof_ = std::make_unique<Gof>();
  gof_->settings =
      choose_frame_settings(coding_->header(), settings_, layers,
                            settings_.inter.pattern.value_or(FramePattern{}), step_);
  control_.start_again();
  gof_->settings.step_delta_flag = settings_.target.kind == Target::kKg;
  gof_->settings.max_earlier_distance = 1;
  if (auto error = divide(xyz)) return error;
  if (auto error = code_first(xyz, layers)) return error;
  gof_->announced = frames_in_gof();
  gof_->coding.emplace(layers, gof_->settings, coding_->header(), gof_->announced, UnitLimits{},
                       residual_rule(settings_, gof_->settings.pattern));
  const GofHeader header{GofKind::kInter, num_added_, gof_->announced};
  const Bytes unit = write_unit(
      UnitType::kGof, write_inter_gof_unit(header, gof_->settings, layers.topology()));
  stream_->begin_gof(unit, keep_);
  return std::nullopt;
}

// Makes patches, if wanted, from the first frame: no motion is known yet.
std::optional<InputError> LowDelayEncoder::divide(std::span<const float> xyz) {
  const std::uint32_t count = settings_.inter.patches.value_or(0);
  if (count == 0) return std::nullopt;
  SpanBuffer buffer(format_.num_vertices, 1);
  buffer.add(xyz, {});
  const auto frame = coding_->read_frames(buffer, {0, 1, 1});
  if (!frame) return frame.error();
  set_patches(gof_->settings, divide_into_patches(coding_->header(), settings_, *frame,
                                                  coding_->mesh().triangles, count));
  return std::nullopt;
}

std::optional<InputError> LowDelayEncoder::code_first(std::span<const float> xyz,
                                                      const OrderedMesh& layers) {
  if (settings_.target.kind == Target::kMaxError) return std::nullopt;  // axes may add a little
  SpanBuffer buffer(format_.num_vertices, 1);
  buffer.add(xyz, {});
  const auto frame = coding_->read_frames(buffer, {0, 1, 1});
  if (!frame) return frame.error();
  gof_->first =
      code_first_frame(layers, gof_->settings, coding_->header(), settings_, frame->xyz);
  if (gof_->first) gof_->settings.rest = gof_->first->settings;
  return std::nullopt;
}

std::optional<InputError> LowDelayEncoder::code_frame(std::span<const float> xyz,
                                                      std::span<const double> exact) {
  SpanBuffer buffer(format_.num_vertices, 1);
  buffer.add(xyz, exact);
  const auto frame = coding_->read_frames(buffer, {0, 1, 1});
  if (!frame) return frame.error();
  std::vector<std::int32_t> positions(xyz.size());
  std::vector<EncodedSpan::Unit> units;
  if (are_equal_on_grid(frame->xyz, gof_->before)) {
    units = gof_->coding->repeat(1, positions);
  } else if (gof_->first) {
    units = gof_->coding->code_in_order(*gof_->first, positions);
    gof_->first.reset();
  } else {
    units = gof_->coding->code(frame->xyz, positions);
  }
  gof_->before = frame->xyz;
  for (const auto& unit : units) {
    stream_->add_to_gof(write_unit(unit.type, unit.payload), keep_);
  }
  std::mutex reading;
  const auto decode = [&](std::uint32_t, std::span<std::int32_t> out) {
    std::copy(positions.begin(), positions.end(), out.begin());
  };
  const auto measured = coding_->measure({buffer, reading}, {0, 1, 1}, decode, metrics_);
  if (!measured) return measured.error();
  StreamVerifier& verifier =
      out_.verifier(coding_->header(), coding_->connectivity(), num_threads_);
  std::vector<double> original(xyz.size());
  if (auto error = buffer.read_exact(0, original)) return error;
  if (auto error = verifier.expect(positions, original)) return error;
  ++num_added_;
  ++gof_->coded;
  if (settings_.target.kind == Target::kKg) follow_error();
  return std::nullopt;
}

void LowDelayEncoder::follow_error() {
  const Metrics so_far = metrics_.result();
  const double sum = so_far.rms_error * so_far.rms_error * num_added_;
  const double last = sum - std::exchange(squared_error_, sum);
  const double kg = so_far.kg_error_percent;
  if (!(kg > 0.0) || !std::isfinite(kg)) return;
  const double aim = kAim * settings_.target.value / kg * so_far.rms_error;
  control_.add(last / (aim * aim), num_added_ - sum / (aim * aim));
  gof_->coding->set_step_delta(control_.delta());
}

void LowDelayEncoder::end_gof() {
  if (gof_->coded < gof_->announced) {
    stream_->add_to_gof(write_unit(UnitType::kFrame, write_gof_end(gof_->coded)), keep_);
  }
  stream_->end_gof(gof_->coded);
  gof_.reset();
}

// Verifies frames: those of an open-ended stream one by one, others when their GOF is complete.
std::optional<InputError> LowDelayEncoder::verify() {
  const Stage stage("verification");
  if (gof_ && !coding_->header().open_end_flag) return std::nullopt;
  return out_.verifier(coding_->header(), coding_->connectivity(), num_threads_)
      .check_expected();
}

std::optional<InputError> LowDelayEncoder::add_frame(std::span<const float> xyz,
                                                     std::span<const double> exact) {
  if (failure_) return failure_;
  const Stage stage("inter GOFs");
  if (auto error = check_frame(format_, num_added_, xyz, exact)) return error;
  const Threads threads(num_threads_);
  if (!stream_) {
    if (auto error = begin_stream(xyz)) return fail(*error);
  }
  if (!gof_) {
    if (auto error = begin_gof(xyz)) return fail(*error);
  }
  if (auto error = code_frame(xyz, exact)) return fail(*error);
  if (num_added_ == 1) {
    if (auto error = out_.check_contents(attributes_->has_sets())) return fail(*error);
  }
  if (gof_->coded == gof_->announced) end_gof();
  if (auto error = verify()) return fail(*error);
  if (auto error = out_.pass_on(sink_)) return fail(*error);
  return std::nullopt;
}

InputResult<EncodeReport> LowDelayEncoder::finish() {
  if (failure_) return *failure_;
  if (auto error = check_count(format_, num_added_)) return fail(*error);
  if (gof_) end_gof();
  if (auto error = verify()) return fail(*error);
  stream_->write_end(keep_);
  EncodeReport report;
  stream_->describe(coding_->header(), coding_->connectivity(), report);
  report.metrics = metrics_.result();
  report.largest_rounding = out_.largest_rounding();
  if (auto error = out_.finish(report.metrics, sink_)) return fail(*error);
  report.attributes = attributes_->reports();
  report.step = step_ * exact_exp2(coding_->header().grid.log2_step);
  const Target& target = settings_.target;
  if (target.kind == Target::kKg) {
    report.target_met = report.metrics.kg_error_percent <= target.value;
  } else if (target.kind == Target::kMaxError) {
    report.target_met = report.metrics.max_error <= target.value;
  }
  failure_ = InputError{"the stream is finished already"};
  return report;
}

}  // namespace rlpc
