// Implements common/verify/stream_rules.h: the validator, as the encoder calls it.
#include <algorithm>
#include <limits>
#include <string>

#include "common/codec/syntax/stream_format.h"
#include "common/verify/stream_rules.h"
#include "conformance/rlpcval/rule_explanations.h"
#include "conformance/rlpcval/validator.h"
#include "decoder/verify/buffer_source.h"

namespace rlpc {
namespace {

bool is_of_contents(const Finding& finding) {
  if (!finding.unit) return false;
  switch (static_cast<UnitType>(finding.unit->type_byte)) {
    case UnitType::kMetadata:
    case UnitType::kAttributes:
    case UnitType::kAsset:
    case UnitType::kClipTable:
      return true;
    default:
      return false;
  }
}

std::string describe(const Finding& finding) {
  std::string text = std::string(finding.element) + " breaks rule " + finding.id + " at byte " +
                     std::to_string(finding.bit_pos / 8);
  if (!finding.detail.empty()) text += ", " + finding.detail;
  const RuleExplanation* const e = explain(finding.id);
  if (e != nullptr) text += ": " + std::string(e->explanation);
  return text;
}

}  // namespace

std::optional<std::string> find_broken_rule(const std::shared_ptr<StreamBuffer>& stream,
                                            std::uint64_t end, RuleScope scope) {
  constexpr auto kAny = std::numeric_limits<std::uint32_t>::max();
  BufferSource source(stream, end);
  ValidationOptions options;
  options.limits = {kAny, kAny, kMaxFrames, std::numeric_limits<std::uint64_t>::max()};
  options.max_findings = 1;
  if (scope == RuleScope::kContents) options.max_findings = 1000;
  const ValidationReport report = validate(source, options);
  const auto breaks = [&](const Finding& finding) {
    return finding.severity != Severity::kWarning &&
           (scope == RuleScope::kAll || is_of_contents(finding));
  };
  const auto found = std::find_if(report.findings.begin(), report.findings.end(), breaks);
  if (found != report.findings.end()) return describe(*found);
  if (scope == RuleScope::kContents || (report.complete && !report.stopped))
    return std::nullopt;
  return "the validator could not check all of it";
}

}  // namespace rlpc
