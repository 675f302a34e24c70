// Headers of units, parsed as the decoder does, with all values that break a rule reported; and
// what is known of the units after them.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"
#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_rigs.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_headers.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_headers.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"

namespace rlpc {

struct HeaderCheck {
  SequenceHeader header;
  SequenceHeaderPlaces places;
  bool supported = true;   // profile and level are known
  bool usable = false;     // sizes are known and within a level: units can be read with them
  bool positions = false;  // position_bits is legal: positions can be computed
};

// 6.3 sequence_header( )
HeaderCheck check_sequence_header(ElementReader& r, std::uint32_t version_minor);

// Units that follow a GOF or rig unit: slices, frames, or none that are known.
using UnitCounts = std::variant<std::monostate, SliceCounts, FrameCounts>;
inline bool is_known(const UnitCounts& counts) {
  return !std::holds_alternative<std::monostate>(counts);
}

struct GofHeaderCheck {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;   // 0: not known
  std::optional<GofKind> kind;    // none: could not be read or inferred
  bool section_readable = false;  // only first_frame may be wrong
  UnitCounts units;               // that follow
  bool rig_suspect = false;       // its shared rig may be wrong
};

// 6.5 gof( ), up to its section. expected_first_frame: none if not known. num_layers: layers of
// the mesh, for skinned and inter GOFs; 0 if not known. rigs: those alive.
GofHeaderCheck check_gof_header(ElementReader& r, const SequenceHeader& header,
                                std::optional<std::uint32_t> expected_first_frame,
                                std::uint32_t num_layers, const SeenRigs& rigs);

struct RigHeaderCheck {
  std::optional<std::uint32_t> rig_idx;  // none: could not be read
  bool section_readable = false;
  UnitCounts units;  // that follow
};

// 6.13 rig( ), up to its section. num_layers: as above.
RigHeaderCheck check_rig_header(ElementReader& r, const SequenceHeader& header,
                                std::uint32_t num_layers);

// Reads the indices of a 6.12 slice_unit( ) or 6.14.2 frame_unit( ). Returns true if they are
// legal.
bool check_unit_header(ElementReader& r, const SequenceHeader& header,
                       const UnitCounts& counts);

}  // namespace rlpc
