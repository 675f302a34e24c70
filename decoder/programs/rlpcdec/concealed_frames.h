// Frames to show: after damage, lost frames repeat the last good one.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>

#include "decoder/rlpc_decoder.h"

namespace rlpc {

class ConcealedFrames {
 public:
  // Receives the error, the first lost frame, and the frame with which decoding resumes; none
  // if it does not.
  using Report =
      std::function<void(const Error&, std::uint32_t first, std::optional<std::uint32_t> next)>;

  // Yields frames first to end - 1. decoder: at the first of them; must outlive it. end: none
  // if the number of frames is unknown. report: null if damage is an error.
  ConcealedFrames(Decoder& decoder, std::uint32_t first, std::optional<std::uint32_t> end,
                  Report report)
      : decoder_(decoder), first_(first), end_(end), report_(std::move(report)), next_(first) {}

  // Decodes or repeats a frame. positions: as the previous call left it, as its frame may be
  // repeated. Returns false after the last frame, or an error of the decoder; with a report,
  // only before the first frame.
  Result<bool> next(std::span<std::int32_t> positions);
  // Returns whether the frame of the last call is lost.
  bool is_lost() const { return is_lost_; }

 private:
  Decoder& decoder_;
  std::uint32_t first_;
  std::optional<std::uint32_t> end_;
  Report report_;
  std::uint32_t next_;
  std::uint32_t resume_ = 0;  // frames before this one are lost
  bool is_lost_ = false;
};

}  // namespace rlpc
