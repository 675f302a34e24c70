#include "decoder/recon/prefetch.h"

#include <utility>

#include "decoder/recon/async.h"

namespace rlpc {

std::optional<Prefetch::Found> Prefetch::take(std::uint64_t offset, std::uint32_t first_frame) {
  std::optional<Found> found;
  if (!gofs_.empty()) {
    Ahead& ahead = gofs_.front();
    if (ahead.coded.units.front().header.offset == offset &&
        ahead.coded.gof.first_frame == first_frame && ahead.done.get() && ahead.gof) {
      found = Found{std::move(*ahead.gof), ahead.coded.end()};
      gofs_.pop_front();
    }
  }
  if (!found) gofs_.clear();
  return found;
}

void Prefetch::fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count) {
  while (!gofs_.empty() && gofs_.front().coded.gof.first_frame != first_frame)
    gofs_.pop_front();
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
    Ahead& ahead = gofs_.back();
    ahead.done = run_async([this, &ahead] {
      const ThreadPool::Use use(threads_);
      ahead.gof = parse(ahead);
    });
  }
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
    slots_[m] = std::make_shared<ModelAhead>();
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
    for (const CodedUnit& part : model->coded) bytes_left -= part.payload.size();
    model->before = ahead.models;
    const CodedUnit& first = model->coded.front();
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
  auto model = std::make_shared<ModelAhead>();
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
      auto parsed = stream_.access_units().parse_model(model.coded, *before, max_memory_bytes_);
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
    if (parsed == nullptr) return std::nullopt;
    models.of_idx[m] = parsed->model;
  }
  return models;
}

std::optional<PreparedGof> Prefetch::parse(const Ahead& ahead) const {
  const auto models = parse(ahead.models);
  if (!models) return std::nullopt;
  auto access_unit = stream_.access_units().parse(ahead.coded, *models, max_memory_bytes_);
  if (!access_unit) return std::nullopt;
  return prepare(std::move(*access_unit), stream_.context(), models_);
}

}  // namespace rlpc
