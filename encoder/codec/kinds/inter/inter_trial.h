// One encoding of an inter GOF at one step, which can stop between frames.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/kinds/inter/closed_loop.h"
#include "encoder/codec/kinds/inter/earlier_frames.h"
#include "encoder/codec/rest/rest_coding.h"
#include "encoder/codec/spans/span_coder.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Positions of all frames of a span, as a decoder outputs them. Copies share them.
class DecodedSpan {
 public:
  DecodedSpan(std::uint32_t num_vertices, std::uint32_t num_frames);

  std::span<std::int32_t> frame(std::uint32_t f) const {
    return std::span(*positions_).subspan(f * values_, values_);
  }
  DecodeFrame decoder() const;

 private:
  std::size_t values_;
  std::shared_ptr<std::vector<std::int32_t>> positions_;
};

class InterTrial {
 public:
  // The mesh must have layers. Keeps references to mesh, header and frames. Frames that equal
  // earlier ones on the grid are not coded again; frames that nearly equal one are predicted
  // from it if that is cheaper. choice: the choice that the settings were made for. rule: as in
  // ClosedLoop. num_frames: of the GOF that the frames are a sample of. first: unless null, the
  // first frame in an order of its own.
  InterTrial(const OrderedMesh& mesh, const SequenceHeader& header, const SpanFrames& frames,
             const InterSettings& settings, const UnitLimits& limits, const InterChoice& choice,
             ResidualRule rule, std::uint32_t num_frames,
             std::shared_ptr<const RestEncoding> first = nullptr);
  InterTrial(const InterTrial&) = delete;
  InterTrial& operator=(const InterTrial&) = delete;

  const InterChoice& choice() const { return choice_; }
  // Codes frames until the first `count` in coding order are coded.
  void code_to(std::uint32_t count);
  // Estimates the cost of the whole GOF from the frames coded so far: bits at equal error, or
  // bits if it is lossless. At least two frames must be coded, unless there is only one.
  double cost() const;
  // Expects the same of a GOF with `num_frames` frames that goes on like those coded so far.
  SpanCost expected(std::uint32_t num_frames) const;
  // Returns the squared error of the frames coded so far, over all values, squared grid units.
  double squared_error() const { return squared_error_; }
  // Codes the remaining frames. Call it once.
  EncodedSpan finish();

 private:
  void add(std::vector<EncodedSpan::Unit> units);
  double bits_of_later(std::uint32_t num_frames) const;
  double bits() const {
    return bits_of_units_ + 8.0 * static_cast<double>(coding_.unit_bytes());
  }
  std::uint32_t reference_distance(const FramePlace& place) const;
  std::span<const double> frame_xyz(std::uint32_t f) const {
    const std::size_t values = 3 * std::size_t{frames_.num_vertices};
    return std::span(frames_.xyz).subspan(f * values, values);
  }

  const OrderedMesh& mesh_;
  const SequenceHeader& header_;
  const SpanFrames& frames_;
  const InterChoice choice_;
  const std::vector<EarlierFrame> earlier_;  // [place in coding order]
  const std::shared_ptr<const RestEncoding> first_;
  const InterSettings settings_;
  ClosedLoop coding_;
  DecodedSpan decoded_;
  EncodedSpan encoded_;
  std::shared_ptr<std::vector<InterFrame>> coded_;  // null: only one temporal layer
  std::uint32_t num_frames_;
  std::uint32_t num_coded_ = 0;
  double bits_of_units_ = 0.0;
  double bits_of_start_ = 0.0;      // bits of the GOF unit and the first frame
  std::vector<double> bits_after_;  // [place]: bits up to this frame
  // [depth]: bits of the last frame that was predicted as the pattern says; 0: no such frame.
  std::vector<double> bits_of_pattern_;
  double squared_error_ = 0.0;
};

}  // namespace rlpc
