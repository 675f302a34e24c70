// 6.1: goes from unit to unit of an access unit or of a shared rig.
#pragma once

#include <cstdint>
#include <optional>

#include "common/codec/syntax/stream_format.h"
#include "common/result.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// The units that may follow within an access unit or a shared rig.
struct Followers {
  std::optional<UnitType> slice{};  // slice or frame units
  bool hash = false;                // one GOF hash, after all others
  bool must_go_on = false;          // the end of the stream is an error
};

class UnitCursor {
 public:
  // Starts at the first unit: a GOF unit or a rig unit. `units` must outlive the cursor.
  UnitCursor(UnitReader& units, const UnitHeader& first) : units_(&units), unit_(first) {}

  const UnitHeader& unit() const { return unit_; }
  // The end of the unit, bytes from the start of the stream.
  std::uint64_t end() const { return unit_.end(); }

  // Goes to the next unit; waits for a pipe. Returns false, and stays, if the current unit is
  // the last. Errors: those of UnitReader::header_at().
  Result<bool> advance(const Followers& followers);

 private:
  UnitReader* units_;
  UnitHeader unit_;
};

}  // namespace rlpc
