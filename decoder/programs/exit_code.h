// Exit codes of the programs that decode.
#pragma once

#include "common/files/output_file.h"
#include "common/result.h"

namespace rlpc {

// Exit codes of rlpcdec and rlpcinfo; the conformance contract defines 0 to 3.
enum ExitCode : int {
  kExitDone = 0,
  kExitInvalid = 1,      // not a conforming stream
  kExitUnsupported = 2,  // a later version, another profile
  kExitLimit = 3,        // beyond the caller's limits
  kExitIo = 4,           // a file could not be read or written
  kExitUsage = 64,
};

inline ExitCode exit_code(Errc code) {
  switch (code) {
    case Errc::kTruncated:
    case Errc::kInvalid:
      return kExitInvalid;
    case Errc::kUnsupported:
      return kExitUnsupported;
    case Errc::kLimitExceeded:
      return kExitLimit;
    case Errc::kIo:
      break;
  }
  return kExitIo;
}

inline ExitCode exit_code(const OutputError& error) {
  if (error.is_limit) return kExitLimit;
  return error.is_usage ? kExitUsage : kExitIo;
}

}  // namespace rlpc
