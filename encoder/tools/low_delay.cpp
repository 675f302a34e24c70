#include "encoder/tools/low_delay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "encoder/frame_encoder.h"
#include "encoder/sequence/stream_verifier.h"

namespace rlpc {
namespace {

using Box = std::array<float, 6>;  // smallest x, y, z, then largest

class BoxOfFrames {
 public:
  void add(std::span<const float> xyz) {
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      box_[i % 3] = std::min(box_[i % 3], xyz[i]);
      box_[3 + i % 3] = std::max(box_[3 + i % 3], xyz[i]);
    }
  }
  const Box& box() const { return box_; }
  // Room for frames that are not known: a cube around the centre.
  Box enlarged() const {
    constexpr float kRoom = 8.0F;  // fixed: takes three of the 24 bits of a coordinate
    float widest = 0.0F;
    for (std::size_t c = 0; c < 3; ++c) widest = std::max(widest, box_[3 + c] - box_[c]);
    if (widest == 0.0F) widest = 1.0F;
    Box room{};
    for (std::size_t c = 0; c < 3; ++c) {
      const float centre = 0.5F * box_[c] + 0.5F * box_[3 + c];
      room[c] = centre - 0.5F * kRoom * widest;
      room[3 + c] = centre + 0.5F * kRoom * widest;
    }
    return room;
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Box box_{kInfinity, kInfinity, kInfinity, -kInfinity, -kInfinity, -kInfinity};
};

void use_box(const Box& box, FrameFormat& format) {
  std::copy_n(box.begin(), 3, format.box_min.begin());
  std::copy_n(box.begin() + 3, 3, format.box_max.begin());
}

// How far floats within a box may be from the coordinates that they are rounded from.
double rounding_in(const FrameFormat& format) {
  float largest = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    largest = std::max({largest, std::abs(format.box_min[c]), std::abs(format.box_max[c])});
  }
  const double spacing =
      double{std::nextafter(largest, std::numeric_limits<float>::infinity())} - largest;
  return 0.5 * std::sqrt(3.0) * spacing;
}

// The encoder sees floats: leaves it what their rounding leaves of the error.
void leave_room(double rounding, Target& target) {
  constexpr double kLeast = 1e-30;  // fixed: a target that is out of reach, but valid
  target.value = std::max(target.value - rounding, kLeast);
}

InputResult<LowDelayReport> finish(FrameEncoder& encoder, std::optional<InputError> stopped) {
  if (stopped && encoder.num_added() == 0) return *stopped;
  auto report = encoder.finish();
  if (!report) return stopped ? *stopped : report.error();
  return LowDelayReport{std::move(*report), std::move(stopped)};
}

}  // namespace

InputResult<LowDelayReport> encode_low_delay(FrameSource& source, const EncodeOptions& options,
                                             const ByteSink& sink, const Progress& progress) {
  FrameFormat format{source.num_vertices(), source.num_frames(), source.frame_rate(),
                     source.triangles(), source.attributes()};
  std::vector<float> xyz(3 * std::size_t{format.num_vertices});
  BoxOfFrames box;
  for (std::uint32_t f = 0; f < format.num_frames && !options.box; ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    box.add(xyz);
  }
  use_box(options.box.value_or(box.box()), format);
  EncoderSettings settings = options.settings;
  double rounding = 0.0;
  if (settings.target.kind == Target::kMaxError) {
    const auto largest = check_rounding(source, settings.target.value);
    if (!largest) return largest.error();
    rounding = *largest;
    leave_room(rounding, settings.target);
  }
  auto encoder = FrameEncoder::create(format, settings, sink);
  if (!encoder) return encoder.error();
  for (std::uint32_t f = 0; f < format.num_frames; ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    if (auto error = encoder->add_frame(xyz)) return *error;
    progress(static_cast<double>(f + 1) / format.num_frames);
  }
  auto encoded = finish(*encoder, std::nullopt);
  if (encoded) encoded->report.largest_rounding = rounding;
  return encoded;
}

InputResult<LowDelayReport> encode_live(FrameStream& stream, const EncodeOptions& options,
                                        const ByteSink& sink,
                                        const std::function<bool()>& flush) {
  const FrameStream::Shape& shape = stream.shape();
  FrameFormat format{shape.num_vertices, 0, shape.frame_rate, shape.triangles,
                     shape.attributes};
  std::vector<float> xyz(3 * std::size_t{format.num_vertices});
  auto more = stream.next_frame(xyz);
  if (!more) return more.error();
  if (!*more) return InputError{shape.name + ": has no frames"};
  BoxOfFrames first;
  first.add(xyz);
  use_box(options.box.value_or(first.enlarged()), format);
  EncoderSettings settings = options.settings;
  double rounding = 0.0;
  if (settings.target.kind == Target::kMaxError && shape.is_finer_than_floats) {
    rounding = rounding_in(format);  // frames that are yet to come are within the box, too
    leave_room(rounding, settings.target);
  }
  auto encoder = FrameEncoder::create(format, settings, sink);
  if (!encoder) return encoder.error();
  const auto finish_here = [&](std::optional<InputError> stopped) {
    auto encoded = finish(*encoder, std::move(stopped));
    if (encoded) encoded->report.largest_rounding = rounding;
    return encoded;
  };
  while (more && *more) {
    if (auto error = encoder->add_frame(xyz)) {
      error->message = shape.name + ": " + error->message;
      if (!options.box) error->message += " (8 times the size of the first frame; see --box)";
      return finish_here(std::move(error));
    }
    if (!flush()) return InputError{"the stream could not be written"};
    more = stream.next_frame(xyz);
  }
  return finish_here(more ? std::nullopt : std::optional(more.error()));
}

}  // namespace rlpc
