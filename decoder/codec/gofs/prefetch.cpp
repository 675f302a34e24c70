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

// The destructor of a future waits.
void Prefetch::drop(List& from, List::iterator which) {
  dropped_.splice(dropped_.end(), from, which);
  dropped_.remove_if([](const Ahead& ahead) { return is_done(ahead.done); });
  while (dropped_.size() > most_asked_) dropped_.pop_front();
}

void Prefetch::clear() {
  while (!gofs_.empty()) drop(gofs_, gofs_.begin());
}

std::optional<Prefetch::Found> Prefetch::take(List& from, List::iterator which) {
  std::optional<Found> found;
  if (which->done.get() && which->gof) {
    found = Found{std::move(*which->gof), which->coded.end()};
    for (const auto& model : which->new_models) {
      if (const ParsedModel* const parsed = parse(*model)) {
        stream_.models().add(model->offset, model->end, *parsed);
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
    slots_ = next->models;
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
  while (asked_.size() >= most_asked_) drop(asked_, asked_.begin());
  auto ahead = collect_at(place);
  if (!ahead) return;
  ahead->first_wanted = frame - place.first_frame;
  asked_.push_back(std::move(*ahead));
  start(asked_.back());
}

// The units of a GOF, and of the skinned models that have to be parsed before it.
std::optional<Prefetch::Ahead> Prefetch::collect_at(const GofPlace& place) {
  std::uint64_t bytes_left = max_memory_bytes_;
  Ahead ahead;
  for (const StreamModels::Alive& alive : stream_.models().find_alive(place.offset)) {
    auto& slot = ahead.models[alive.model_idx];
    if (alive.model) {
      slot = make_shared_owned<ModelAhead>();
      slot->is_tried = true;
      slot->parsed = ParsedModel{alive.model_idx, alive.model, {}, 0};
      continue;
    }
    const auto unit = stream_.units().header_at(alive.offset);
    if (!unit || unit->type() != UnitType::kModel) return std::nullopt;
    auto model = collect_model(*unit, bytes_left);
    if (!model) return std::nullopt;
    for (const RawUnit& part : model->coded) bytes_left -= part.payload.size();
    model->before = ahead.models;
    slot = model;
    ahead.new_models.push_back(std::move(model));
  }
  const auto unit = stream_.units().header_at(place.offset);
  if (!unit || unit->type() != UnitType::kGof) return std::nullopt;
  auto coded = stream_.access_units().collect(*unit, place.first_frame, bytes_left);
  if (!coded) return std::nullopt;
  ahead.coded = std::move(*coded);
  return ahead;
}

void Prefetch::hand_over_models() {
  if (gofs_.empty() || gofs_.front().coded.gof.first_frame != stream_.next_first_frame())
    return;
  for (const auto& model : gofs_.front().new_models) {
    const ParsedModel* parsed = parse(*model);
    if (parsed == nullptr) return;
    stream_.models().add(model->offset, model->end, *parsed);
  }
}

// The models alive at an offset, as the stream has them.
bool Prefetch::start_slots(std::uint64_t offset) {
  slots_ = {};
  const auto models = stream_.models().at(offset);
  if (!models) return false;
  for (std::size_t m = 0; m < slots_.size(); ++m) {
    if (!models->of_idx[m]) continue;
    slots_[m] = make_shared_owned<ModelAhead>();
    slots_[m]->is_tried = true;
    slots_[m]->parsed = ParsedModel{static_cast<std::uint32_t>(m), models->of_idx[m], {}, 0};
  }
  return true;
}

// Finds the next GOF, past ancillary units and skinned models. Reads nothing beyond the end of
// the sequence.
std::optional<Prefetch::Ahead> Prefetch::collect(std::uint64_t offset,
                                                 std::uint32_t first_frame) {
  UnitReader& units = stream_.units();
  std::uint64_t bytes_left = max_memory_bytes_;
  Ahead ahead;
  ahead.models = slots_;
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
    if (unit->type() != UnitType::kModel || ahead.new_models.size() == kMaxModels) {
      return std::nullopt;
    }
    auto model = collect_model(*unit, bytes_left);
    if (!model) return std::nullopt;
    for (const RawUnit& part : model->coded) bytes_left -= part.payload.size();
    model->before = ahead.models;
    const RawUnit& first = model->coded.front();
    BitReader r = units.bits(first.header, first.payload);
    ahead.models[parse_model_idx(r)] = model;
    offset = model->end;
    ahead.new_models.push_back(std::move(model));
  }
  return std::nullopt;
}

std::shared_ptr<Prefetch::ModelAhead> Prefetch::collect_model(const UnitHeader& unit,
                                                              std::uint64_t max_bytes) {
  auto coded = stream_.access_units().collect_model(unit, max_bytes);
  if (!coded) return nullptr;
  auto model = make_shared_owned<ModelAhead>();
  model->offset = unit.offset;
  model->end = coded->back().header.end();
  model->coded = std::move(*coded);
  return model;
}

const ParsedModel* Prefetch::parse(ModelAhead& model) const {
  const std::lock_guard lock(model.parsing);
  if (!model.is_tried) {
    const auto before = parse(model.before);
    model.before = {};
    if (before) {
      auto parsed =
          stream_.access_units().parse_model(model.coded, *before, cut_, max_memory_bytes_);
      if (parsed) model.parsed = std::move(*parsed);
    }
    model.coded = {};
    model.is_tried = true;
  }
  return model.parsed ? &*model.parsed : nullptr;
}

std::optional<ModelSlots> Prefetch::parse(const Slots& slots) const {
  ModelSlots models;
  for (std::size_t m = 0; m < slots.size(); ++m) {
    if (!slots[m]) continue;
    const ParsedModel* parsed = parse(*slots[m]);
    if (parsed == nullptr || parsed->model_idx != m) return std::nullopt;
    models.of_idx[m] = parsed->model;
  }
  return models;
}

std::optional<PreparedGof> Prefetch::parse(const Ahead& ahead) const {
  const auto models = parse(ahead.models);
  if (!models) return std::nullopt;
  auto access_unit =
      stream_.access_units().parse(ahead.coded, *models, cut_, max_memory_bytes_);
  if (!access_unit) return std::nullopt;
  return prepare(std::move(*access_unit), stream_.context(), models_, max_frame_bytes_);
}

}  // namespace rlpc
