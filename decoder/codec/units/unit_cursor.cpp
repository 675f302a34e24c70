#include "decoder/codec/units/unit_cursor.h"

namespace rlpc {

Result<bool> UnitCursor::advance(const Followers& followers) {
  const bool may_follow = followers.slice || followers.hash;
  if (!may_follow || unit_.type() == UnitType::kGofHash) return false;
  if (!followers.must_go_on && !units_->goes_on_after(end())) return false;
  const auto next = units_->header_at(end());
  if (!next) return next.error();
  const bool follows = (followers.slice && next->type() == *followers.slice) ||
                       (followers.hash && next->type() == UnitType::kGofHash);
  if (follows) unit_ = *next;
  return follows;
}

}  // namespace rlpc
