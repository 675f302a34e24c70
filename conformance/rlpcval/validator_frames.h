// Inter GOFs and the beginning of their frame units (6.14), as the validator reads them.
#pragma once

#include <cstdint>

#include "conformance/rlpcval/validator_elements.h"
#include "conformance/rlpcval/validator_headers.h"

namespace rlpc {

// 6.14 frames_of_gof( ). num_layers: layers of the mesh; 0 if not known.
bool check_frames(ElementReader& r, const SequenceHeader& header, std::uint32_t num_layers,
                  GofHeaderCheck& gof);

// 6.14.2 frame_unit( ), up to its section. counts: the groups and layers of the GOF.
bool check_frame_header(ElementReader& r, const SliceCounts& counts);

}  // namespace rlpc
