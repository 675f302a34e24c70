// Streams with changed units, and what the validator finds in them, for tests.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/codec/syntax/write_units.h"
#include "conformance/rlpcval/validator.h"
#include "conformance/testing/small_animation.h"

namespace rlpc {

using Ids = std::vector<std::string>;

inline ValidationReport validate(const StreamBytes& bytes,
                                 const ValidationOptions& options = {}) {
  const auto source = memory_source(bytes);
  return validate(*source, options);
}
inline Ids ids(const ValidationReport& report) {
  Ids list;
  for (const Finding& f : report.findings) list.emplace_back(f.id);
  return list;
}
inline Ids ids(const StreamBytes& bytes) { return ids(validate(bytes)); }

inline StreamBytes with_payload_of(const StreamBytes& bytes, UnitType type,
                                   const Bytes& payload) {
  return with_payload(bytes, units_of_type(bytes, type).at(0), payload);
}
inline void erase(StreamBytes& bytes, const UnitPlace& unit) {
  bytes.erase(bytes.begin() + static_cast<std::ptrdiff_t>(unit.offset),
              bytes.begin() + static_cast<std::ptrdiff_t>(unit.end()));
}
inline void insert(StreamBytes& bytes, std::size_t offset, const Bytes& unit) {
  bytes.insert(bytes.begin() + static_cast<std::ptrdiff_t>(offset), unit.begin(), unit.end());
}
inline Bytes unit_bytes(const StreamBytes& bytes, const UnitPlace& unit) {
  return {bytes.begin() + static_cast<std::ptrdiff_t>(unit.offset),
          bytes.begin() + static_cast<std::ptrdiff_t>(unit.end())};
}

}  // namespace rlpc
