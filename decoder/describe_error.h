// Errors of a stream in words.
#pragma once

#include <string>
#include <string_view>

#include "common/result.h"

namespace rlpc {

// For example "bit 960: seed_vertex breaks rule R-GOF-06; the stream is damaged or ...".
inline std::string describe_error(const Error& error) {
  const std::string where = "bit " + std::to_string(error.bit_pos) + ": " + error.element;
  const std::string rule =
      error.rule[0] == '\0' ? "" : " (rule " + std::string(error.rule) + ")";
  switch (error.code) {
    case Errc::kTruncated:
      return where + ": the stream ends too early" + rule + "; the file was cut off";
    case Errc::kInvalid:
      if (std::string_view(error.rule) == "R-STR-01") {
        return where + ": expected an RLPC stream, which begins with other bytes" + rule;
      }
      return where + ": not a conforming stream" + rule +
             "; the file is damaged, or its encoder has a bug";
    case Errc::kUnsupported:
      return where + ": not supported by this version" + rule + "; get a newer decoder";
    case Errc::kLimitExceeded:
      return where + ": more than the limits allow" + rule + "; raise them to decode it";
    case Errc::kIo:
      break;
  }
  if (error.bit_pos == 0) return "cannot read the stream: " + std::string(error.element);
  return where + ": cannot read the stream here; the file or the disk is at fault";
}

}  // namespace rlpc
