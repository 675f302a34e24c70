// 6.3, 6.5, 6.9 and 6.11 to 6.13 as the validator reads them: all values out of range are
// reported.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/codec/syntax/gof_header.h"
#include "common/codec/syntax/sequence_header.h"
#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_rigs.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
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

struct SliceCounts {
  std::uint32_t component_groups = 0;  // includes the influences, which are not factors
  std::uint32_t layer_groups = 1;
  std::uint32_t temporal_layers = 1;
  std::uint32_t frames = 0;  // frames of an inter GOF; 0: there are slice units
  bool open_end = false;     // the stream is open-ended
};

struct GofHeaderCheck {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;       // 0: not known
  std::optional<GofKind> kind;        // none: could not be read or inferred
  bool section_readable = false;      // only first_frame may be wrong
  std::optional<SliceCounts> slices;  // counts of the units that follow, if known
  bool rig_suspect = false;           // its shared rig may be wrong
};

// 6.5 gof( ), up to its section. expected_first_frame: none if not known. num_layers: layers of
// the mesh, for skinned GOFs; 0 if not known. rigs: the kept rigs.
GofHeaderCheck check_gof_header(ElementReader& r, const SequenceHeader& header,
                                std::optional<std::uint32_t> expected_first_frame,
                                std::uint32_t num_layers, const SeenRigs& rigs);

struct RigHeaderCheck {
  std::optional<std::uint32_t> rig_idx;  // none: could not be read
  bool section_readable = false;
  std::optional<SliceCounts> slices;  // none: not known
};

// 6.13 rig( ), up to its section. num_layers: as above.
RigHeaderCheck check_rig_header(ElementReader& r, const SequenceHeader& header,
                                std::uint32_t num_layers);

// Reads the indices of a 6.12 slice_unit( ) or 6.14.1 frame_unit( ). True if they are legal.
bool check_slice_header(ElementReader& r, const SliceCounts& slices);

struct GofIndexCheck {
  FindingUnit unit;
  bool suspect = false;
  std::vector<GofLocation> gofs;
  std::vector<RigLocation> rigs;
  std::uint64_t end = 0;  // end of the bytes of the last GOF
  bool readable = false;
  bool too_large = false;  // for max_memory_bytes
};

// 6.9 gof_index( )
GofIndexCheck check_gof_index(ElementReader& r, const SequenceHeader& header,
                              std::uint64_t max_memory_bytes);

}  // namespace rlpc
