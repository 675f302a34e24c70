// RLPC encoder for frames that come one after another: a public interface beside
// rlpc_encoder.h, for those who cannot go back to earlier frames, or hold all of them.
//
//   auto encoder = rlpc::FrameEncoder::create(format, settings, sink);
//   if (!encoder) return complain(encoder.error().message);
//   for (const auto& xyz : frames) {
//     if (const auto error = encoder->add_frame(xyz)) return complain(error->message);
//   }
//   const auto report = encoder->finish();
//
// GOFs are of equal length, at most settings.gof_frames (128 by default), and each is encoded
// when its last frame is there: its bytes go to the sink at once. Memory is that of one GOF and
// its analysis, of the mesh, and 16 bytes for each GOF (the index), however long the sequence.
//
// Where encode() meets the target over the whole sequence, here each GOF meets it by itself,
// within 2 % where encode() does: KG error relative to the spread of its own frames; largest
// error; or bits, with a share of all that is no GOF by the number of its frames. So the whole
// stream meets it as well. GOFs that do not vary alike cost more this way than with encode().
//
// The level stands before the first GOF and cannot be changed later: it is the lowest that
// allows the mesh, the GOFs, and twice what the first GOF needed of factors, clusters,
// components and bytes. A later GOF that needs more is an error, which FrameFormat::least_level
// avoids.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/mesh/mesh.h"
#include "encoder/rlpc_encoder.h"

namespace rlpc {

// What has to be known before the first frame.
struct FrameFormat {
  std::uint32_t num_vertices = 0;  // at least 1
  std::uint32_t num_frames = 0;    // at least 1: as many frames have to come
  FrameRate frame_rate;
  std::vector<Triangle> triangles;  // indices below num_vertices; may be empty
  // No coordinate of any frame is outside. A box that is far too large makes the grid coarser.
  std::array<float, 3> box_min{};
  std::array<float, 3> box_max{};
  std::uint32_t least_level = 1;  // of the stream, 1 to 4
};

class FrameEncoder {
 public:
  // Errors: a format that cannot be; settings that encode() would refuse; what no level allows.
  // Nothing goes to the sink before the first GOF is encoded.
  static InputResult<FrameEncoder> create(FrameFormat format, EncoderSettings settings,
                                          ByteSink sink);
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;
  ~FrameEncoder();

  // The next frame: [num_vertices][3], in units. Errors: a wrong number of values; a coordinate
  // outside the box, or not a number, with frame, vertex and axis; more frames than announced;
  // a GOF beyond the level; a sink that failed. After an error, all calls repeat it.
  std::optional<InputError> add_frame(std::span<const float> xyz);
  // After the last frame: writes the end of the stream. Errors: fewer frames than announced; a
  // sink that failed. Metrics are those of the whole sequence, without those of each frame;
  // step is that of the last GOF; target_met: by every GOF.
  InputResult<EncodeReport> finish();

  // Frames so far.
  std::uint32_t num_added() const;

 private:
  class Impl;
  explicit FrameEncoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rlpc
