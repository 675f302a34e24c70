#include "decoder/codec/recon/rig_recons.h"

#include <algorithm>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {

void RigRecons::erase_unused() {
  const std::lock_guard lock(listing_);
  std::erase_if(entries_, [](const auto& entry) { return entry->rig.use_count() == 1; });
}

std::shared_ptr<RigRecons::Entry> RigRecons::entry_of(
    const std::shared_ptr<const SharedRig>& rig) {
  const std::lock_guard lock(listing_);
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& entry) { return entry->rig == rig; });
  if (found != entries_.end()) return *found;
  return entries_.emplace_back(make_shared_owned<Entry>(rig));
}

std::shared_ptr<const RigRecon> RigRecons::of(const std::shared_ptr<const SharedRig>& rig) {
  erase_unused();
  const std::shared_ptr<Entry> entry = entry_of(rig);
  const std::lock_guard lock(entry->making);
  if (!entry->recon) {
    entry->recon = make_shared_owned<RigRecon>((*context_.meshes)[rig->prediction], *rig,
                                               context_.header.position_bits, true);
  }
  return entry->recon;
}

}  // namespace rlpc
