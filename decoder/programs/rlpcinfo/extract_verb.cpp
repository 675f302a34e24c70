#include "decoder/programs/rlpcinfo/extract_verb.h"

#include <charconv>
#include <cinttypes>
#include <cstdio>
#include <iostream>
#include <nlohmann/json.hpp>
#include <string_view>
#include <utility>

#include "common/files/messages.h"
#include "common/files/output_file.h"
#include "common/json/json.h"
#include "decoder/codec/extract/sub_stream_extractor.h"
#include "decoder/programs/exit_code.h"
#include "decoder/programs/setting_options.h"
#include "decoder/programs/stream_message.h"

namespace rlpc {
namespace {

std::optional<std::uint32_t> parse_count(std::string_view text) {
  std::uint32_t count = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (failure != std::errc() || end != text.data() + text.size()) return std::nullopt;
  if (count == SliceCut::kAll) return std::nullopt;
  return count;
}

int complain(const std::string& message, int code) {
  print_message("rlpcinfo", with_decoder_options(message));
  return code;
}

int complain(const ExtractOptions& o, const Error& error) {
  return complain(stream_message(o.input, error, o.limits), exit_code(error.code));
}

double bpvf(const SubStreamExtractor& cutter, std::uint64_t bytes) {
  const SequenceHeader& h = cutter.header();
  return 8.0 * static_cast<double>(bytes) /
         (static_cast<double>(h.num_vertices) * cutter.num_frames());
}

// The first layer group is kept even if it has more layers than requested.
bool too_many_layers(const ExtractOptions& o, const SliceTotals& after) {
  return after.num_layers > o.cut.max_layers;
}

// Names a rig by its place in the stream: most streams have a single rig_idx.
std::string name_of(const RigSummary& rig) {
  return "shared rig " + std::to_string(rig.number);
}

nlohmann::ordered_json json_of(const SliceTotals& totals) {
  return {{"num_trajectories", totals.num_trajectories},
          {"num_layers", totals.num_layers},
          {"num_temporal_layers", totals.num_temporal_layers},
          {"num_slices", totals.num_slices},
          {"bytes", totals.bytes}};
}

nlohmann::ordered_json size_json(const SubStreamExtractor& cutter, std::uint64_t bytes) {
  return {{"bytes", bytes}, {"bpvf", bpvf(cutter, bytes)}};
}

void print_json(const ExtractOptions& o, const SubStreamExtractor& cutter,
                std::uint64_t bytes) {
  bool met = true;
  nlohmann::ordered_json rigs = nlohmann::ordered_json::array();
  for (const auto& rig : cutter.summary().rigs) {
    rigs.push_back({{"rig_idx", rig->rig_idx},
                    {"before", json_of(rig->totals({}))},
                    {"after", json_of(cutter.totals_that_stay(*rig))}});
  }
  nlohmann::ordered_json gofs = nlohmann::ordered_json::array();
  for (const GofSummary& gof : cutter.summary().gofs) {
    const SliceTotals after = cutter.totals_that_stay(gof);
    met = met && !too_many_layers(o, after);
    gofs.push_back({{"first_frame", gof.first_frame},
                    {"num_frames", gof.num_frames},
                    {"before", json_of(gof.totals({}))},
                    {"after", json_of(after)}});
  }
  const nlohmann::ordered_json json = {{"output", o.output},
                                       {"cut", cutter.cuts_any()},
                                       {"request_met", met},
                                       {"attributes_dropped", cutter.drops_attributes()},
                                       {"before", size_json(cutter, cutter.size())},
                                       {"after", size_json(cutter, bytes)},
                                       {"rigs", std::move(rigs)},
                                       {"gofs", std::move(gofs)}};
  std::cout << json_text(json, 2) << "\n";
}

// Describes the temporal layers of a GOF before and after the cut.
std::string temporal_text(const SliceTotals& before, const SliceTotals& after) {
  if (before.num_temporal_layers == 1) return {};
  return std::to_string(after.num_temporal_layers) + " of " +
         std::to_string(before.num_temporal_layers) + " temporal layers, ";
}

// Prints what stays of a GOF or shared rig with vertices.
void print_cut(const ExtractOptions& o, const std::string& name, const SliceTotals& before,
               const SliceTotals& after) {
  std::printf("  %s: %u of %u trajectories, %u of %u layers, %s%zu of %zu slices, %" PRIu64
              " of %" PRIu64 " bytes\n",
              name.c_str(), after.num_trajectories, before.num_trajectories, after.num_layers,
              before.num_layers, temporal_text(before, after).c_str(), after.num_slices,
              before.num_slices, after.bytes, before.bytes);
  if (after.num_trajectories == 0 && before.num_trajectories > 0 && o.cut.max_components > 0) {
    std::printf(
        "    the first group has more than %u trajectories: only bones and rest shape are "
        "kept\n",
        o.cut.max_components);
  }
  if (too_many_layers(o, after)) {
    std::printf("    more than %u layers: the first layer group is always kept\n",
                o.cut.max_layers);
  }
}

void print_text(const ExtractOptions& o, const SubStreamExtractor& cutter,
                std::uint64_t bytes) {
  std::printf("%s: %" PRIu64 " bytes, %.4f bpvf\n", printable(name_of_input(o.input)).c_str(),
              cutter.size(), bpvf(cutter, cutter.size()));
  std::printf("%s: %" PRIu64 " bytes, %.4f bpvf\n", printable(o.output).c_str(), bytes,
              bpvf(cutter, bytes));
  for (const auto& rig : cutter.summary().rigs) {
    print_cut(o, name_of(*rig), rig->totals({}), cutter.totals_that_stay(*rig));
  }
  for (const GofSummary& gof : cutter.summary().gofs) {
    const std::string name = "frames " + std::to_string(gof.first_frame) + " to " +
                             std::to_string(gof.first_frame + gof.num_frames - 1);
    const SliceTotals before = gof.totals({});
    const SliceTotals after = cutter.totals_that_stay(gof);
    if (!has_slices(gof.kind)) {
      std::printf("  %s: %s GOF, %" PRIu64 " bytes, kept whole\n", name.c_str(),
                  kind_name(gof.kind), gof.bytes);
    } else if (slice_type(gof.kind) == UnitType::kFrame) {
      std::printf("  %s: %u of %u layers, %zu of %zu frame units, %" PRIu64 " of %" PRIu64
                  " bytes\n",
                  name.c_str(), after.num_layers, before.num_layers, after.num_slices,
                  before.num_slices, after.bytes, before.bytes);
    } else if (gof.rig) {
      std::printf("  %s, tracks of %s: %u of %u trajectories, %s%zu of %zu slices, %" PRIu64
                  " of %" PRIu64 " bytes\n",
                  name.c_str(), name_of(*gof.rig).c_str(), after.num_trajectories,
                  before.num_trajectories, temporal_text(before, after).c_str(),
                  after.num_slices, before.num_slices, after.bytes, before.bytes);
    } else {
      print_cut(o, name, before, after);
    }
  }
  if (cutter.drops_attributes()) {
    std::printf(
        "  attributes are dropped: they are predicted from positions that this cut changes; "
        "encode with\n  --component-groups or --layer-groups to keep them\n");
  }
  if (!cutter.cuts_any())
    std::printf("  nothing was dropped: no GOF has more than requested\n");
}

}  // namespace

std::optional<SliceCut> parse_slice_cut(const std::string& text) {
  SliceCut cut;
  std::string_view left = text;
  for (;;) {
    const std::string_view part = left.substr(0, left.find(','));
    const std::size_t equals = part.find('=');
    if (equals == std::string_view::npos) return std::nullopt;
    const auto count = parse_count(part.substr(equals + 1));
    if (!count) return std::nullopt;
    const std::string_view name = part.substr(0, equals);
    if (name == "components" && cut.max_components == SliceCut::kAll) {
      cut.max_components = *count;
    } else if (name == "layers" && cut.max_layers == SliceCut::kAll && *count > 0) {
      cut.max_layers = *count;
    } else if (name == "temporal" && cut.max_temporal_layers == SliceCut::kAll && *count > 0) {
      cut.max_temporal_layers = *count;
    } else {
      return std::nullopt;
    }
    if (part.size() == left.size()) return cut;
    left.remove_prefix(part.size() + 1);
  }
}

int extract(const ExtractOptions& o) {
  auto source = file_or_standard_input(o.input, o.limits.max_memory_bytes);
  if (!source) return complain(o, source.error());
  if (OutputFile::is_same_file(o.output, o.input)) {
    return complain(o.output + ": is also an input; choose another name for the output",
                    kExitUsage);
  }
  auto cutter = SubStreamExtractor::open(std::move(*source), o.cut, o.limits);
  if (!cutter) return complain(o, cutter.error());
  if (!cutter->header().has_skinned_gofs()) {
    return complain(name_of_input(o.input) + ": " + SliceCut::kNoSlices, kExitUnsupported);
  }
  auto file = OutputFile::create(o.output);
  if (!file) return complain(file.error().message, kExitIo);
  std::uint64_t written = 0;
  for (;;) {
    const auto bytes = cutter->next();
    if (!bytes) return complain(o, bytes.error());
    if (bytes->empty()) break;
    const std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    if (const auto error = file->write(text)) return complain(error->message, kExitIo);
    written += bytes->size();
  }
  if (const auto error = file->close()) return complain(error->message, kExitIo);
  if (const auto error = file->commit()) return complain(error->message, kExitIo);
  if (o.json) {
    print_json(o, *cutter, written);
  } else if (o.output != "-") {
    print_text(o, *cutter, written);
  }
  return kExitDone;
}

}  // namespace rlpc
