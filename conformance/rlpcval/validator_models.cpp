// 6.13: skinned models, their use by GOFs, and what no GOF used.
#include "conformance/rlpcval/validator_models.h"

#include <algorithm>
#include <string>
#include <utility>

#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_gofs.h"
#include "conformance/rlpcval/validator_stream.h"

namespace rlpc {

ModelSlots slots_of(const SeenModels& models) {
  ModelSlots slots;
  for (std::size_t m = 0; m < models.size(); ++m) slots.of_idx[m] = models[m].model;
  return slots;
}

// What is known of a skinned model before reading it.
void StreamValidator::begin_model(const UnitHeader& unit) {
  model_ = {};
  model_.unit = unit;
  model_.place = {report_.units, unit.type_byte, unit.offset};
  model_.bit_pos = unit.payload_offset() * 8;
  index_.models.push_back({unit.offset, 0});
}

// 6.13 model( )
void StreamValidator::model(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return doubt_models();
  ElementReader r(payload, unit.payload_offset() * 8, findings_);
  const std::uint32_t num_layers =
      lead_.context.meshes ? (*lead_.context.meshes)[Prediction::kLayers].num_layers() : 0;
  const bool damaged = findings_.suspect();
  const ModelHeaderCheck header = check_model_header(r, lead_.header->header, num_layers);
  model_.model_idx = header.model_idx;
  model_.slice_counts = header.slices;
  model_.suspect = damaged || lead_.connectivity_suspect;
  if (!header.model_idx || damaged) {
    index_.model_indices_known = false;
    doubt_models();
  }
  if (header.model_idx) {
    index_.models.back().model_idx = *header.model_idx;
    release(models_[*header.model_idx]);
    SeenModel& kept = models_[*header.model_idx];
    kept = {};
    if (recons_) recons_->erase_unused();
    kept.lost = true;  // until it has been read
  }
  if (!header.section_readable || !lead_.context.meshes || !lead_.header->positions) {
    report_.complete = false;
    return;
  }
  findings_.in_unit(model_.place);
  findings_.suspect(model_.suspect);
  model_.parser = std::make_unique<ModelParser>(lead_.context, memory_limit());
  BitReader bits(payload, unit.payload_offset() * 8);
  if (const auto read = model_.parser->model(bits, slots_of(models_), unit.end() - unit.offset);
      !read) {
    findings_.error(read.error());
    report_.complete = false;
    model_.parser.reset();
  }
}

// 8.16.1 DecodeModel( )
void StreamValidator::end_model() {
  if (!model_.parser) return;
  SeenModel& kept = models_[*model_.model_idx];
  kept.model = model_.parser->finish().model;
  kept.lost = false;
  kept.suspect = model_.suspect;
  kept.place = model_.place;
  kept.bit_pos = model_.bit_pos;
  kept.moves.assign(kept.model->trajectories.size(), false);
  model_.parser.reset();
  findings_.in_unit(model_.place);
  needed_.max_unit_bytes = std::max<std::uint64_t>(needed_.max_unit_bytes, model_.unit->size);
  warn_of_model(*kept.model, lead_.context, slots_of(models_), kept.bit_pos, findings_,
                needed_);
}

void StreamValidator::use_model(const SkinnedGof& gof) {
  if (!gof.model) return;
  SeenModel& kept = models_[gof.model_idx];
  kept.is_used = true;
  for (std::size_t l = 0; l < std::min(kept.moves.size(), gof.trajectories.size()); ++l) {
    if (!is_still(gof.trajectories[l])) kept.moves[l] = true;
  }
}

void StreamValidator::doubt_models() {
  for (SeenModel& kept : models_) {
    kept.lost = true;
    kept.suspect = true;
  }
}

// Only where all GOFs could be read: the others may have used it.
void StreamValidator::release(const SeenModel& kept) {
  if (!kept.model || findings_.failures() > 0 || !report_.complete) return;
  findings_.in_unit(kept.place);
  if (!kept.is_used) {
    findings_.warning("W-MOD-01", "model", kept.bit_pos,
                      "it is replaced, or the stream ends, before a GOF uses it");
  } else if (const auto still = std::count(kept.moves.begin(), kept.moves.end(), false);
             still > 0) {
    findings_.warning("W-SLI-01", "trajectory", kept.bit_pos,
                      std::to_string(still) +
                          " trajectories of the skinned model, in all GOFs "
                          "that use it");
  }
}

void StreamValidator::end_models() {
  for (const SeenModel& kept : models_) release(kept);
}

}  // namespace rlpc
