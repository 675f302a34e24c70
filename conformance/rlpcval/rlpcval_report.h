// Findings of the validator, as text and as JSON.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "conformance/rlpcval/validator.h"

namespace rlpc {

enum class Verdict { kConforming, kNotConforming, kUnsupported, kNotChecked };

Verdict verdict_of(const ValidationReport& report);
const char* name_of(Verdict verdict);

void print_report(std::FILE* out, const std::string& path, const ValidationReport& report);
// One entry of `streams` of conformance/schema/findings.schema.json.
nlohmann::ordered_json json_of(const std::string& path, const ValidationReport& report);

}  // namespace rlpc
