#include "decoder/programs/rlpcdec/concealed_frames.h"

#include <algorithm>

namespace rlpc {

Result<bool> ConcealedFrames::next(std::span<std::int32_t> positions) {
  while (!end_ || next_ < *end_) {
    is_lost_ = next_ < resume_;
    if (is_lost_) {
      ++next_;
      return true;
    }
    const auto more = decoder_.next_frame(positions);
    if (more) {
      if (*more) ++next_;
      return more;
    }
    if (!report_ || next_ == first_) return more;
    const auto found = decoder_.skip_damage();
    const bool goes_on = found && *found;
    if (!goes_on && !end_) {
      report_(more.error(), next_, std::nullopt);
      return false;
    }
    resume_ = goes_on ? std::min(**found, end_.value_or(**found)) : *end_;
    report_(more.error(), next_, resume_);
  }
  return false;
}

}  // namespace rlpc
