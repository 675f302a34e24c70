// Interface of a decoder to the conformance judge, as arguments of rlpcdec:
//
//   rlpcdec --rlpc-conformance                               its capabilities, as JSON
//   rlpcdec decode IN.rlpc OUT.rlpd|OUT.f32 [--max-mem BYTES]
//
// OUT holds exactly the frames before an error, and is not written if the error precedes the
// first GOF unit (A.2). The last line of standard error on exit codes 1 to 3 is
// rlpc-verdict {"rule": ..., "bit": ..., "frame": ...}.
#pragma once

#include <optional>

namespace rlpc {

// Runs the command and returns its exit code; none if the arguments are not those above.
std::optional<int> run_conformance_verb(int argc, char** argv);

}  // namespace rlpc
