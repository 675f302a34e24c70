#include "conformance/rlpcval/rlpcval_report.h"

#include <cinttypes>
#include <string>
#include <string_view>

#include "common/codec/syntax/stream_format.h"
#include "common/files/messages.h"
#include "conformance/rlpcval/rule_explanations.h"
#include "decoder/describe_error.h"

namespace rlpc {
namespace {

constexpr std::size_t kColumns = 96;

const char* name_of(Severity severity) {
  switch (severity) {
    case Severity::kError:
      return "error";
    case Severity::kUnsupported:
      return "unsupported";
    case Severity::kWarning:
      break;
  }
  return "warning";
}

const char* name_of_unit(std::uint8_t type_byte) {
  switch (static_cast<UnitType>(type_byte)) {
    case UnitType::kSequenceHeader:
      return "sequence header";
    case UnitType::kConnectivity:
      return "connectivity";
    case UnitType::kVertexOrder:
      return "vertex order";
    case UnitType::kSlice:
      return "slice";
    case UnitType::kRig:
      return "shared rig";
    case UnitType::kFrame:
      return "frame";
    case UnitType::kGof:
      return "GOF";
    case UnitType::kEndOfSequence:
      return "end of sequence";
    case UnitType::kGofIndex:
      return "GOF index";
    case UnitType::kGofHash:
      return "GOF hash";
    case UnitType::kMetadata:
      return "metadata";
    case UnitType::kClipTable:
      return "clip table";
    case UnitType::kAttributes:
      return "attributes";
    case UnitType::kAsset:
      return "asset";
  }
  return "of unknown type";
}

// Wraps lines between words, all indented.
void print_wrapped(std::FILE* out, std::string_view text) {
  constexpr std::string_view kIndent = "  ";
  std::string line(kIndent);
  while (!text.empty()) {
    const std::size_t space = text.find(' ');
    const std::string_view word = text.substr(0, space);
    if (line.size() > kIndent.size() && line.size() + 1 + word.size() > kColumns) {
      std::fprintf(out, "%s\n", line.c_str());
      line = kIndent;
    }
    if (line.size() > kIndent.size()) line += ' ';
    line += word;
    text.remove_prefix(space == std::string_view::npos ? text.size() : space + 1);
  }
  if (line.size() > kIndent.size()) std::fprintf(out, "%s\n", line.c_str());
}

std::string place_of(const Finding& f) {
  std::string place =
      "bit " + std::to_string(f.bit_pos) + " (byte " + std::to_string(f.bit_pos / 8) + ")";
  if (f.unit) {
    place += ", unit " + std::to_string(f.unit->number) + " (" +
             name_of_unit(f.unit->type_byte) + ") at byte " + std::to_string(f.unit->offset);
  }
  return place;
}

void print_finding(std::FILE* out, const Finding& f) {
  const RuleExplanation* e = explain(f.id);
  std::fprintf(out, "\n%s %s  %s  %s\n", name_of(f.severity), f.id, f.element,
               place_of(f).c_str());
  if (!f.detail.empty()) {
    const std::string more =
        f.count > 1 ? " (the first of " + std::to_string(f.count) + " places)" : "";
    print_wrapped(out, f.detail + more);
  }
  if (e != nullptr) {
    print_wrapped(out, std::string(e->explanation) + " (clause " + e->clause + ")");
    print_wrapped(out, std::string("Likely cause: ") + e->cause);
    print_wrapped(out, std::string("What to do: ") + e->remedy);
  }
  if (f.stops_decoder)
    print_wrapped(out, "A decoder that stops at the first error stops here.");
  if (f.consequence) print_wrapped(out, "Possibly a consequence of damage found before.");
}

// Returns "2 errors" or "1 warning".
std::string counted(std::uint64_t count, const std::string& what) {
  return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

const char* reason_of(const Error& stopped) {
  return stopped.code == Errc::kIo ? "unreadable" : "limit";
}

nlohmann::ordered_json json_of_finding(const Finding& f) {
  const RuleExplanation* e = explain(f.id);
  nlohmann::ordered_json json = {{"id", f.id},
                                 {"severity", name_of(f.severity)},
                                 {"element", f.element},
                                 {"bit", f.bit_pos},
                                 {"byte", f.bit_pos / 8},
                                 {"unit", nullptr},
                                 {"clause", e != nullptr ? e->clause : ""},
                                 {"detail", f.detail},
                                 {"explanation", e != nullptr ? e->explanation : ""},
                                 {"likely_cause", e != nullptr ? e->cause : ""},
                                 {"what_to_do", e != nullptr ? e->remedy : ""},
                                 {"possibly_consequence", f.consequence},
                                 {"stops_decoder", f.stops_decoder},
                                 {"places", f.count}};
  if (f.unit) {
    json["unit"] = {{"number", f.unit->number},
                    {"type", name_of_unit(f.unit->type_byte)},
                    {"unit_code", f.unit->type_byte},
                    {"byte", f.unit->offset}};
  }
  return json;
}

}  // namespace

Verdict verdict_of(const ValidationReport& report) {
  if (report.count(Severity::kError) > 0) return Verdict::kNotConforming;
  if (report.stopped) return Verdict::kNotChecked;
  const bool supported = report.count(Severity::kUnsupported) == 0;
  return supported ? Verdict::kConforming : Verdict::kUnsupported;
}

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kConforming:
      return "conforming";
    case Verdict::kNotConforming:
      return "not conforming";
    case Verdict::kUnsupported:
      return "unsupported";
    case Verdict::kNotChecked:
      break;
  }
  return "not checked";
}

void print_report(std::FILE* out, const std::string& path, const ValidationReport& report) {
  std::fprintf(out, "%s: %s; %s, %s, %s\n", printable(path).c_str(),
               name_of(verdict_of(report)),
               counted(report.count(Severity::kError), "error").c_str(),
               counted(report.count(Severity::kUnsupported), "unsupported feature").c_str(),
               counted(report.count(Severity::kWarning), "warning").c_str());
  std::fprintf(out, "  read: %s in %s; %s with %s, of which %u %s the right hash\n",
               counted(report.bytes, "byte").c_str(), counted(report.units, "unit").c_str(),
               counted(report.gofs, "GOF").c_str(), counted(report.frames, "frame").c_str(),
               report.hashed_frames, report.hashed_frames == 1 ? "has" : "have");
  if (report.attribute_sets > 0) {
    std::fprintf(out, "  attributes: %s\n", counted(report.attribute_sets, "set").c_str());
  }
  for (const Finding& f : report.findings) print_finding(out, f);
  if (report.omitted > 0) {
    std::fprintf(out, "\n  %s not listed\n", counted(report.omitted, "error").c_str());
  }
  if (report.stopped) {
    const bool memory = exceeded_limit(*report.stopped) == ExceededLimit::kMemory;
    const char* const advice = memory ? "; raise --max-memory" : "";
    const std::string what = report.stopped->code == Errc::kIo
                                 ? "the file could not be read"
                                 : describe_limit(*report.stopped) + advice;
    std::fprintf(out, "\nbit %" PRIu64 ": %s: %s\n", report.stopped->bit_pos,
                 report.stopped->element, what.c_str());
  }
  if (!report.complete) {
    std::fprintf(out, "\n  Not everything was checked: fix this, then validate again.\n");
  }
}

nlohmann::ordered_json json_of(const std::string& path, const ValidationReport& report) {
  nlohmann::ordered_json json = {{"file", path},
                                 {"verdict", name_of(verdict_of(report))},
                                 {"errors", report.count(Severity::kError)},
                                 {"unsupported", report.count(Severity::kUnsupported)},
                                 {"warnings", report.count(Severity::kWarning)},
                                 {"complete", report.complete},
                                 {"stopped", nullptr},
                                 {"bytes", report.bytes},
                                 {"units", report.units},
                                 {"gofs", report.gofs},
                                 {"frames", report.frames},
                                 {"hashed_frames", report.hashed_frames},
                                 {"attribute_sets", report.attribute_sets},
                                 {"findings", nlohmann::ordered_json::array()},
                                 {"omitted", report.omitted}};
  if (report.stopped) {
    json["stopped"] = {{"reason", reason_of(*report.stopped)},
                       {"element", report.stopped->element},
                       {"bit", report.stopped->bit_pos}};
  }
  for (const Finding& f : report.findings) json["findings"].push_back(json_of_finding(f));
  return json;
}

}  // namespace rlpc
