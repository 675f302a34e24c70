// 6.13: shared rigs, their use by GOFs, and their unused parts.
#include "conformance/rlpcval/validator_rigs.h"

#include <algorithm>
#include <string>
#include <utility>

#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_gofs.h"
#include "conformance/rlpcval/validator_stream.h"

namespace rlpc {

RigSlots slots_of(const SeenRigs& rigs) {
  RigSlots known;
  for (std::size_t m = 0; m < rigs.size(); ++m) known.slots[m] = rigs[m].rig;
  return known;
}

// Records what is known of a shared rig before reading it.
void StreamValidator::begin_rig(const UnitHeader& unit) {
  rig_ = {};
  rig_.unit = unit;
  rig_.place = {report_.units, unit.type_byte, unit.offset};
  rig_.bit_pos = unit.payload_offset() * 8;
  index_.rigs.push_back({unit.offset, 0});
}

// 6.13 rig( )
void StreamValidator::rig(const UnitHeader& unit, const Payload& payload) {
  if (!can_read()) return doubt_rigs();
  ElementReader r(unit, payload, findings_);
  const std::uint32_t num_layers =
      lead_.context.meshes ? (*lead_.context.meshes)[Prediction::kLayers].num_layers() : 0;
  const bool damaged = findings_.suspect();
  const RigHeaderCheck header = check_rig_header(r, lead_.header->header, num_layers);
  rig_.rig_idx = header.rig_idx;
  rig_.unit_counts = header.units;
  rig_.suspect = damaged || lead_.connectivity_suspect;
  if (!header.rig_idx || damaged) {
    index_.rig_indices_known = false;
    doubt_rigs();
  }
  if (header.rig_idx) {
    index_.rigs.back().rig_idx = *header.rig_idx;
    release(rigs_[*header.rig_idx]);
    SeenRig& kept = rigs_[*header.rig_idx];
    kept = {};
    if (recons_) recons_->erase_unused();
    kept.lost = true;  // until it has been read
  }
  if (!header.section_readable || !lead_.context.meshes || !lead_.header->positions) {
    report_.complete = false;
    return;
  }
  findings_.in_unit(rig_.place);
  findings_.suspect(rig_.suspect);
  rig_.parser = std::make_unique<RigParser>(lead_.context, memory_limit());
  BitReader bits(payload, unit.payload_offset() * 8);
  if (const auto read = rig_.parser->rig(bits, slots_of(rigs_), unit.end() - unit.offset);
      !read) {
    findings_.error(read.error());
    report_.complete = false;
    rig_.parser.reset();
  }
}

// 8.16.1 DecodeRig( )
void StreamValidator::end_rig() {
  if (!rig_.parser) return;
  SeenRig& kept = rigs_[*rig_.rig_idx];
  kept.rig = rig_.parser->finish().rig;
  kept.lost = false;
  kept.suspect = rig_.suspect;
  kept.place = rig_.place;
  kept.bit_pos = rig_.bit_pos;
  kept.moves.assign(kept.rig->trajectories.size(), false);
  rig_.parser.reset();
  findings_.in_unit(rig_.place);
  needed_.max_unit_bytes = std::max<std::uint64_t>(needed_.max_unit_bytes, rig_.unit->size);
  warn_of_rig(*kept.rig, lead_.context, slots_of(rigs_), kept.bit_pos, findings_, needed_);
}

void StreamValidator::use_rig(const SkinnedGof& gof) {
  if (!gof.rig) return;
  SeenRig& kept = rigs_[gof.rig_idx];
  kept.is_used = true;
  for (std::size_t l = 0; l < std::min(kept.moves.size(), gof.trajectories.size()); ++l) {
    if (!is_still(gof.trajectories[l])) kept.moves[l] = true;
  }
}

void StreamValidator::doubt_rigs() {
  for (SeenRig& kept : rigs_) {
    kept.lost = true;
    kept.suspect = true;
  }
}

// Warns only if all GOFs could be read: others may have used the rig.
void StreamValidator::release(const SeenRig& kept) {
  if (!kept.rig || findings_.failures() > 0 || !report_.complete) return;
  findings_.in_unit(kept.place);
  if (!kept.is_used) {
    findings_.warning("W-MOD-01", "rig", kept.bit_pos,
                      "it is replaced, or the stream ends, before a GOF uses it");
  } else if (const auto still = std::count(kept.moves.begin(), kept.moves.end(), false);
             still > 0) {
    findings_.warning("W-SLI-01", "trajectory", kept.bit_pos,
                      std::to_string(still) +
                          " trajectories of the shared rig, in all GOFs "
                          "that use it");
  }
}

void StreamValidator::end_rigs() {
  for (const SeenRig& kept : rigs_) release(kept);
}

}  // namespace rlpc
