#include "decoder/codec/gofs/prefetch.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/gofs/async.h"

namespace rlpc {

namespace {

bool is_done(const std::future<bool>& done) {
  return done.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

// Keeps the future, as its destructor would wait.
void Prefetch::drop(List& from, List::iterator which) {
  dropped_.splice(dropped_.end(), from, which);
  dropped_.remove_if([](const Ahead& ahead) { return is_done(ahead.done); });
  while (dropped_.size() > max_asked_) dropped_.pop_front();
}

void Prefetch::clear() {
  while (!gofs_.empty()) drop(gofs_, gofs_.begin());
}

std::optional<Prefetch::Found> Prefetch::take(List& from, List::iterator which) {
  std::optional<Found> found;
  if (which->done.get() && which->gof) {
    found = Found{std::move(*which->gof), which->coded.end()};
    for (const auto& rig : which->new_rigs) {
      if (const ParsedRig* const parsed = parse(*rig)) {
        stream_.rigs().add(rig->offset, rig->end, *parsed);
      }
    }
  }
  from.erase(which);
  return found;
}

std::optional<Prefetch::Found> Prefetch::take(std::uint64_t offset, std::uint32_t first_frame) {
  const auto is_it = [&](const Ahead& ahead) { return ahead.is_at(offset, first_frame); };
  std::optional<Found> found;
  if (!gofs_.empty() && is_it(gofs_.front())) found = take(gofs_, gofs_.begin());
  const auto asked = std::find_if(asked_.begin(), asked_.end(), is_it);
  if (asked != asked_.end()) {
    if (!found) found = take(asked_, asked);
    return found;
  }
  if (!found) clear();
  return found;
}

void Prefetch::start(Ahead& ahead) {
  ahead.done = run_async([this, &ahead] {
    const ThreadPool::Use use(threads_);
    ahead.gof = parse(ahead);
    if (ahead.gof) ahead.gof->recon->make_ready(ahead.first_wanted);
  });
}

void Prefetch::fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count) {
  while (!gofs_.empty() && gofs_.front().coded.gof.first_frame != first_frame) {
    drop(gofs_, gofs_.begin());
  }
  if (gofs_.empty()) {
    if (!start_slots(offset)) return;
  } else {
    offset = gofs_.back().coded.end();
    first_frame = gofs_.back().coded.end_frame();
  }
  while (gofs_.size() < count && first_frame < stream_.header().num_frames) {
    auto next = collect(offset, first_frame);
    if (!next) return;
    offset = next->coded.end();
    first_frame = next->coded.end_frame();
    slots_ = next->rigs;
    gofs_.push_back(std::move(*next));
    start(gofs_.back());
  }
}

bool Prefetch::has_asked(std::uint32_t frame) const {
  const auto has_it = [&](const Ahead& ahead) {
    return frame >= ahead.coded.gof.first_frame && frame < ahead.coded.end_frame();
  };
  return std::any_of(asked_.begin(), asked_.end(), has_it) ||
         std::any_of(gofs_.begin(), gofs_.end(), has_it);
}

void Prefetch::ask(const GofPlace& place, std::uint32_t frame) {
  if (has_asked(frame)) return;
  while (asked_.size() >= max_asked_) drop(asked_, asked_.begin());
  auto ahead = collect_at(place);
  if (!ahead) return;
  ahead->first_wanted = frame - place.first_frame;
  asked_.push_back(std::move(*ahead));
  start(asked_.back());
}

// Collects the units of a GOF, and of the shared rigs that must be parsed before it.
std::optional<Prefetch::Ahead> Prefetch::collect_at(const GofPlace& place) {
  std::uint64_t bytes_left = max_memory_bytes_;
  Ahead ahead;
  for (const StreamRigs::Alive& alive : stream_.rigs().find_alive(place.offset)) {
    auto& slot = ahead.rigs[alive.rig_idx];
    if (alive.rig) {
      slot = make_shared_owned<RigAhead>();
      slot->is_tried = true;
      slot->parsed = ParsedRig{alive.rig_idx, alive.rig, {}, 0};
      continue;
    }
    const auto unit = stream_.units().header_at(alive.offset);
    if (!unit || unit->type() != UnitType::kRig) return std::nullopt;
    auto rig = collect_rig(*unit, bytes_left);
    if (!rig) return std::nullopt;
    for (const RawUnit& part : rig->coded) bytes_left -= part.payload.size();
    rig->before = ahead.rigs;
    slot = rig;
    ahead.new_rigs.push_back(std::move(rig));
  }
  const auto unit = stream_.units().header_at(place.offset);
  if (!unit || unit->type() != UnitType::kGof) return std::nullopt;
  auto coded = stream_.access_units().collect(*unit, place.first_frame, bytes_left);
  if (!coded) return std::nullopt;
  ahead.coded = std::move(*coded);
  return ahead;
}

void Prefetch::hand_over_rigs() {
  if (gofs_.empty() || gofs_.front().coded.gof.first_frame != stream_.next_first_frame())
    return;
  for (const auto& rig : gofs_.front().new_rigs) {
    const ParsedRig* parsed = parse(*rig);
    if (parsed == nullptr) return;
    stream_.rigs().add(rig->offset, rig->end, *parsed);
  }
}

// Sets slots_ to the rigs alive at an offset of the stream.
bool Prefetch::start_slots(std::uint64_t offset) {
  slots_ = {};
  const auto rigs = stream_.rigs().at(offset);
  if (!rigs) return false;
  for (std::size_t m = 0; m < slots_.size(); ++m) {
    if (!rigs->slots[m]) continue;
    slots_[m] = make_shared_owned<RigAhead>();
    slots_[m]->is_tried = true;
    slots_[m]->parsed = ParsedRig{static_cast<std::uint32_t>(m), rigs->slots[m], {}, 0};
  }
  return true;
}

// Finds the next GOF, past ancillary units and shared rigs. Reads nothing past the end of the
// sequence.
std::optional<Prefetch::Ahead> Prefetch::collect(std::uint64_t offset,
                                                 std::uint32_t first_frame) {
  UnitReader& units = stream_.units();
  std::uint64_t bytes_left = max_memory_bytes_;
  Ahead ahead;
  ahead.rigs = slots_;
  while (offset < units.size()) {
    const auto unit = units.header_at(offset);
    if (!unit) return std::nullopt;
    offset = unit->end();
    if (unit->type() == UnitType::kGof) {
      auto coded = stream_.access_units().collect(*unit, first_frame, bytes_left);
      if (!coded) return std::nullopt;
      ahead.coded = std::move(*coded);
      return ahead;
    }
    if (unit->ancillary()) continue;
    if (unit->type() != UnitType::kRig || ahead.new_rigs.size() == kMaxRigs) {
      return std::nullopt;
    }
    auto rig = collect_rig(*unit, bytes_left);
    if (!rig) return std::nullopt;
    for (const RawUnit& part : rig->coded) bytes_left -= part.payload.size();
    rig->before = ahead.rigs;
    const RawUnit& first = rig->coded.front();
    BitReader r = units.bits(first.header, first.payload);
    ahead.rigs[parse_rig_idx(r)] = rig;
    offset = rig->end;
    ahead.new_rigs.push_back(std::move(rig));
  }
  return std::nullopt;
}

std::shared_ptr<Prefetch::RigAhead> Prefetch::collect_rig(const UnitHeader& unit,
                                                          std::uint64_t max_bytes) {
  auto coded = stream_.access_units().collect_rig(unit, max_bytes);
  if (!coded) return nullptr;
  auto rig = make_shared_owned<RigAhead>();
  rig->offset = unit.offset;
  rig->end = coded->back().header.end();
  rig->coded = std::move(*coded);
  return rig;
}

const ParsedRig* Prefetch::parse(RigAhead& rig) const {
  const std::lock_guard lock(rig.parsing);
  if (!rig.is_tried) {
    const auto before = parse(rig.before);
    rig.before = {};
    if (before) {
      auto parsed =
          stream_.access_units().parse_rig(rig.coded, *before, cut_, max_memory_bytes_);
      if (parsed) rig.parsed = std::move(*parsed);
    }
    rig.coded = {};
    rig.is_tried = true;
  }
  return rig.parsed ? &*rig.parsed : nullptr;
}

std::optional<RigSlots> Prefetch::parse(const Slots& slots) const {
  RigSlots rigs;
  for (std::size_t m = 0; m < slots.size(); ++m) {
    if (!slots[m]) continue;
    const ParsedRig* parsed = parse(*slots[m]);
    if (parsed == nullptr || parsed->rig_idx != m) return std::nullopt;
    rigs.slots[m] = parsed->rig;
  }
  return rigs;
}

std::optional<PreparedGof> Prefetch::parse(const Ahead& ahead) const {
  const auto rigs = parse(ahead.rigs);
  if (!rigs) return std::nullopt;
  auto access_unit = stream_.access_units().parse(ahead.coded, *rigs, cut_, max_memory_bytes_);
  if (!access_unit) return std::nullopt;
  return prepare(std::move(*access_unit), stream_.context(), rigs_, max_frame_bytes_);
}

}  // namespace rlpc
