// The validator's walk through one stream; the interface is validator.h.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/syntax/stream_context.h"
#include "conformance/rlpcval/validator.h"
#include "conformance/rlpcval/validator_findings.h"
#include "conformance/rlpcval/validator_headers.h"
#include "conformance/rlpcval/validator_rigs.h"
#include "conformance/rlpcval/validator_units.h"
#include "decoder/codec/kinds/skinned/parse/rig_parser.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/parse/parse_gof_hash.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/units/access_unit_parser.h"

namespace rlpc {

class StreamValidator {
 public:
  StreamValidator(ByteSource& source, const ValidationOptions& options,
                  ValidationReport& report);
  void run();

 private:
  using Payload = std::vector<std::uint8_t>;

  // validator.cpp: units and their order.
  void walk();
  bool is_foreign() const;
  // Reads a unit. Returns false if its bytes are damaged.
  bool visit(const UnitHeader& unit);
  bool check_place(const UnitHeader& unit);
  bool may_stand_here(const UnitHeader& unit) const;
  void remember_place(const UnitHeader& unit);
  std::optional<std::uint64_t> place_after(std::uint64_t offset,
                                           const std::optional<UnitHeader>& unit, bool sound);
  void lose_units();

  // validator_payloads.cpp: contents of units.
  void read_payload(const UnitHeader& unit, bool sound);
  void sequence_header(const UnitHeader& unit, const Payload& payload);
  void check_limits();
  // Returns the memory limit for a GOF or shared rig.
  MemoryLimit memory_limit() const;
  void connectivity(const UnitHeader& unit, const Payload& payload);
  void vertex_order(const UnitHeader& unit, const Payload& payload);
  void begin_gof(const UnitHeader& unit);
  void gof(const UnitHeader& unit, const Payload& payload);
  void gof_body(const UnitHeader& unit, const Payload& payload, const GofHeaderCheck& header);
  void slice(const UnitHeader& unit, const Payload& payload);
  void compare_frame_crcs(const AccessUnit& access_unit);
  // Ends the slices: the shared rig is complete, or the access unit except for its hash.
  void end_slices();
  void end_gof();
  void check_due_frames();
  void gof_hash(const UnitHeader& unit, const Payload& payload);
  void compare_hashes(const UnitHeader& unit, const GofHash& hash);
  void gof_index(const UnitHeader& unit, const Payload& payload);
  void metadata(const UnitHeader& unit, const Payload& payload);
  void clip_table(const UnitHeader& unit, const Payload& payload);
  void end_of_sequence(const UnitHeader& unit, const Payload& payload);
  // Whether units that need the sequence header can be read; reports it if not.
  bool can_read();

  // validator_attributes.cpp: attribute units.
  void attributes(const UnitHeader& unit, const Payload& payload);
  // Whether attribute units are allowed here; reports it if not.
  bool has_place_for_attributes(const UnitHeader& unit);
  void check_attribute_names(const UnitHeader& unit, const CodedAttributes& coded);
  void compare_first_frame(const AccessUnit& access_unit);

  // validator_asset.cpp
  void asset(const UnitHeader& unit, const Payload& payload);

  // validator_rigs.cpp: shared rigs.
  void begin_rig(const UnitHeader& unit);
  void rig(const UnitHeader& unit, const Payload& payload);
  void end_rig();
  // Marks the rig, bones and trajectories of a GOF that has been read as used.
  void use_rig(const SkinnedGof& gof);
  // Marks all rigs as lost: units were lost, so rigs may have been replaced.
  void doubt_rigs();
  // Warns of what no GOF used in a rig that is replaced or at the end of the stream.
  void release(const SeenRig& kept);
  void end_rigs();

  // validator_summary.cpp: findings that need the whole stream.
  struct SeenIndex {
    FindingUnit place;
    bool suspect = false;
    GofIndex index;
  };
  void compare_index(const SeenIndex& seen);
  void compare_rigs(const SeenIndex& seen);
  void warn_of_stream();
  void warn_of_level();

  const ValidationOptions& options_;
  ValidationReport& report_;
  FindingList findings_;
  StreamUnits units_;

  // Units so far.
  std::optional<UnitHeader> previous_;  // the unit directly before; none after a gap
  std::array<std::uint32_t, 256> seen_{};
  bool gap_ = false;          // units were lost
  bool ended_ = false;        // there was an end_of_sequence unit
  bool unsupported_ = false;  // payloads may mean anything

  // Units before the first GOF.
  struct LeadingUnits {
    std::optional<HeaderCheck> header;
    std::uint64_t header_bit_pos = 0;  // start of the payload
    bool header_suspect = false;
    bool within_limits = true;
    bool has_connectivity = false;
    bool connectivity_suspect = false;
    bool has_vertex_order = false;
    StreamContext context;  // once there is connectivity
    std::vector<Triangle> triangles;
  };
  LeadingUnits lead_;

  // CRC of the first frame that attributes were predicted from, and its place in the stream;
  // none once that frame has been compared.
  struct FirstFrame {
    std::uint32_t crc = 0;
    std::optional<FindingUnit> place;
    std::uint64_t bit_pos = 0;
  };
  FirstFrame first_frame_;

  // A GOF or shared rig. Parser: of its units, if those so far could be read.
  template <class Parser>
  struct Current {
    std::optional<UnitHeader> unit;  // none unless it, or its slice, is the unit before
    FindingUnit place;
    bool suspect = false;
    UnitCounts unit_counts;  // of the units after it
    std::unique_ptr<Parser> parser;
  };
  template <class Parser>
  void slice_of(Current<Parser>& current, const UnitHeader& unit, const Payload& payload);

  // The GOF whose units were read last.
  struct CurrentGof : Current<AccessUnitParser> {
    std::optional<std::uint32_t> expected_first_frame;  // none: not known
    std::uint32_t num_frames = 0;                       // 0: not known
    bool may_have_slices = false;                       // it is a skinned GOF, or unknown
    bool may_have_frames = false;                       // it is an inter GOF, or unknown
    std::optional<AccessUnit> access_unit;              // none unless all units could be read
    bool frames_due = false;                            // its frames are yet to be decoded
  };
  CurrentGof gof_;

  // The shared rig whose units were read last, and those that are kept.
  struct CurrentRig : Current<RigParser> {
    std::optional<std::uint32_t> rig_idx;  // none: could not be read
    std::uint64_t bit_pos = 0;             // start of its payload
  };
  CurrentRig rig_;
  SeenRigs rigs_;
  std::optional<RigRecons> recons_;
  std::optional<std::uint32_t> next_frame_ = 0;  // none: not known
  bool frames_suspect_ = false;
  Level needed_{};  // the maximum over all GOFs

  struct Index {
    std::vector<GofLocation> gofs;  // all GOF units; first_frame only if known
    std::size_t known_first_frames = 0;
    std::vector<RigLocation> rigs;  // all rig units
    bool rig_indices_known = true;
    std::vector<SeenIndex> units;   // all GOF index units that could be read
    std::uint64_t units_found = 0;  // units that index_distance leads to
  };
  Index index_;
};

}  // namespace rlpc
