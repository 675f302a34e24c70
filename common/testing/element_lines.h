// Trace as text, for tests: a line "name value" for each element.
#pragma once

#include <cstdint>
#include <string>

#include "common/codec/bits/trace.h"

namespace rlpc {

class ElementLines final : public Trace {
 public:
  void begin(const char* /*structure*/, std::uint64_t /*bit_pos*/) override {}
  void element(const char* name, std::int64_t value, std::uint64_t /*bit_pos*/) override {
    text += std::string(name) + " " + std::to_string(value) + "\n";
  }
  std::string text;
};

}  // namespace rlpc
