#include "decoder/codec/units/stream_models.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/syntax/stream_format.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/parse_skinned_gof.h"

namespace rlpc {

Error misplaced(const UnitHeader& unit, std::uint32_t version_minor) {
  const bool known = unit.ancillary() || is_known_type(unit.type(), version_minor);
  return Error{known ? Errc::kInvalid : Errc::kUnsupported, known ? "R-UNT-05" : "R-UNT-04",
               "unit_type", unit.offset * 8};
}

void StreamModels::put(std::uint64_t offset, Entry entry) {
  const auto [place, is_new] = entries_.try_emplace(offset);
  if (!is_new) offsets_[place->second.model_idx].erase(offset);
  offsets_[entry.model_idx].insert(offset);
  if (entry.model) kept_.insert(offset);
  place->second = std::move(entry);
}

void StreamModels::add(const Vector<ModelLocation>& locations) {
  for (const ModelLocation& l : locations) {
    if (!entries_.contains(l.offset)) put(l.offset, {l.model_idx, 0, nullptr, {}});
  }
}

void StreamModels::add(std::uint64_t offset, std::uint64_t end, const ParsedModel& parsed) {
  put(offset, {parsed.model_idx, end, parsed.model, {}});
}

Vector<std::uint64_t> StreamModels::alive_at(std::uint64_t offset) const {
  Vector<std::uint64_t> alive;
  for (const Set<std::uint64_t>& of_idx : offsets_) {
    const auto after = of_idx.lower_bound(offset);
    if (after != of_idx.begin()) alive.push_back(*std::prev(after));
  }
  std::sort(alive.begin(), alive.end());
  return alive;
}

Result<bool> StreamModels::parse(std::uint64_t offset, Entry& entry, const ModelSlots& models) {
  const auto unit = units_.header_at(offset);
  if (!unit) return unit.error();
  if (unit->type() != UnitType::kModel) return misplaced(*unit, units_.version_minor());
  const auto parsed = access_units_.read_model(*unit, models);
  if (!parsed) return parsed.error();
  if (parsed->model_idx != entry.model_idx) {
    return Error{Errc::kInvalid, "R-IDX-06", "index_model_idx", access_units_.end() * 8};
  }
  entry.end = access_units_.end();
  entry.model = parsed->model;
  kept_.insert(offset);
  return true;
}

bool StreamModels::take_back(std::uint64_t offset, Entry& entry) {
  if (!entry.model && (entry.model = entry.dropped.lock())) kept_.insert(offset);
  return entry.model != nullptr;
}

Result<ModelSlots> StreamModels::at(std::uint64_t gof_offset) {
  const Vector<std::uint64_t> alive = alive_at(gof_offset);
  const auto num_dropped = std::erase_if(kept_, [&](std::uint64_t offset) {
    const bool drop = !std::binary_search(alive.begin(), alive.end(), offset);
    if (drop) {
      Entry& entry = entries_[offset];
      entry.dropped = std::exchange(entry.model, nullptr);
    }
    return drop;
  });
  if (num_dropped > 0 && dropped_) dropped_();
  ModelSlots models;
  for (const std::uint64_t offset : alive) {
    Entry& entry = entries_[offset];
    if (!take_back(offset, entry)) {
      if (const auto ok = parse(offset, entry, models); !ok) return ok.error();
    }
    models.of_idx[entry.model_idx] = entry.model;
  }
  return models;
}

Vector<StreamModels::Alive> StreamModels::find_alive(std::uint64_t gof_offset) const {
  Vector<Alive> alive;
  for (const std::uint64_t offset : alive_at(gof_offset)) {
    const Entry& entry = entries_.at(offset);
    alive.push_back(
        {offset, entry.model_idx, entry.model ? entry.model : entry.dropped.lock()});
  }
  return alive;
}

Result<std::uint64_t> StreamModels::read(const UnitHeader& unit) {
  const auto known = entries_.find(unit.offset);
  if (known == entries_.end() || !take_back(unit.offset, known->second)) {
    const auto models = at(unit.offset);
    if (!models) return models.error();
    const auto parsed = access_units_.read_model(unit, *models);
    if (!parsed) return parsed.error();
    add(unit.offset, access_units_.end(), *parsed);
    if (see_) see_(*parsed);
  }
  return entries_[unit.offset].end;
}

Result<std::uint64_t> StreamModels::skip(const UnitHeader& unit) {
  const auto known = entries_.find(unit.offset);
  if (known != entries_.end() && known->second.end > 0) return known->second.end;
  const auto bytes = units_.payload_start(unit, 1);
  if (!bytes) return bytes.error();
  BitReader r = units_.bits(unit, *bytes);
  Entry entry{parse_model_idx(r), unit.end(), nullptr, {}};
  if (r.error()) return *r.error();
  while (entry.end < units_.size()) {
    const auto next = units_.header_at(entry.end);
    if (!next) return next.error();
    if (next->type() != UnitType::kSlice) break;
    entry.end = next->end();
  }
  const std::uint64_t end = entry.end;
  put(unit.offset, std::move(entry));
  return end;
}

}  // namespace rlpc
