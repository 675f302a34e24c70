#include "decoder/tools/rlpcinfo_report.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/io/messages.h"
#include "decoder/report/html_page.h"
#include "decoder/report/rate_report.h"

namespace rlpc {
namespace {

double bpvf(const StreamInfo& s, double bits) {
  return bits / (static_cast<double>(s.header.num_vertices) * s.header.num_frames);
}

// Component groups that have slices, including that of the rest positions.
std::uint32_t num_groups(const GofSummary& gof) {
  return gof.slices.empty() ? 0 : gof.slices.back().component_group_idx + 1;
}

nlohmann::ordered_json json_of(const GofSummary& gof) {
  nlohmann::ordered_json json = {{"first_frame", gof.first_frame},
                                 {"num_frames", gof.num_frames}};
  for (const GofFigure& figure : gof.figures) json[figure.key] = figure.value;
  if (!has_slices(gof.kind)) {
    json["bytes"] = gof.bytes;
    return json;
  }
  nlohmann::ordered_json slices = nlohmann::ordered_json::array();
  for (const SliceEntry& slice : gof.slices) {
    slices.push_back({{"component_group_idx", slice.component_group_idx},
                      {"layer_group_idx", slice.layer_group_idx},
                      {"num_trajectories", slice.num_trajectories},
                      {"bytes", slice.bytes}});
  }
  nlohmann::ordered_json components = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < num_groups(gof); ++group) {
    const SliceTotals cut = gof.totals({group + 1, SliceCut::kAll});
    components.push_back({{"components", cut.num_trajectories}, {"bytes", cut.bytes}});
  }
  nlohmann::ordered_json layers = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < gof.layer_group_size.size(); ++group) {
    const SliceTotals cut = gof.totals({SliceCut::kAll, group + 1});
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

struct Noun {
  const char* one;
  const char* many;
};

// "1 cluster", "12 clusters"
std::string counted(std::uint64_t count, const Noun& noun) {
  return std::to_string(count) + " " + (count == 1 ? noun.one : noun.many);
}

// "12 clusters", or "3 to 12 clusters": a figure over all GOFs.
std::string range_over(const std::vector<GofSummary>& gofs, std::size_t place) {
  const auto value = [&](const GofSummary& gof) { return gof.figures[place].value; };
  const auto compare = [&](const auto& a, const auto& b) { return value(a) < value(b); };
  const auto [least, most] = std::minmax_element(gofs.begin(), gofs.end(), compare);
  const GofFigure& figure = most->figures[place];
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
void print_kinds(std::vector<GofSummary> gofs) {
  while (!gofs.empty()) {
    const auto end = std::stable_partition(
        gofs.begin(), gofs.end(),
        [kind = gofs[0].kind](const GofSummary& gof) { return gof.kind == kind; });
    const std::vector<GofSummary> of_kind(gofs.begin(), end);
    std::vector<std::string> ranges;
    for (std::size_t i = 0; i < of_kind[0].figures.size(); ++i) {
      if (of_kind[0].figures[i].many != nullptr) ranges.push_back(range_over(of_kind, i));
    }
    std::printf("  %s GOFs: %zu, with %s each\n", kind_name(of_kind[0].kind), of_kind.size(),
                listed(ranges).c_str());
    gofs.erase(gofs.begin(), end);
  }
}

// For a skinned GOF, a row per component group, a column per layer group, and the size of the
// GOF when cut after each of them.
void print_gof(const GofSummary& gof) {
  std::vector<std::string> figures;
  for (const GofFigure& figure : gof.figures) {
    if (figure.many == nullptr) continue;
    figures.push_back(counted(figure.value, {figure.one, figure.many}));
  }
  const bool is_sliced = has_slices(gof.kind);
  if (is_sliced) figures.resize(1);  // the table has the others
  std::printf("\n  frames %u to %u: %s in %" PRIu64 " bytes%s\n", gof.first_frame,
              gof.first_frame + gof.num_frames - 1, listed(figures).c_str(), gof.bytes,
              is_sliced ? "; slices in bytes" : "");
  if (!is_sliced) return;
  std::printf("  %-40s", "layers");
  for (const std::uint32_t size : gof.layer_group_size) std::printf(" %9u", size);
  std::printf(" %12s\n", "GOF to here");
  auto slice = gof.slices.begin();
  for (std::uint32_t group = 0; group < num_groups(gof); ++group) {
    const SliceTotals cut = gof.totals({group + 1, SliceCut::kAll});
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
    std::printf(" %9" PRIu64, gof.totals({SliceCut::kAll, layers + 1}).bytes);
  }
  std::printf("\n");
}

std::string frame_rate_text(const SequenceHeader& h) {
  const FrameRate& rate = h.frame_rate;
  const std::string numerator = std::to_string(rate.numerator);
  return rate.denominator == 1 ? numerator : numerator + "/" + std::to_string(rate.denominator);
}

}  // namespace

void print_json(const StreamInfo& s) {
  const SequenceHeader& h = s.header;
  nlohmann::ordered_json bits = nlohmann::ordered_json::object();
  const auto& names = stream_part_names();
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
  for (const GofSummary& gof : s.gofs) json["gofs"].push_back(json_of(gof));
  if (!s.metadata.empty()) json["metadata"] = metadata_json(s.metadata);
  constexpr auto kReplace = nlohmann::ordered_json::error_handler_t::replace;
  std::cout << json.dump(2, ' ', false, kReplace) << "\n";
}

void print_table(const StreamInfo& s, bool with_gofs) {
  const SequenceHeader& h = s.header;
  const double total = 8.0 * static_cast<double>(s.bytes);
  std::printf("%s: %s profile, level %u\n", printable(name_of_input(s.input)).c_str(),
              kProfileNames.at(h.profile_idc), h.level_idc);
  std::printf("  %s, %s, %s at %u/%u per second, %s\n",
              counted(h.num_vertices, {"vertex", "vertices"}).c_str(),
              counted(h.num_triangles, {"triangle", "triangles"}).c_str(),
              counted(h.num_frames, {"frame", "frames"}).c_str(), h.frame_rate.numerator,
              h.frame_rate.denominator, counted(s.gofs.size(), {"GOF", "GOFs"}).c_str());
  print_kinds(s.gofs);
  std::printf("  grid step 2^%d, positions of %d bits\n\n", h.grid.log2_step, h.position_bits);
  std::printf("  %-26s %12s %8s %10s\n", "part", "bits", "share", "bpvf");
  const auto& names = stream_part_names();
  for (std::size_t p = 0; p < names.size(); ++p) {
    const auto bits = static_cast<double>(s.counter.bits()[p]);
    if (bits == 0.0) continue;
    std::printf("  %-26s %12.0f %6.2f %% %10.4f\n", names[p].data(), bits, 100.0 * bits / total,
                bpvf(s, bits));
  }
  std::printf("  %-26s %12.0f %8s %10.4f\n", "all", total, "", bpvf(s, total));
  if (!s.metadata.empty())
    std::printf("\n  metadata: %s\n", printable_lines(s.metadata).c_str());
  if (with_gofs) {
    for (const GofSummary& gof : s.gofs) print_gof(gof);
  }
}

std::string page_text(const StreamInfo& s) {
  const SequenceHeader& h = s.header;
  HtmlPage page(std::filesystem::path(s.input).filename().string());
  page.add_fact("profile", std::string(kProfileNames.at(h.profile_idc)) + ", level " +
                               std::to_string(h.level_idc));
  page.add_fact("mesh", grouped_text(h.num_vertices) + " vertices, " +
                            grouped_text(h.num_triangles) + " triangles");
  page.add_fact("frames",
                grouped_text(h.num_frames) + " at " + frame_rate_text(h) + " per second");
  page.add_fact("grid", "step 2^" + std::to_string(h.grid.log2_step) + ", positions of " +
                            std::to_string(h.position_bits) + " bits");
  if (!s.metadata.empty()) page.add_fact("metadata", s.metadata);
  const StreamRates rates{h.num_vertices, h.num_frames, s.bytes, &s.counter, &s.gofs};
  const double total = 8.0 * static_cast<double>(s.bytes);
  const double seconds =
      static_cast<double>(h.num_frames) * h.frame_rate.denominator / h.frame_rate.numerator;
  page.add_key_figures({{number_text(bpvf(s, total)), "bits per vertex and frame"},
                        {grouped_text(s.bytes), "bytes"},
                        {number_text(total / seconds / 1000, 3), "kbit per second"},
                        {number_text(96 / bpvf(s, total), 3) + " : 1", "against 32-bit floats"},
                        {std::to_string(s.gofs.size()),
                         s.gofs.size() == 1 ? "group of frames" : "groups of frames"}});
  add_rate_section(page, rates);
  add_gof_section(page, rates);
  return page.text();
}

}  // namespace rlpc
