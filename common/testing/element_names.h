// Trace as text, for tests: "name value value\nname value ...".
#pragma once

#include <cstdint>
#include <string>

#include "common/codec/bits/trace.h"

namespace rlpc {

class ElementNames final : public Trace {
 public:
  void begin(const char* /*structure*/, std::uint64_t /*bit_pos*/) override {}
  void element(const char* name, std::int64_t value, std::uint64_t bit_pos) override {
    if (name != last_) text += std::string(text.empty() ? "" : "\n") + name;
    last_ = name;
    text += " " + std::to_string(value);
    in_order = in_order && bit_pos >= before_;
    before_ = bit_pos;
  }
  std::string text;
  bool in_order = true;  // whether positions never decrease

 private:
  std::string last_;
  std::uint64_t before_ = 0;
};

}  // namespace rlpc
