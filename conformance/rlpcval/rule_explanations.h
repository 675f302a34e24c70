// Explanations of the findings of the validator, for authors of encoders.
#pragma once

#include <span>
#include <string_view>

namespace rlpc {

struct RuleExplanation {
  const char* id;           // rule of the specification, or warning
  const char* clause;       // clause that states the rule
  const char* explanation;  // what is wrong, in plain words
  const char* cause;        // usual cause
  const char* remedy;       // what to do
};

// One entry per rule of spec/rules.json, ascending.
std::span<const RuleExplanation> rule_explanations();
// One entry per warning.
std::span<const RuleExplanation> warning_explanations();

// The entry of a rule or a warning; null if unknown.
const RuleExplanation* explain(std::string_view id);

}  // namespace rlpc
