// The frames to be shown: after damage, the last one before it stands for those that are lost.
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
  // The error, the first frame that is lost, and the one with which decoding goes on; none: it
  // does not.
  using Report =
      std::function<void(const Error&, std::uint32_t first, std::optional<std::uint32_t> next)>;

  // Frames first to end - 1; the decoder, which must outlive it, is at the first. end: none if
  // the number of frames is not known. report: null if damage is an error.
  ConcealedFrames(Decoder& decoder, std::uint32_t first, std::optional<std::uint32_t> end,
                  Report report)
      : decoder_(decoder), first_(first), end_(end), report_(std::move(report)), next_(first) {}

  // positions: as the call before left it, since that frame may be needed again. False after
  // the last frame. Errors: those of the decoder; with a report, only before any frame.
  Result<bool> next(std::span<std::int32_t> positions);
  // Whether the frame of the last call is lost.
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
