// 6.1 and 6.2 as the validator reads them: signature, unit headers, payloads, CRCs; and the
// search for the next unit if a size cannot be right.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "conformance/rlpcval/validator_findings.h"
#include "decoder/codec/units/byte_source.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

class StreamUnits {
 public:
  StreamUnits(ByteSource& source, FindingList& findings, std::uint64_t max_memory_bytes)
      : source_(source), findings_(findings), max_memory_bytes_(max_memory_bytes) {}

  // Reads signature and version. Returns false if reading on is pointless.
  bool stream_header();
  // Limits the payloads of critical units from now on to MaxUnitBytes of Annex B.
  void set_max_unit_bytes(std::uint64_t bytes) { max_unit_bytes_ = bytes; }
  // Returns the unit at a byte offset; none if its header or its end is missing.
  std::optional<UnitHeader> header_at(std::uint64_t offset);
  // Compares unit_crc, block by block.
  bool crc_holds(const UnitHeader& unit);
  // Returns the payload; none if it cannot be read, or needs more memory than allowed.
  std::optional<std::vector<std::uint8_t>> payload(const UnitHeader& unit);

  // 6.2 IsKnownType( type ), or an ancillary unit.
  bool known_type(UnitType type) const;

  // Whether a chain of units runs from `offset` to an end_of_sequence unit at the very end.
  bool begins_chain(std::uint64_t offset);
  // Returns the first offset, from `offset` on, where such a chain begins with a unit whose CRC
  // matches.
  std::optional<std::uint64_t> next_chain(std::uint64_t offset);
  // Whether a unit of a possible type, with a matching CRC, is at the offset.
  bool is_unit(std::uint64_t offset);

  // 0 until the version has been read.
  std::uint32_t version_minor() const { return version_minor_; }
  std::uint64_t size() const { return source_.size(); }
  bool failed() const { return failed_; }  // reading failed

 private:
  bool read(std::uint64_t offset, std::span<std::uint8_t> out, const char* element);
  bool crc_of_unit(const UnitHeader& unit, std::uint32_t& stored, std::uint32_t& computed);
  // Finds all chains that begin at `offset` or later; false if that takes too much memory.
  bool find_chains(std::uint64_t offset);
  bool in_chain(std::uint64_t offset) const;  // in a chain that is known
  bool possible_type(std::uint8_t type_byte) const;

  ByteSource& source_;
  FindingList& findings_;
  std::uint64_t max_memory_bytes_;
  std::uint64_t max_unit_bytes_ = 0xFFFFFFFF;
  std::uint32_t version_minor_ = 0;
  bool failed_ = false;
  std::optional<std::uint64_t> chains_from_;
  std::vector<bool> chain_;  // [size - chains_from_]: begins a chain
  // Start and result of the last search.
  std::optional<std::uint64_t> searched_from_;
  std::optional<std::uint64_t> found_;
  std::uint64_t searched_bytes_ = 0;  // bytes whose CRC was computed in searches
};

}  // namespace rlpc
