// rlpcval: all violations in an .rlpc stream, their causes and remedies.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/cli/command_line.h"
#include "common/files/interrupts.h"
#include "common/files/messages.h"
#include "common/files/progress_bar.h"
#include "common/files/standard_output.h"
#include "common/json/json.h"
#include "conformance/rlpcval/rlpcval_report.h"
#include "conformance/rlpcval/rule_explanations.h"
#include "conformance/rlpcval/validator.h"
#include "decoder/describe_error.h"
#include "decoder/programs/exit_code.h"

namespace {

constexpr const char* kExamples = R"(Examples
  rlpcval walk.rlpc                          all findings
  rlpcval *.rlpc --quiet && echo good        a test for scripts
  rlpcval walk.rlpc --json > findings.json   for programs (findings.schema.json)
  rlpcval --explain R-RNG-01                 what a rule or a warning means
  rlpcenc cow.obj -o - | rlpcval -           from standard input)";

constexpr const char* kDetails =
    R"(A finding names the rule of the specification, its clause and the position, and
explains its meaning, its likely cause, and what to do. After an error the
validator continues where it can; findings that may be consequences of an
earlier one are marked.

Severities
  error         the stream does not conform
  unsupported   another version, profile or level; the contents were not checked
  warning       legal, but surely unintended (W-...)

Exit code: 0 conforming; 1 errors; 2 unsupported; 3 not checked completely
because of --max-memory; 4 not readable; 64 wrong usage. For several streams,
the first of 1, 4, 3 and 2 that applies.)";

struct Options {
  std::vector<std::string> inputs;
  std::string explain;
  rlpc::ValidationOptions validation;
  bool json = false;
  bool quiet = false;
  bool strict_warnings = false;
};

void add_options(CLI::App& app, Options& o) {
  const std::string options = "Options";
  app.add_option("STREAM", o.inputs, "Streams to validate; - for standard input");
  app.add_option("--explain", o.explain, "Explain a rule or a warning")
      ->option_text("ID")
      ->group(options);
  app.add_flag("--strict-warnings", o.strict_warnings, "Exit code 1 for warnings too")
      ->group(options);
  app.add_option(
         "--max-memory", o.validation.limits.max_memory_bytes,
         "Refuse streams that need more, for example 500MB (1 MB: 1000 * 1000 bytes; 1 MiB: "
         "1024 * 1024; default: 4GiB)")
      ->transform(CLI::AsSizeValue(true))
      ->option_text("SIZE")
      ->group(options);
  app.add_flag("--json", o.json, "Report as JSON on standard output")->group(options);
  app.add_flag("-q,--quiet", o.quiet, "No report, no progress")->group(options);
  rlpc::add_help(app, {"STREAM... [OPTIONS]", {options}, kExamples, kDetails}, RLPC_VERSION);
}

rlpc::ExitCode exit_code(const rlpc::ValidationReport& report, bool strict_warnings) {
  const bool warned = report.count(rlpc::Severity::kWarning) > 0;
  switch (rlpc::verdict_of(report)) {
    case rlpc::Verdict::kConforming:
      return strict_warnings && warned ? rlpc::kExitInvalid : rlpc::kExitDone;
    case rlpc::Verdict::kNotConforming:
      return rlpc::kExitInvalid;
    case rlpc::Verdict::kUnsupported:
      return rlpc::kExitUnsupported;
    case rlpc::Verdict::kNotChecked:
      break;
  }
  return rlpc::exit_code(report.stopped->code);
}

rlpc::ExitCode worse(rlpc::ExitCode a, rlpc::ExitCode b) {
  for (const auto code : {rlpc::kExitInvalid, rlpc::kExitIo, rlpc::kExitLimit}) {
    if (a == code || b == code) return code;
  }
  return a == rlpc::kExitDone ? b : a;
}

rlpc::ExitCode validate(const Options& o, const std::string& path,
                        nlohmann::ordered_json& streams) {
  rlpc::ValidationReport report;
  rlpc::ValidationOptions options = o.validation;
  std::uint64_t& max_memory_bytes = options.limits.max_memory_bytes;
  if (const auto source = rlpc::file_or_standard_input(path, max_memory_bytes)) {
    max_memory_bytes -= (*source)->memory_bytes();
    rlpc::ProgressBar bar("validating", !o.quiet);
    options.progress = [&](double fraction) { bar.show(fraction); };
    report = rlpc::validate(**source, options);
  } else {
    report.stopped = source.error();
    report.complete = false;
  }
  const bool unreadable = report.stopped && report.stopped->code == rlpc::Errc::kIo;
  if (unreadable) {
    rlpc::print_message("rlpcval", path + ": " + rlpc::describe_error(*report.stopped));
  }
  if (o.json) {
    streams.push_back(rlpc::json_of(path, report));
  } else if (!o.quiet && !unreadable) {
    rlpc::print_report(stdout, path, report);
  }
  return exit_code(report, o.strict_warnings);
}

int explain(const std::string& id) {
  const rlpc::RuleExplanation* e = rlpc::explain(id);
  if (e == nullptr) {
    rlpc::print_message("rlpcval", "--explain: unknown rule or warning `" + id + "`");
    return rlpc::kExitUsage;
  }
  std::printf("%s (clause %s)\n  %s\n  Likely cause: %s\n  What to do: %s\n", e->id, e->clause,
              e->explanation, e->cause, e->remedy);
  return rlpc::kExitDone;
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  CLI::App app("Validates .rlpc streams: reports every violation, by rule.", "rlpcval");
  Options options;
  add_options(app, options);
  if (const auto parsed = rlpc::parse_command_line(app, argc, argv)) return *parsed;
  if (!options.explain.empty()) {
    return rlpc::after_standard_output("rlpcval", explain(options.explain), rlpc::kExitIo);
  }
  if (options.inputs.empty()) {
    rlpc::print_message("rlpcval", "expected a stream to validate, or --help");
    return rlpc::kExitUsage;
  }
  nlohmann::ordered_json streams = nlohmann::ordered_json::array();
  rlpc::ExitCode code = rlpc::kExitDone;
  for (const std::string& path : options.inputs) {
    code = worse(code, validate(options, path, streams));
  }
  if (options.json) {
    const nlohmann::ordered_json json = {{"rlpcval", RLPC_VERSION}, {"streams", streams}};
    std::cout << rlpc::json_text(json, 2) << "\n";
  }
  return rlpc::after_standard_output("rlpcval", code, rlpc::kExitIo);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcval: out of memory\n");
  return rlpc::kExitLimit;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcval", error.what());
  return rlpc::kExitLimit;
}
