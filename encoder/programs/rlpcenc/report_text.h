// Reports of rlpcenc as text, on standard output.
#pragma once

#include <vector>

#include "encoder/codec/stage_clock.h"
#include "encoder/dry_run.h"
#include "encoder/programs/rlpcenc/encode_options.h"

namespace rlpc {

// Prints what was encoded, or is expected of an encoding, and with --verbose the choices of the
// encoder.
void print_report(const EncodeOptions& options, const Expectation& expectation);

// Prints how long each stage took, the longest first; stages of less than 5 ms are left out.
void print_stages(const EncodeOptions& options, std::vector<StageTime> stages);

}  // namespace rlpc
