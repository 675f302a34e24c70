// The walk of the validator through one stream; validator.h is what others use.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/cluster_gof/cluster_gof.h"
#include "common/mesh/mesh.h"
#include "common/mesh/topology.h"
#include "common/skinned_gof/skinned_gof.h"
#include "conformance/rlpcval/validator.h"
#include "conformance/rlpcval/validator_findings.h"
#include "conformance/rlpcval/validator_headers.h"
#include "conformance/rlpcval/validator_units.h"
#include "decoder/parse/parse_gof_hash.h"
#include "decoder/parse/parse_skinned_gof.h"

namespace rlpc {

class StreamValidator {
 public:
  StreamValidator(ByteSource& source, const ValidationOptions& options,
                  ValidationReport& report);
  void run();

 private:
  using Payload = std::vector<std::uint8_t>;

  // validator.cpp: units, and where they stand.
  void walk();
  bool is_foreign() const;
  // False if the bytes of the unit are damaged.
  bool visit(const UnitHeader& unit);
  bool check_place(const UnitHeader& unit);
  bool may_stand_here(const UnitHeader& unit) const;
  void remember_place(const UnitHeader& unit);
  std::optional<std::uint64_t> place_after(std::uint64_t offset,
                                           const std::optional<UnitHeader>& unit, bool sound);
  void lose_units();

  // validator_payloads.cpp: what units hold.
  void read_payload(const UnitHeader& unit, bool sound);
  void sequence_header(const UnitHeader& unit, const Payload& payload);
  void check_limits();
  void connectivity(const UnitHeader& unit, const Payload& payload);
  void vertex_order(const UnitHeader& unit, const Payload& payload);
  void begin_gof(const UnitHeader& unit);
  void gof(const UnitHeader& unit, const Payload& payload);
  void gof_section(const UnitHeader& unit, const Payload& payload,
                   const GofHeaderCheck& header);
  void bone_section(const UnitHeader& unit, const Payload& payload,
                    const GofHeaderCheck& header);
  void slice(const UnitHeader& unit, const Payload& payload);
  // No slice can follow any more of the GOF whose slices were read.
  void end_slices();
  void gof_hash(const UnitHeader& unit, const Payload& payload);
  template <class Recon>
  void compare_hashes(const UnitHeader& unit, const GofHash& hash, const Recon& recon);
  void gof_index(const UnitHeader& unit, const Payload& payload);
  void metadata(const UnitHeader& unit, const Payload& payload);
  void end_of_sequence(const UnitHeader& unit, const Payload& payload);
  // Whether units can be read that need the sequence header; says so if not.
  bool can_read();

  // validator_summary.cpp: what shows only with the whole stream.
  void compare_index(const GofIndexCheck& index);
  void warn_of_gof(const UnitHeader& unit, const ClusterGof& gof);
  void warn_of_bones(const UnitHeader& unit, const SkinnedGof& gof);
  void warn_of_stream();
  void warn_of_level();

  const ValidationOptions& options_;
  ValidationReport& report_;
  FindingList findings_;
  StreamUnits units_;

  // Units so far.
  std::optional<UnitHeader> previous_;  // directly before; nothing after a gap
  std::array<std::uint32_t, 256> seen_{};
  bool gap_ = false;          // units were lost
  bool ended_ = false;        // an end_of_sequence unit was there
  bool unsupported_ = false;  // payloads may mean anything

  // Sequence header, connectivity.
  std::optional<HeaderCheck> header_;
  std::uint64_t header_bit_pos_ = 0;  // of the payload
  bool header_suspect_ = false;
  bool within_limits_ = true;
  bool connectivity_suspect_ = false;
  bool has_connectivity_ = false;
  bool has_vertex_order_ = false;
  Topology topology_;
  std::optional<MeshPredictions> mesh_predictions_;  // in the Main profile

  // GOFs.
  std::optional<std::uint32_t> next_frame_ = 0;        // nothing if it is not known
  std::optional<std::uint32_t> expected_first_frame_;  // of the GOF being read
  bool frames_suspect_ = false;
  std::vector<GofLocation> gofs_;  // all GOF units; first_frame only if known
  std::size_t known_first_frames_ = 0;
  bool previous_gof_suspect_ = false;
  std::uint32_t previous_gof_frames_ = 0;     // 0: not known
  std::optional<ClusterGof> previous_gof_;    // if its section could be read
  std::optional<SkinnedGof> previous_bones_;  // if its slices could be read as well
  std::optional<UnitHeader> gof_unit_;        // if it, or a slice of it, is directly before
  FindingUnit gof_place_;
  bool may_have_slices_ = false;  // that GOF: it is one of bones, or that is not known
  std::optional<SliceCounts> slice_counts_;
  std::optional<SkinnedGofParser> bone_parser_;  // if the sections so far could be read
  std::vector<GofIndexCheck> indexes_;
  std::uint64_t index_units_found_ = 0;  // those that index_distance leads to
  Level needed_{};                       // the most that any GOF takes
};

}  // namespace rlpc
