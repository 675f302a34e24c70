#include "decoder/codec/gofs/gof_cache.h"

#include <algorithm>
#include <utility>

#include "decoder/codec/parse/rig_memory.h"

namespace rlpc {
namespace {

template <class List, class Is>
std::unique_ptr<LoadedGof> take(List& gofs, const Is& is) {
  const auto found = std::find_if(gofs.begin(), gofs.end(), is);
  if (found == gofs.end()) return nullptr;
  std::unique_ptr<LoadedGof> gof = std::move(*found);
  gofs.erase(found);
  return gof;
}

}  // namespace

void GofCache::set_max_bytes(std::uint64_t max_bytes) {
  max_bytes_ = max_bytes;
  drop_excess();
}

void GofCache::put(std::unique_ptr<LoadedGof> gof) {
  if (!gof || gof->gof.memory_bytes > max_bytes_) return;
  gofs_.push_front(std::move(gof));
  drop_excess();
}

void GofCache::drop_excess() {
  while (bytes() > max_bytes_) gofs_.pop_back();
}

std::unique_ptr<LoadedGof> GofCache::take_frame(std::uint32_t frame) {
  return take(gofs_, [&](const auto& gof) { return gof->has_frame(frame); });
}

std::unique_ptr<LoadedGof> GofCache::take_at(std::uint64_t offset) {
  return take(gofs_, [&](const auto& gof) { return gof->offset == offset; });
}

bool GofCache::has_frame(std::uint32_t frame) const {
  return std::any_of(gofs_.begin(), gofs_.end(),
                     [&](const auto& gof) { return gof->has_frame(frame); });
}

std::uint64_t GofCache::bytes() const {
  std::uint64_t sum = 0;
  for (auto gof = gofs_.begin(); gof != gofs_.end(); ++gof) {
    sum += (*gof)->gof.memory_bytes;
    const SharedRig* const rig = (*gof)->gof.rig.get();
    const bool is_first = std::none_of(
        gofs_.begin(), gof, [&](const auto& before) { return before->gof.rig.get() == rig; });
    if (rig != nullptr && is_first) sum += memory_of_rig(*rig);
  }
  return sum;
}

}  // namespace rlpc
