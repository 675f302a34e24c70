// Checks the promises of the encoder from outside: decodes a stream and compares positions with
// the numbers of the input, without trusting anything that the encoder reports.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "conformance/fuzz/promise_case.h"

namespace rlpc {

enum class Outcome : std::uint8_t {
  kKept,     // encoded, and what was promised is true
  kMissed,   // encoded, and reported that the target is missed
  kRefused,  // an error that the input or the settings explain
  kWrong,
};

struct PromiseResult {
  Outcome outcome = Outcome::kWrong;
  std::string what;  // kRefused: the error; kWrong: what is wrong
};

struct PromiseStream {
  std::vector<std::uint8_t> bytes;
  EncodeReport report;
};

// Encodes and checks.
PromiseResult check_promises(const PromiseCase& c);
// Checks what was encoded.
PromiseResult check_stream(const PromiseCase& c, const PromiseStream& stream);

}  // namespace rlpc
