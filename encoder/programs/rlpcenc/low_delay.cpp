#include "encoder/programs/rlpcenc/low_delay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "encoder/codec/sequence/stream_verifier.h"
#include "encoder/frame_encoder.h"

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
  // Makes room for unknown frames: a cube around the centre.
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

// Returns how far floats within a box may be from the coordinates that they are rounded from.
double rounding_in(const FrameFormat& format) {
  float largest = 0.0F;
  for (std::size_t c = 0; c < 3; ++c) {
    largest = std::max({largest, std::abs(format.box_min[c]), std::abs(format.box_max[c])});
  }
  const double spacing =
      double{std::nextafter(largest, std::numeric_limits<float>::infinity())} - largest;
  return 0.5 * std::sqrt(3.0) * spacing;
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
                     source.triangles(),    source.attributes(), source.clips(),
                     source.asset()};
  std::vector<float> xyz(3 * std::size_t{format.num_vertices});
  std::vector<double> exact(source.is_finer_than_floats() ? xyz.size() : 0);
  BoxOfFrames box;
  for (std::uint32_t f = 0; f < format.num_frames && !options.box; ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    box.add(xyz);
  }
  use_box(options.box.value_or(box.box()), format);
  const Target& target = options.settings.target;
  if (target.kind == Target::kMaxError) {
    const auto rounding = check_rounding(source, target.value);
    if (!rounding) return rounding.error();
    format.max_rounding = *rounding;
  }
  auto encoder = FrameEncoder::create(format, options.settings, sink);
  if (!encoder) return encoder.error();
  for (std::uint32_t f = 0; f < format.num_frames; ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    if (!exact.empty()) {
      if (auto error = source.read_exact(f, exact)) return *error;
    }
    if (auto error = encoder->add_frame(xyz, exact)) return *error;
    progress(static_cast<double>(f + 1) / format.num_frames);
  }
  return finish(*encoder, std::nullopt);
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
  // Future frames are within the box, too.
  if (!stream.exact().empty()) format.max_rounding = rounding_in(format);
  auto encoder = FrameEncoder::create(format, options.settings, sink);
  if (!encoder) return encoder.error();
  while (more && *more) {
    if (auto error = encoder->add_frame(xyz, stream.exact())) {
      error->message = shape.name + ": " + error->message;
      if (!options.box) error->message += " (8 times the size of the first frame; see --box)";
      return finish(*encoder, std::move(error));
    }
    if (!flush()) return InputError{"the stream could not be written"};
    more = stream.next_frame(xyz);
  }
  return finish(*encoder, more ? std::nullopt : std::optional(more.error()));
}

}  // namespace rlpc
