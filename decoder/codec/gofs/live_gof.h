// Inter GOF of an open-ended stream: decodes each frame as soon as its frame units have arrived
// (8.19.1).
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "common/codec/kinds/inter/recon/inter_recon.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/codec/units/unit_cursor.h"

namespace rlpc {

class LiveGof : public Owned {
 public:
  // Stream and cut must outlive it. Frame units outside the cut are dropped.
  LiveGof(StreamReader& stream, const SliceCut& cut);
  LiveGof(const LiveGof&) = delete;
  LiveGof& operator=(const LiveGof&) = delete;

  // Reads the GOF unit, the next unit of the stream. Must be called once.
  Result<bool> begin(const UnitHeader& gof_unit);
  // Decodes the next frame in output order; waits only for its units. Returns false after the
  // last frame; the stream has then gone past the GOF.
  Result<bool> next();

  // Returns the index in the sequence of the frame that next() decodes.
  std::uint32_t next_frame() const { return first_frame_ + next_output_; }
  // Returns whether next() may decode the frame.
  bool may_have(std::uint32_t frame) const {
    return frame >= next_frame() && frame - first_frame_ < parser_.order().num_frames();
  }
  // Return the last frame that next() decoded, grid units, in decoded order; and its hash, if
  // it has one.
  std::span<const std::int32_t> positions() const { return frame_.positions; }
  const std::optional<FrameCrc>& frame_crc() const { return frame_.crc; }
  bool is_cut() const { return parser_.is_cut(); }

 private:
  struct Decoded {
    Vector<std::int32_t> positions;
    std::optional<FrameCrc> crc;
  };

  Result<bool> read_unit();
  void decode_place();

  StreamReader& stream_;
  UnitHeader gof_unit_;
  std::uint32_t first_frame_ = 0;
  std::optional<UnitCursor> cursor_;  // at the last unit that has been read
  InterGofParser parser_;
  std::optional<InterRecon> recon_;
  bool ended_ = false;
  std::uint32_t next_output_ = 0;        // NextOutput
  Map<std::uint32_t, Decoded> waiting_;  // frames decoded before their turn
  Decoded frame_;
};

}  // namespace rlpc
