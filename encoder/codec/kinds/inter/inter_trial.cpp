#include "encoder/codec/kinds/inter/inter_trial.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "encoder/codec/kinds/inter/earlier_frames.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/write/write_inter_gof.h"

namespace rlpc {
namespace {

// Decodes without frames of higher temporal layers. coded: in coding order.
DecodeFrame decode_cut(const OrderedMesh& mesh, const InterSettings& s,
                       const std::vector<InterFrame>& coded, int position_bits,
                       std::uint32_t temporal_layers) {
  const DecodedSpan decoded(mesh.num_vertices(), static_cast<std::uint32_t>(coded.size()));
  const FrameOrder order(s.pattern, static_cast<std::uint32_t>(coded.size()));
  InterRecon recon(mesh, s, position_bits);
  for (std::uint32_t place = 0; place < order.num_frames(); ++place) {
    const FramePlace& next = order[place];
    const bool is_there = s.pattern.temporal_layer(next.depth) < temporal_layers;
    recon.decode(next, order.last_use(next.frame), is_there ? coded[place] : InterFrame{});
    recon.positions(decoded.frame(next.frame));
  }
  return decoded.decoder();
}

// Returns earlier_frames() of a GOF, as far as its level allows.
std::vector<EarlierFrame> earlier_of(const SequenceHeader& header, const SpanFrames& frames,
                                     const FramePattern& pattern) {
  const std::size_t values = 3 * std::size_t{frames.num_vertices};
  const std::uint64_t max = header.level().max_gof_factors / values;
  return earlier_frames(
      pattern, frames.xyz, values,
      static_cast<std::uint32_t>(std::min<std::uint64_t>(max, frames.num_frames)));
}

InterSettings with_distance(InterSettings settings, const std::vector<EarlierFrame>& earlier) {
  for (const EarlierFrame& frame : earlier) {
    settings.max_earlier_distance = std::max(settings.max_earlier_distance, frame.distance);
  }
  return settings;
}

InterSettings with_first(InterSettings settings, const RestEncoding* first) {
  if (first != nullptr) settings.rest = first->settings;
  return settings;
}

}  // namespace

DecodedSpan::DecodedSpan(std::uint32_t num_vertices, std::uint32_t num_frames)
    : values_(3 * std::size_t{num_vertices}),
      positions_(std::make_shared<std::vector<std::int32_t>>(values_ * num_frames)) {}

DecodeFrame DecodedSpan::decoder() const {
  return [span = *this](std::uint32_t f, std::span<std::int32_t> out) {
    std::copy_n(span.frame(f).begin(), span.values_, out.begin());
  };
}

InterTrial::InterTrial(const OrderedMesh& mesh, const SequenceHeader& header,
                       const SpanFrames& frames, const InterSettings& settings,
                       const UnitLimits& limits, const InterChoice& choice, ResidualRule rule,
                       std::uint32_t num_frames, std::shared_ptr<const RestEncoding> first)
    : mesh_(mesh),
      header_(header),
      frames_(frames),
      choice_(choice),
      earlier_(earlier_of(header, frames, settings.pattern)),
      first_(std::move(first)),
      settings_(with_first(with_distance(settings, earlier_), first_.get())),
      coding_(mesh, settings_, header, frames.num_frames, limits, rule),
      decoded_(frames.num_vertices, frames.num_frames),
      num_frames_(num_frames),
      bits_of_pattern_(settings.pattern.num_depths(), 0.0) {
  const GofHeader gof{GofKind::kInter, frames.first_frame, frames.num_frames};
  add({{UnitType::kGof, write_inter_gof_unit(gof, settings_, mesh.topology())}});
  if (settings_.pattern.temporal_layers > 1) {
    coded_ = std::make_shared<std::vector<InterFrame>>();
  }
}

void InterTrial::add(std::vector<EncodedSpan::Unit> units) {
  bits_of_units_ += bits_of(units);
  std::move(units.begin(), units.end(), std::back_inserter(encoded_.units));
}

void InterTrial::code_to(std::uint32_t count) {
  const std::size_t values = 3 * std::size_t{frames_.num_vertices};
  for (; num_coded_ < count; ++num_coded_) {
    const FramePlace& place = coding_.next_place();
    const auto xyz = frame_xyz(place.frame);
    const auto positions = decoded_.frame(place.frame);
    InterFrame* const copy = coded_ ? &coded_->emplace_back() : nullptr;
    if (num_coded_ == 0 && first_) {
      add(coding_.code_in_order(*first_, positions, copy));
    } else if (earlier_[num_coded_].is_equal) {
      add(coding_.repeat(earlier_[num_coded_].distance, positions, copy));
    } else {
      const std::uint32_t distance = reference_distance(place);
      const double before = bits();
      add(coding_.code(xyz, positions, copy, distance));
      if (distance == 0) bits_of_pattern_[place.depth] = bits() - before;
    }
    if (num_coded_ == 0) bits_of_start_ = bits();
    bits_after_.push_back(bits());
    for (std::size_t i = 0; i < values; ++i) {
      const double d = positions[i] - xyz[i];
      squared_error_ += d * d;
    }
  }
}

// Returns the distance to the frame that predicts the next one instead of its references, if
// both their expected cost and the cost of the last frame are higher; else 0.
std::uint32_t InterTrial::reference_distance(const FramePlace& place) const {
  const std::uint32_t distance = earlier_[num_coded_].distance;
  if (distance == 0) return 0;
  const std::uint32_t step = settings_.step[place.depth];
  const auto xyz = frame_xyz(place.frame);
  const double from_earlier =
      bits_from(mesh_, xyz, frame_xyz(coding_.frame_before(distance)), step);
  const double before = bits_of_pattern_[place.depth];
  if (before > 0.0 && from_earlier >= before) return 0;
  const std::vector<double> reference =
      reference_of(place, frame_xyz(place.first), frame_xyz(place.second));
  return from_earlier < bits_from(mesh_, xyz, reference, step) ? distance : 0;
}

// Returns the bits of a frame other than the first, expected in a GOF of so many frames.
double InterTrial::bits_of_later(std::uint32_t num_frames) const {
  const std::uint32_t half = (num_coded_ - 1) / 2;
  if (half == 0) return bits() - bits_of_start_;
  const double mean = (bits() - bits_of_start_) / (num_coded_ - 1.0);
  if (settings_.pattern.kind != FramePattern::kFirst) return mean;
  // Frames move away from the first, as a random walk does: with the root of their distance.
  const double early = (bits_after_[half] - bits_after_[0]) / half;
  const double late = (bits_after_.back() - bits_after_[num_coded_ - 1 - half]) / half;
  const double near = std::sqrt(0.5 * half);
  const double grown =
      (std::sqrt(0.5 * num_frames) - near) / (std::sqrt(half + 0.5 * half) - near);
  return std::max(mean, early + grown * (late - early));
}

SpanCost InterTrial::expected(std::uint32_t num_frames) const {
  return {bits_of_start_ + (num_frames - 1.0) * bits_of_later(num_frames),
          squared_error_ * num_frames / num_coded_};
}

double InterTrial::cost() const {
  const double bits = expected(num_frames_).bits;
  return settings_.exact_flag ? bits : bits_at_equal_error(bits, squared_error_);
}

EncodedSpan InterTrial::finish() {
  code_to(frames_.num_frames);
  encoded_.choices = {choice_};
  encoded_.squared_error = squared_error_;
  encoded_.frame = decoded_.decoder();
  if (coded_) {
    encoded_.cut = [mesh = &mesh_, s = settings_, coded = coded_,
                    bits = header_.position_bits](int max) {
      return decode_cut(*mesh, s, *coded, bits, static_cast<std::uint32_t>(max));
    };
  }
  return std::move(encoded_);
}

}  // namespace rlpc
