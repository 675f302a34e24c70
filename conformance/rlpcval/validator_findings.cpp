#include "conformance/rlpcval/validator_findings.h"

#include <algorithm>
#include <cstdio>
#include <string_view>
#include <utility>

namespace rlpc {

std::string hex(std::uint32_t value) {
  char text[16];
  std::snprintf(text, sizeof text, "0x%08X", value);
  return text;
}

std::size_t ValidationReport::count(Severity severity) const {
  const auto listed = std::count_if(findings.begin(), findings.end(),
                                    [&](const Finding& f) { return f.severity == severity; });
  return static_cast<std::size_t>(listed) +
         (severity == Severity::kError ? static_cast<std::size_t>(omitted) : 0);
}

const Finding* ValidationReport::first_failure() const {
  const auto found = std::find_if(findings.begin(), findings.end(),
                                  [](const Finding& f) { return f.stops_decoder; });
  return found == findings.end() ? nullptr : &*found;
}

Finding FindingList::make(Severity severity, const Error& error, std::string detail) const {
  Finding finding;
  finding.severity = severity;
  finding.id = error.rule;
  finding.element = error.element;
  finding.bit_pos = error.bit_pos;
  finding.unit = unit_;
  finding.detail = std::move(detail);
  finding.consequence = suspect_;
  return finding;
}

void FindingList::add(Finding finding) {
  ++failures_;
  if (failures_ <= max_findings_) {
    report_.findings.push_back(std::move(finding));
  } else {
    ++report_.omitted;
  }
}

void FindingList::error(const Error& error, std::string detail) {
  if (error.code == Errc::kLimitExceeded || error.code == Errc::kIo) {
    if (!report_.stopped) report_.stopped = error;
    report_.complete = false;
    return;
  }
  const bool unsupported = error.code == Errc::kUnsupported;
  Finding finding =
      make(unsupported ? Severity::kUnsupported : Severity::kError, error, std::move(detail));
  finding.stops_decoder = !std::exchange(stopped_, true);
  add(std::move(finding));
}

void FindingList::unchecked(const char* rule, const char* element, std::uint64_t bit_pos,
                            std::string detail) {
  add(make(Severity::kError, {Errc::kInvalid, rule, element, bit_pos}, std::move(detail)));
}

void FindingList::warning(const char* id, const char* element, std::uint64_t bit_pos,
                          std::string detail) {
  for (Finding& known : report_.findings) {
    if (std::string_view(known.id) == id) {
      ++known.count;
      return;
    }
  }
  report_.findings.push_back(
      make(Severity::kWarning, {Errc::kInvalid, id, element, bit_pos}, std::move(detail)));
}

}  // namespace rlpc
