// Receives every rule that the elements of a unit break, so that all of them can be reported.
#pragma once

#include <cstdint>

#include "common/result.h"

namespace rlpc {

// Values that a rule allows. If max is below min, it is not known which they are.
struct Range {
  std::int64_t min = 0;
  std::int64_t max = 0;
};

class RuleListener {
 public:
  RuleListener() = default;
  RuleListener(const RuleListener&) = delete;
  RuleListener& operator=(const RuleListener&) = delete;
  virtual ~RuleListener() = default;

  // Receives an element whose value breaks a rule. Parsing may go on. allowed: has the value
  // itself if the rule is no range.
  virtual void broken_rule(const Error& error, std::int64_t value, Range allowed) = 0;
  // Receives an error that ends parsing.
  virtual void failed(const Error& error) = 0;
};

}  // namespace rlpc
