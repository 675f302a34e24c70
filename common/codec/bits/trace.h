// Receives every syntax element as it is parsed; for traces, coverage and validation.
#pragma once

#include <cstdint>

namespace rlpc {

class Trace {
 public:
  Trace() = default;
  Trace(const Trace&) = delete;
  Trace& operator=(const Trace&) = delete;
  virtual ~Trace() = default;

  // Receives the beginning of a syntax structure, for example "gof".
  virtual void begin(const char* structure, std::uint64_t bit_pos) = 0;
  // Receives an element. bit_pos: its first bit from the start of the stream; for range-coded
  // elements, the end of the bits spent on the preceding elements.
  virtual void element(const char* name, std::int64_t value, std::uint64_t bit_pos) = 0;
};

}  // namespace rlpc
