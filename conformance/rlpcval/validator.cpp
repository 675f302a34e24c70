#include "conformance/rlpcval/validator.h"

#include <string>

#include "common/codec/syntax/stream_format.h"
#include "conformance/rlpcval/validator_stream.h"

namespace rlpc {

StreamValidator::StreamValidator(ByteSource& source, const ValidationOptions& options,
                                 ValidationReport& report)
    : options_(options),
      report_(report),
      findings_(report, options.max_findings),
      units_(source, findings_, options.limits.max_memory_bytes) {}

// 6.1 stream( )
void StreamValidator::run() {
  report_.bytes = units_.size();
  if (units_.stream_header()) {
    unsupported_ = report_.count(Severity::kUnsupported) > 0;
    if (!is_foreign()) walk();
    end_slices();
    check_due_frames();
    end_rigs();
    findings_.in_unit(std::nullopt);
    for (const SeenIndex& seen : index_.units) {
      compare_index(seen);
      compare_rigs(seen);
    }
    warn_of_stream();
  } else {
    report_.complete = false;
  }
  if (unsupported_) report_.complete = false;
}

// An unsupported stream is not called invalid, as the syntax of a later version is unknown.
// After damage, an apparent later version is damage itself.
bool StreamValidator::is_foreign() const {
  return unsupported_ && report_.count(Severity::kError) == 0;
}

void StreamValidator::walk() {
  std::uint64_t offset = kStreamHeaderBytes;
  for (;;) {
    if (options_.progress) {
      options_.progress(static_cast<double>(offset) / static_cast<double>(units_.size()));
    }
    // A decoder decodes the last GOF before it looks for missing units.
    if (offset >= units_.size()) {
      end_slices();
      check_due_frames();
    }
    findings_.in_unit(std::nullopt);
    findings_.suspect(false);
    // Bytes after the end have been reported; they are examined only if they are units.
    if (ended_ && !units_.is_unit(offset)) return;
    const auto unit = units_.header_at(offset);
    bool sound = false;
    if (unit) sound = visit(*unit);
    if (units_.failed() || is_foreign()) return;
    const auto next = place_after(offset, unit, sound);
    if (!unit || next != unit->end()) lose_units();
    if (!next) return;
    offset = *next;
  }
}

// Returns the offset after the unit at `offset`; or of the next units found, if there is none
// or its size cannot be right.
std::optional<std::uint64_t> StreamValidator::place_after(std::uint64_t offset,
                                                          const std::optional<UnitHeader>& unit,
                                                          bool sound) {
  if (unit) {
    const std::uint64_t end = unit->end();
    const bool trusted = sound || end == units_.size() || units_.is_unit(end);
    if (trusted || units_.begins_chain(end)) return end;
  }
  const auto next = units_.next_chain(offset + 1);
  if (next || !unit) return next;
  return unit->end();
}

void StreamValidator::lose_units() {
  gap_ = true;
  frames_suspect_ = true;
  next_frame_.reset();
  previous_.reset();
  gof_ = {};
  rig_ = {};
  doubt_rigs();
  report_.complete = false;
}

// 6.1 leading_units( ) and gof_units( ): Table 7-1. Units after a misplaced one are not
// reported as misplaced for that reason.
bool StreamValidator::may_stand_here(const UnitHeader& unit) const {
  const auto seen = [&](UnitType type) { return seen_[static_cast<std::uint8_t>(type)] > 0; };
  if (report_.units == 0) return unit.type() == UnitType::kSequenceHeader;
  if (unit.ancillary() || ended_) return true;
  switch (unit.type()) {
    case UnitType::kSequenceHeader:
      return !seen(UnitType::kSequenceHeader);
    case UnitType::kConnectivity:
      return !seen(UnitType::kConnectivity) && !seen(UnitType::kGof) && !seen(UnitType::kRig);
    case UnitType::kVertexOrder:
      return seen(UnitType::kConnectivity) && !seen(UnitType::kVertexOrder) &&
             !seen(UnitType::kGof) && !seen(UnitType::kRig);
    case UnitType::kGof:
      return seen(UnitType::kConnectivity) || seen(UnitType::kGof);
    case UnitType::kRig:
      return units_.version_minor() > 1 &&
             (seen(UnitType::kConnectivity) || seen(UnitType::kGof));
    case UnitType::kSlice: {
      const bool behind_slice = !previous_ || previous_->type() == UnitType::kSlice;
      return units_.version_minor() > 0 &&
             ((gof_.unit && gof_.may_have_slices) || rig_.unit || behind_slice);
    }
    case UnitType::kFrame: {
      const bool behind_frame = !previous_ || previous_->type() == UnitType::kFrame;
      return units_.version_minor() > 1 &&
             ((gof_.unit && gof_.may_have_frames) || behind_frame);
    }
    case UnitType::kEndOfSequence:  // R-END-01 if there is no GOF
      return seen(UnitType::kGof) || seen(UnitType::kRig);
    default:
      return false;
  }
}

// 6.2 CheckUnitType( expected )
bool StreamValidator::check_place(const UnitHeader& unit) {
  if (may_stand_here(unit)) return true;
  const std::uint64_t at = unit.offset * 8;
  const bool known = units_.known_type(unit.type());
  if (known) {
    findings_.error({Errc::kInvalid, "R-UNT-05", "unit_type", at});
  } else {
    findings_.error({Errc::kUnsupported, "R-UNT-04", "unit_type", at},
                    "unit_type is " + std::to_string(unit.type_byte));
  }
  return known;
}

void StreamValidator::remember_place(const UnitHeader& unit) {
  ++report_.units;
  ++seen_[unit.type_byte];
  previous_ = unit;
  const bool is_slice = is_slice_type(unit.type());
  if (!is_slice && unit.type() != UnitType::kGof) gof_.unit.reset();
  if (!is_slice && unit.type() != UnitType::kRig) rig_.unit.reset();
  if (unit.ancillary() && !is_known_ancillary(unit.type())) {
    findings_.warning("W-UNT-01", "unit_type", unit.offset * 8,
                      "unit_type is " + std::to_string(unit.type_byte & 0x7F));
  }
}

// 6.2 unit_body( )
bool StreamValidator::visit(const UnitHeader& unit) {
  if (!is_slice_type(unit.type())) end_slices();
  if (unit.type() != UnitType::kGofHash) check_due_frames();
  findings_.in_unit(FindingUnit{report_.units, unit.type_byte, unit.offset});
  const bool known = unsupported_ || check_place(unit);
  const bool is_gof = unit.type() == UnitType::kGof;
  if (is_gof && lead_.header && lead_.header->usable &&
      next_frame_ == lead_.header->header.num_frames) {
    findings_.suspect(frames_suspect_ || lead_.header_suspect);
    findings_.error({Errc::kInvalid, "R-END-01", "unit_type", unit.offset * 8},
                    "the GOFs before have all " + std::to_string(*next_frame_) + " frames");
    findings_.suspect(false);
  }
  const bool sound = units_.crc_holds(unit);
  // The type is new, not damaged, as the unit is intact.
  if (!known && sound) unsupported_ = true;
  if (unsupported_) {
    report_.complete = false;
  } else {
    read_payload(unit, sound);
  }
  findings_.suspect(!sound);
  remember_place(unit);
  if (unit.type() == UnitType::kEndOfSequence) {
    if (unit.end() != units_.size()) {
      findings_.error({Errc::kInvalid, "R-END-02", "end_of_sequence", unit.end() * 8},
                      std::to_string(units_.size() - unit.end()) + " bytes follow");
    }
    ended_ = true;
  }
  return sound;
}

ValidationReport validate(ByteSource& source, const ValidationOptions& options) {
  ValidationReport report;
  StreamValidator(source, options, report).run();
  return report;
}

}  // namespace rlpc
