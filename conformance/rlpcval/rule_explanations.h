// What the findings of the validator mean, for the author of the encoder.
#pragma once

#include <span>
#include <string_view>

namespace rlpc {

struct RuleExplanation {
  const char* id;           // of a rule of the specification, or of a warning
  const char* clause;       // where it stands
  const char* explanation;  // what is wrong, in plain words
  const char* cause;        // where it usually comes from
  const char* remedy;       // what to do
};

// One entry for each rule of spec/rules.json, ascending.
std::span<const RuleExplanation> rule_explanations();
// One for each warning.
std::span<const RuleExplanation> warning_explanations();

// Of a rule or a warning; null if there is none.
const RuleExplanation* explain(std::string_view id);

}  // namespace rlpc
