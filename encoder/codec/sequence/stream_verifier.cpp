#include "encoder/codec/sequence/stream_verifier.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "common/files/float_position.h"
#include "common/verify/stream_rules.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

std::string text_of(double x, int digits = 10) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.*g", digits, x);
  return text.data();
}

// Returns FNV-1a, of 64 bits, so that different frames are not taken for equal by chance.
std::uint64_t hash_of(std::span<const std::int32_t> positions) {
  constexpr std::uint64_t kPrime = 0x100000001b3;  // fixed: FNV
  std::uint64_t hash = 0xcbf29ce484222325;
  for (const std::int32_t value : positions) {
    hash = (hash ^ static_cast<std::uint32_t>(value)) * kPrime;
    hash ^= hash >> 32;
  }
  return hash;
}

double distance(std::span<const double> a, std::span<const float> b, std::size_t vertex) {
  double sum = 0.0;
  for (std::size_t i = 3 * vertex; i < 3 * vertex + 3; ++i) {
    const double d = a[i] - static_cast<double>(b[i]);
    sum += d * d;
  }
  return std::sqrt(sum);
}

std::vector<float> nearest_floats(std::span<const double> exact) {
  std::vector<float> floats(exact.size());
  std::transform(exact.begin(), exact.end(), floats.begin(),
                 [](double x) { return static_cast<float>(x); });
  return floats;
}

// Returns positions in input order. input_vertex: [vertex of positions], index in the input;
// empty: the same.
std::vector<float> in_input_order(const Grid& grid, std::span<const std::int32_t> positions,
                                  std::span<const std::uint32_t> input_vertex) {
  std::vector<float> floats(positions.size());
  for (std::size_t v = 0; 3 * v < positions.size(); ++v) {
    const std::size_t to = 3 * (input_vertex.empty() ? v : std::size_t{input_vertex[v]});
    for (std::size_t c = 0; c < 3; ++c) {
      floats[to + c] = float_position(grid, c, positions[3 * v + c]);
    }
  }
  return floats;
}

}  // namespace

StreamVerifier::StreamVerifier(const EncoderSettings& settings, const SequenceHeader& header,
                               std::span<const std::uint32_t> input_vertex,
                               std::shared_ptr<StreamBuffer> buffer, std::uint32_t threads)
    : settings_(settings),
      header_(header),
      reader_(read_frames(std::move(buffer), threads)),
      positions_(3 * std::size_t{header.num_vertices}),
      metrics_(header.num_vertices, MetricsAccumulator::kTotals) {
  // With a vertex order in the stream, decoders restore that of the input.
  auto& used = settings.keep_order ? output_vertex_ : input_vertex_;
  used.assign(input_vertex.begin(), input_vertex.end());
}

InputError StreamVerifier::fault(const std::string& what) const {
  return InputError{"the encoder has made a mistake, found by decoding what it wrote: " + what +
                        ". Please report it; another 'preset' or 'profile' may avoid it",
                    false, true};
}

std::optional<InputError> StreamVerifier::decode() {
  if (const auto wrong = reader_->next_frame(positions_)) {
    return fault("frame " + std::to_string(num_checked_) + " (from 0): " + *wrong);
  }
  ++num_checked_;
  return std::nullopt;
}

std::optional<InputError> StreamVerifier::check_frame(std::span<const double> exact) {
  if (auto error = decode()) return error;
  const std::vector<float> decoded = in_input_order(header_.grid, positions_, input_vertex_);
  if (auto error = compare_without_loss(num_checked_ - 1, exact, decoded)) return error;
  metrics_.add_frame(exact, decoded, normal_deviation(normal_triangles_, exact, decoded));
  has_metrics_ = true;
  note_rounding(exact);
  return std::nullopt;
}

void StreamVerifier::note_rounding(std::span<const double> exact) {
  const std::vector<float> floats = nearest_floats(exact);
  for (std::size_t v = 0; v < header_.num_vertices; ++v) {
    largest_rounding_ = std::max(largest_rounding_, distance(exact, floats, v));
  }
}

// Compares coordinates: each must be the nearest float or, on a grid of a given number of bits,
// at most half a grid step away before decoders round it to a float.
std::optional<InputError> StreamVerifier::compare_without_loss(
    std::uint32_t frame, std::span<const double> exact, std::span<const float> decoded) const {
  // fixed: numbers halfway between two floats may be read as a little more or less.
  constexpr double kHalfway = 1.0 + 0x1p-20;
  if (settings_.target.kind != Target::kLossless) return std::nullopt;
  const bool is_rounded = settings_.target.value > 0.0;
  const double half = is_rounded ? exact_exp2(header_.grid.log2_step - 1) : 0.0;
  const std::vector<float> floats = nearest_floats(exact);
  for (std::size_t i = 0; i < floats.size(); ++i) {
    const double rounding = std::abs(exact[i] - static_cast<double>(floats[i]));
    const double error = std::abs(exact[i] - static_cast<double>(decoded[i]));
    const double low = static_cast<double>(floats[i]) - half;
    const double high = static_cast<double>(floats[i]) + half;
    if (decoded[i] >= static_cast<float>(low) && decoded[i] <= static_cast<float>(high)) {
      continue;
    }
    if (rounding > 0.0 && error <= rounding * kHalfway + half) continue;
    return fault("frame " + std::to_string(frame) + ", vertex " + std::to_string(i / 3) +
                 " (from 0): " + "xyz"[i % 3] + " becomes " + text_of(decoded[i]) +
                 " instead of " + text_of(floats[i]));
  }
  return std::nullopt;
}

std::optional<InputError> StreamVerifier::check_frames(FrameSource& source, std::uint32_t first,
                                                       std::uint32_t count) {
  std::vector<double> exact(positions_.size());
  for (std::uint32_t f = first; f < first + count; ++f) {
    if (auto error = source.read_exact(f, exact)) return error;
    if (auto error = check_frame(exact)) return error;
  }
  return std::nullopt;
}

std::optional<InputError> StreamVerifier::expect(std::span<const std::int32_t> positions,
                                                 std::span<const double> exact) {
  const auto& input_vertex = settings_.keep_order ? output_vertex_ : input_vertex_;
  const auto frame = num_checked_ + static_cast<std::uint32_t>(expected_.size());
  const std::vector<float> decoded = in_input_order(header_.grid, positions, input_vertex);
  if (auto error = compare_without_loss(frame, exact, decoded)) return error;
  note_rounding(exact);
  std::vector<std::int32_t> output(positions.begin(), positions.end());
  for (std::size_t v = 0; v < output_vertex_.size(); ++v) {
    std::copy_n(&positions[3 * v], 3, &output[3 * std::size_t{output_vertex_[v]}]);
  }
  expected_.push_back(hash_of(output));
  return std::nullopt;
}

std::optional<InputError> StreamVerifier::check_expected() {
  for (; !expected_.empty(); expected_.pop_front()) {
    if (auto error = decode()) return error;
    if (hash_of(positions_) == expected_.front()) continue;
    return fault("frame " + std::to_string(num_checked_ - 1) +
                 " (from 0) is decoded to other positions");
  }
  return std::nullopt;
}

std::optional<InputError> StreamVerifier::finish(const Metrics& reported) {
  if (const auto wrong = reader_->finish()) return fault(*wrong);
  if (!has_metrics_) return std::nullopt;
  const Metrics measured = metrics_.result();
  if (measured.max_error != reported.max_error || measured.rms_error != reported.rms_error) {
    return fault("the largest error is " + text_of(measured.max_error) + " instead of " +
                 text_of(reported.max_error) + ", the RMS error " +
                 text_of(measured.rms_error) + " instead of " + text_of(reported.rms_error));
  }
  const bool are_bounded = settings_.target.max_normals > 0.0;
  if (are_bounded && measured.vertex_normals != reported.vertex_normals) {
    return fault("vertex normals deviate by " + text_of(measured.vertex_normals.value_or(0.0)) +
                 " degrees (RMS) instead of " + text_of(reported.vertex_normals.value_or(0.0)));
  }
  return std::nullopt;
}

InputResult<double> check_rounding(FrameSource& source, double max) {
  if (!source.is_finer_than_floats()) return 0.0;
  const std::size_t n = source.num_vertices();
  std::vector<double> exact(3 * n);
  double farthest = 0.0;
  InputError error;
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (auto failed = source.read_exact(f, exact)) return *failed;
    const std::vector<float> floats = nearest_floats(exact);
    for (std::size_t v = 0; v < n; ++v) {
      const double d = distance(exact, floats, v);
      if (d <= farthest) continue;
      farthest = d;
      error.message = source.file_of(f) + ": frame " + std::to_string(f) + ", vertex " +
                      std::to_string(v) + " (both from 0): " + text_of(exact[3 * v], 15) + " " +
                      text_of(exact[3 * v + 1], 15) + " " + text_of(exact[3 * v + 2], 15) +
                      " is " + text_of(d, 4) + " from the nearest 32-bit floats";
    }
  }
  if (farthest <= max) return farthest;
  error.message +=
      ", the farthest of all, and decoded positions are floats: the largest error "
      "cannot be " +
      text_of(max) + ". Move the animation to the origin, or allow a larger error";
  return error;
}

std::optional<InputError> check_rules(const EncoderSettings& settings, bool has_attributes,
                                      const std::shared_ptr<StreamBuffer>& stream,
                                      std::uint64_t end_of_first_gof) {
  const bool has_contents = has_attributes || !settings.metadata.empty() ||
                            !settings.clips.empty() || !settings.asset.empty();
  if (!settings.check_rules && !has_contents) return std::nullopt;
  const auto broken = settings.check_rules
                          ? find_broken_rule(stream, stream->size(), RuleScope::kAll)
                          : find_broken_rule(stream, end_of_first_gof, RuleScope::kContents);
  if (!broken) return std::nullopt;
  return InputError{"the stream would not conform: " + *broken, false, true};
}

}  // namespace rlpc
