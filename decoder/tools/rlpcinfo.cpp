// rlpcinfo: the contents of an .rlpc stream.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/io/interrupts.h"
#include "common/io/messages.h"
#include "common/io/output_file.h"
#include "common/io/standard_output.h"
#include "common/tools/command_line.h"
#include "decoder/report/bit_counter.h"
#include "decoder/report/html_page.h"
#include "decoder/report/rate_report.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/stream/gof_summary.h"
#include "decoder/stream/stream_reader.h"
#include "decoder/tools/exit_code.h"
#include "decoder/tools/extract_verb.h"
#include "decoder/tools/stream_message.h"

namespace {

constexpr const char* kExamples = R"(Examples
  rlpcinfo walk.rlpc              contents, and bits per part
  rlpcinfo walk.rlpc --gofs       also of each GOF and slice
  rlpcinfo walk.rlpc --html walk.html
  rlpcinfo walk.rlpc --extract components=12,layers=5 -o small.rlpc)";

constexpr const char* kDetails =
    R"(--extract writes the stream without the slices of finer detail (Main profile),
without re-encoding. Of each skinned GOF it keeps the component groups with up
to K trajectories (0: only bones and rest shape), and the layer groups with up
to L vertex layers, the coarsest (always at least the first). Cluster GOFs have
no slices: they are kept whole. --gofs shows the possible cuts.

--trace prints bit position, name and value of every syntax element.

Exit code: 0 the whole stream was read; 1 not a conforming stream; 2 not
supported, or a stream that cannot be cut; 3 beyond the limits; 4 input or
output failed; 64 wrong usage.)";

struct Options {
  std::string input;
  bool json = false;
  bool gofs = false;
  bool trace = false;
  std::string html;
  std::string extract;
  std::string output;
  std::uint64_t max_memory_bytes = rlpc::DecodeLimits().max_memory_bytes;
};

int complain(const std::string& message, int code) {
  rlpc::print_message("rlpcinfo", message);
  return code;
}

int complain(const Options& o, const rlpc::Error& error) {
  rlpc::DecodeLimits limits;
  limits.max_memory_bytes = o.max_memory_bytes;
  return complain(rlpc::stream_message(o.input, error, limits), rlpc::exit_code(error.code));
}

int complain(const rlpc::OutputError& error) { return complain(error.message, rlpc::kExitIo); }

struct Summary {
  const rlpc::SequenceHeader& header;
  const rlpc::BitCounter& counter;
  std::uint64_t bytes;
  const std::vector<rlpc::GofSummary>& gofs;
  const std::string& metadata;
};

double bpvf(const Summary& s, double bits) {
  return bits / (static_cast<double>(s.header.num_vertices) * s.header.num_frames);
}

// Component groups that have slices, including that of the rest positions.
std::uint32_t num_groups(const rlpc::GofSummary& gof) {
  return gof.slices.empty() ? 0 : gof.slices.back().component_group_idx + 1;
}

nlohmann::ordered_json json_of(const rlpc::GofSummary& gof) {
  nlohmann::ordered_json json = {{"first_frame", gof.first_frame},
                                 {"num_frames", gof.num_frames}};
  for (const rlpc::GofFigure& figure : gof.figures) json[figure.key] = figure.value;
  if (!rlpc::has_slices(gof.kind)) {
    json["bytes"] = gof.bytes;
    return json;
  }
  nlohmann::ordered_json slices = nlohmann::ordered_json::array();
  for (const rlpc::SliceEntry& slice : gof.slices) {
    slices.push_back({{"component_group_idx", slice.component_group_idx},
                      {"layer_group_idx", slice.layer_group_idx},
                      {"num_trajectories", slice.num_trajectories},
                      {"bytes", slice.bytes}});
  }
  nlohmann::ordered_json components = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < num_groups(gof); ++group) {
    const rlpc::SliceTotals cut = gof.totals({group + 1, rlpc::SliceCut::kAll});
    components.push_back({{"components", cut.num_trajectories}, {"bytes", cut.bytes}});
  }
  nlohmann::ordered_json layers = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < gof.layer_group_size.size(); ++group) {
    const rlpc::SliceTotals cut = gof.totals({rlpc::SliceCut::kAll, group + 1});
    layers.push_back({{"layers", cut.num_layers}, {"bytes", cut.bytes}});
  }
  json["layer_group_size"] = gof.layer_group_size;
  json["bytes"] = gof.bytes;
  json["slices"] = std::move(slices);
  json["cut_to_components"] = std::move(components);
  json["cut_to_layers"] = std::move(layers);
  return json;
}

// Metadata is not validated: if it is not JSON, or nested too deeply, it is shown as plain
// text.
nlohmann::ordered_json metadata_json(const std::string& text) {
  constexpr int kDeepest = 100;
  bool too_deep = false;
  const auto look = [&](int depth, nlohmann::ordered_json::parse_event_t,
                        nlohmann::ordered_json&) {
    too_deep = too_deep || depth > kDeepest;
    return !too_deep;
  };
  auto json = nlohmann::ordered_json::parse(text, look, false);
  if (too_deep || json.is_discarded()) return text;
  return json;
}

void print_json(const Summary& s) {
  const rlpc::SequenceHeader& h = s.header;
  nlohmann::ordered_json bits = nlohmann::ordered_json::object();
  const auto& names = rlpc::stream_part_names();
  for (std::size_t p = 0; p < names.size(); ++p) bits[names[p]] = s.counter.bits()[p];
  nlohmann::ordered_json json = {
      {"profile_idc", h.profile_idc},
      {"level_idc", h.level_idc},
      {"num_vertices", h.num_vertices},
      {"num_triangles", h.num_triangles},
      {"num_frames", h.num_frames},
      {"frame_rate", {h.frame_rate.numerator, h.frame_rate.denominator}},
      {"grid_log2_step", h.grid.log2_step},
      {"grid_origin", h.grid.origin},
      {"position_bits", h.position_bits},
      {"num_gofs", s.gofs.size()},
      {"num_units", s.counter.num_units()},
      {"bytes", s.bytes},
      {"bpvf", bpvf(s, 8.0 * static_cast<double>(s.bytes))},
      {"bits", bits}};
  for (const rlpc::GofSummary& gof : s.gofs) json["gofs"].push_back(json_of(gof));
  if (!s.metadata.empty()) json["metadata"] = metadata_json(s.metadata);
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::cout << json.dump(2, ' ', false, kReplace) << "\n";
}

struct Noun {
  const char* one;
  const char* many;
};

// "1 cluster", "12 clusters"
std::string counted(std::uint64_t count, const Noun& noun) {
  return std::to_string(count) + " " + (count == 1 ? noun.one : noun.many);
}

// "12 clusters", or "3 to 12 clusters": a figure over all GOFs.
std::string range_over(const std::vector<rlpc::GofSummary>& gofs, std::size_t place) {
  const auto value = [&](const rlpc::GofSummary& gof) { return gof.figures[place].value; };
  const auto compare = [&](const auto& a, const auto& b) { return value(a) < value(b); };
  const auto [least, most] = std::minmax_element(gofs.begin(), gofs.end(), compare);
  const rlpc::GofFigure& figure = most->figures[place];
  const std::string most_counted = counted(figure.value, {figure.one, figure.many});
  return value(*least) == figure.value ? most_counted
                                       : std::to_string(value(*least)) + " to " + most_counted;
}

// "a", "a and b", "a, b and c"
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

// One line per kind of GOF.
void print_kinds(std::vector<rlpc::GofSummary> gofs) {
  while (!gofs.empty()) {
    const auto end = std::stable_partition(
        gofs.begin(), gofs.end(),
        [kind = gofs[0].kind](const rlpc::GofSummary& gof) { return gof.kind == kind; });
    const std::vector<rlpc::GofSummary> of_kind(gofs.begin(), end);
    std::vector<std::string> ranges;
    for (std::size_t i = 0; i < of_kind[0].figures.size(); ++i) {
      if (of_kind[0].figures[i].many != nullptr) ranges.push_back(range_over(of_kind, i));
    }
    std::printf("  %s GOFs: %zu, with %s each\n", rlpc::kind_name(of_kind[0].kind),
                of_kind.size(), listed(ranges).c_str());
    gofs.erase(gofs.begin(), end);
  }
}

// For a skinned GOF, a row per component group, a column per layer group, and the size of the
// GOF when cut after each of them.
void print_gof(const rlpc::GofSummary& gof) {
  std::vector<std::string> figures;
  for (const rlpc::GofFigure& figure : gof.figures) {
    if (figure.many == nullptr) continue;
    figures.push_back(counted(figure.value, {figure.one, figure.many}));
  }
  const bool has_slices = rlpc::has_slices(gof.kind);
  if (has_slices) figures.resize(1);  // the table has the others
  std::printf("\n  frames %u to %u: %s in %" PRIu64 " bytes%s\n", gof.first_frame,
              gof.first_frame + gof.num_frames - 1, listed(figures).c_str(), gof.bytes,
              has_slices ? "; slices in bytes" : "");
  if (!has_slices) return;
  std::printf("  %-40s", "layers");
  for (const std::uint32_t size : gof.layer_group_size) std::printf(" %9u", size);
  std::printf(" %12s\n", "GOF to here");
  auto slice = gof.slices.begin();
  for (std::uint32_t group = 0; group < num_groups(gof); ++group) {
    const rlpc::SliceTotals cut = gof.totals({group + 1, rlpc::SliceCut::kAll});
    const std::string name =
        group == 0 ? "influences, rest positions"
                   : "group " + std::to_string(group) +
                         ", trajectories: " + std::to_string(slice->num_trajectories);
    std::printf("  %-40s", name.c_str());
    for (std::uint32_t layers = 0; layers < gof.layer_group_size.size(); ++layers) {
      const bool present = slice != gof.slices.end() && slice->component_group_idx == group;
      std::printf(" %9s", present ? std::to_string(slice->bytes).c_str() : "");
      if (present) ++slice;
    }
    std::printf(" %12" PRIu64 "\n", cut.bytes);
  }
  std::printf("  %-40s", "GOF to here");
  for (std::uint32_t layers = 0; layers < gof.layer_group_size.size(); ++layers) {
    std::printf(" %9" PRIu64, gof.totals({rlpc::SliceCut::kAll, layers + 1}).bytes);
  }
  std::printf("\n");
}

void print_table(const Options& o, const Summary& s) {
  const rlpc::SequenceHeader& h = s.header;
  const double total = 8.0 * static_cast<double>(s.bytes);
  std::printf("%s: %s profile, level %u\n",
              rlpc::printable(rlpc::name_of_input(o.input)).c_str(),
              h.profile_idc == rlpc::kProfileMain ? "Main" : "Baseline", h.level_idc);
  std::printf("  %s, %s, %s at %u/%u per second, %s\n",
              counted(h.num_vertices, {"vertex", "vertices"}).c_str(),
              counted(h.num_triangles, {"triangle", "triangles"}).c_str(),
              counted(h.num_frames, {"frame", "frames"}).c_str(), h.frame_rate.numerator,
              h.frame_rate.denominator, counted(s.gofs.size(), {"GOF", "GOFs"}).c_str());
  print_kinds(s.gofs);
  std::printf("  grid step 2^%d, positions of %d bits\n\n", h.grid.log2_step, h.position_bits);
  std::printf("  %-26s %12s %8s %10s\n", "part", "bits", "share", "bpvf");
  const auto& names = rlpc::stream_part_names();
  for (std::size_t p = 0; p < names.size(); ++p) {
    const auto bits = static_cast<double>(s.counter.bits()[p]);
    if (bits == 0.0) continue;
    std::printf("  %-26s %12.0f %6.2f %% %10.4f\n", names[p].data(), bits, 100.0 * bits / total,
                bpvf(s, bits));
  }
  std::printf("  %-26s %12.0f %8s %10.4f\n", "all", total, "", bpvf(s, total));
  if (!s.metadata.empty())
    std::printf("\n  metadata: %s\n", rlpc::printable_lines(s.metadata).c_str());
  if (o.gofs) {
    for (const rlpc::GofSummary& gof : s.gofs) print_gof(gof);
  }
}

std::string frame_rate_text(const rlpc::SequenceHeader& h) {
  const rlpc::FrameRate& rate = h.frame_rate;
  const std::string numerator = std::to_string(rate.numerator);
  return rate.denominator == 1 ? numerator : numerator + "/" + std::to_string(rate.denominator);
}

std::string page_text(const Options& o, const Summary& s) {
  const rlpc::SequenceHeader& h = s.header;
  rlpc::HtmlPage page(std::filesystem::path(o.input).filename().string());
  const bool main = h.profile_idc == rlpc::kProfileMain;
  page.add_fact("profile",
                (main ? "Main, level " : "Baseline, level ") + std::to_string(h.level_idc));
  page.add_fact("mesh", rlpc::grouped_text(h.num_vertices) + " vertices, " +
                            rlpc::grouped_text(h.num_triangles) + " triangles");
  page.add_fact("frames",
                rlpc::grouped_text(h.num_frames) + " at " + frame_rate_text(h) + " per second");
  page.add_fact("grid", "step 2^" + std::to_string(h.grid.log2_step) + ", positions of " +
                            std::to_string(h.position_bits) + " bits");
  if (!s.metadata.empty()) page.add_fact("metadata", s.metadata);
  const rlpc::StreamRates rates{h.num_vertices, h.num_frames, s.bytes, &s.counter, &s.gofs};
  const double total = 8.0 * static_cast<double>(s.bytes);
  const double seconds =
      static_cast<double>(h.num_frames) * h.frame_rate.denominator / h.frame_rate.numerator;
  page.add_key_figures(
      {{rlpc::number_text(bpvf(s, total)), "bits per vertex and frame"},
       {rlpc::grouped_text(s.bytes), "bytes"},
       {rlpc::number_text(total / seconds / 1000, 3), "kbit per second"},
       {rlpc::number_text(96 / bpvf(s, total), 3) + " : 1", "against 32-bit floats"},
       {std::to_string(s.gofs.size()),
        s.gofs.size() == 1 ? "group of frames" : "groups of frames"}});
  rlpc::add_rate_section(page, rates);
  rlpc::add_gof_section(page, rates);
  return page.text();
}

int inform(const Options& o) {
  std::optional<rlpc::OutputFile> page;
  if (!o.html.empty()) {
    auto file = rlpc::OutputFile::create(o.html);
    if (!file) return complain(file.error());
    page.emplace(std::move(*file));
  }
  rlpc::BitCounter counter(o.trace);
  auto source = rlpc::file_or_standard_input(o.input, o.max_memory_bytes);
  if (!source) return complain(o, source.error());
  const std::uint64_t bytes = (*source)->size();
  rlpc::DecoderOptions options;
  options.limits.max_memory_bytes = o.max_memory_bytes;
  options.trace = &counter;
  rlpc::StreamReader stream(std::move(*source), options);
  if (const auto opened = stream.open(); !opened) return complain(o, opened.error());
  const auto gofs = rlpc::summarise_all(stream);
  if (!gofs) return complain(o, gofs.error());
  counter.finish(8 * bytes);
  const Summary summary{stream.header(), counter, bytes, *gofs, stream.metadata()};
  if (o.trace) return rlpc::kExitDone;
  if (page) {
    if (const auto error = rlpc::write_and_commit(*page, page_text(o, summary)))
      return complain(*error);
  }
  if (o.json) {
    print_json(summary);
  } else if (o.html != "-") {
    print_table(o, summary);
  }
  return rlpc::kExitDone;
}

// Returns --extract.
CLI::Option* add_options(CLI::App& app, Options& o) {
  const std::string report = "Report";
  const std::string cut = "Smaller stream";
  app.add_option("STREAM", o.input, "Stream to look at; - for standard input")->required();
  auto* json = app.add_flag("--json", o.json, "JSON on standard output")->group(report);
  auto* gofs =
      app.add_flag("--gofs", o.gofs, "Contents of each GOF and slice, too")->group(report);
  auto* html = app.add_option("--html", o.html, "Write a page with charts, too")
                   ->option_text("FILE")
                   ->group(report);
  auto* trace = app.add_flag("--trace", o.trace, "Every syntax element instead")->group(report);
  app.add_option("--max-memory", o.max_memory_bytes,
                 "Refuse streams that need more to decode, for example 500MB")
      ->transform(CLI::AsSizeValue(false))
      ->option_text("SIZE")
      ->group(report);
  auto* extract = app.add_option("--extract", o.extract, "Keep only coarser slices")
                      ->option_text("components=K,layers=L")
                      ->group(cut);
  auto* output = app.add_option("-o,--output", o.output,
                                "With --extract: stream to write; - for standard output")
                     ->option_text("FILE")
                     ->group(cut);
  trace->excludes(json)->excludes(html);
  extract->needs(output)->excludes(gofs)->excludes(trace)->excludes(html);
  output->needs(extract);
  rlpc::add_help(app, {"STREAM [OPTIONS]", {report, cut}, kExamples, kDetails}, RLPC_VERSION);
  return extract;
}

}  // namespace

int main(int argc, char** argv) try {
  rlpc::handle_interrupts();
  CLI::App app("Shows what an .rlpc stream contains.", "rlpcinfo");
  Options options;
  auto* extract = add_options(app, options);
  if (const auto code = rlpc::parse_command_line(app, argc, argv)) return *code;
  if (rlpc::OutputFile::is_same_file(options.html, options.input)) {
    return complain(options.html + ": is an input, too; choose another name for the output",
                    rlpc::kExitUsage);
  }
  if (options.json && (options.html == "-" || options.output == "-")) {
    return complain("--json and another output cannot both go to standard output",
                    rlpc::kExitUsage);
  }
  if (extract->count() == 0)
    return rlpc::after_standard_output("rlpcinfo", inform(options), rlpc::kExitIo);
  const auto cut = rlpc::parse_slice_cut(options.extract);
  if (!cut) {
    return complain(
        "--extract: expected components=K, layers=L, or both; K is at least 0 and L at least "
        "1, "
        "at most 4294967294; got `" +
            options.extract + "`",
        rlpc::kExitUsage);
  }
  rlpc::DecodeLimits limits;
  limits.max_memory_bytes = options.max_memory_bytes;
  return rlpc::after_standard_output(
      "rlpcinfo", rlpc::extract({options.input, options.output, *cut, limits, options.json}),
      rlpc::kExitIo);
} catch (const std::bad_alloc&) {
  std::fprintf(stderr, "rlpcinfo: out of memory\n");
  return rlpc::kExitLimit;
} catch (const std::exception& error) {
  rlpc::print_message("rlpcinfo", error.what());
  return rlpc::kExitLimit;
}
