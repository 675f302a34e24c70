#include "decoder/codec/gofs/model_recons.h"

#include <algorithm>
#include <utility>

#include "common/memory/owned.h"

namespace rlpc {

void ModelRecons::erase_unused() {
  const std::lock_guard lock(listing_);
  std::erase_if(entries_, [](const auto& entry) { return entry->model.use_count() == 1; });
}

std::shared_ptr<ModelRecons::Entry> ModelRecons::entry_of(
    const std::shared_ptr<const SkinnedModel>& model) {
  const std::lock_guard lock(listing_);
  const auto found = std::find_if(entries_.begin(), entries_.end(),
                                  [&](const auto& entry) { return entry->model == model; });
  if (found != entries_.end()) return *found;
  return entries_.emplace_back(make_shared_owned<Entry>(model));
}

std::shared_ptr<const ModelRecon> ModelRecons::of(
    const std::shared_ptr<const SkinnedModel>& model) {
  erase_unused();
  const std::shared_ptr<Entry> entry = entry_of(model);
  const std::lock_guard lock(entry->making);
  if (!entry->recon) {
    entry->recon = make_shared_owned<ModelRecon>((*context_.meshes)[model->prediction], *model,
                                                 context_.header.position_bits, true);
  }
  return entry->recon;
}

}  // namespace rlpc
