#include "decoder/programs/rlpcinfo/rlpcinfo_report.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/files/clip_time.h"
#include "common/files/messages.h"
#include "common/json/json.h"
#include "decoder/report/coarse_report.h"
#include "decoder/report/html_page.h"
#include "decoder/report/rate_report.h"

namespace rlpc {
namespace {

double bpvf(const StreamInfo& s, double bits) {
  return bits / (static_cast<double>(s.header.num_vertices) * s.header.num_frames);
}

// Adds the slices of a GOF or shared rig, and its sizes when cut.
template <class Summary>
void add_slices(const Summary& summary, nlohmann::ordered_json& json) {
  nlohmann::ordered_json slices = nlohmann::ordered_json::array();
  for (const SliceEntry& slice : summary.slices) {
    slices.push_back({{"component_group_idx", slice.component_group_idx},
                      {"layer_group_idx", slice.layer_group_idx},
                      {"temporal_layer_idx", slice.temporal_layer_idx},
                      {"num_trajectories", slice.num_trajectories},
                      {"bytes", slice.bytes}});
    if (summary.figure("num_frame_units") == 0) continue;
    slices.back()["frame_idx"] = slice.frame_idx;
    slices.back()["num_frames"] = slice.is_gof_end ? 0 : slice.num_frames;
  }
  nlohmann::ordered_json components = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < summary.num_groups(); ++group) {
    const SliceTotals cut = summary.totals({group + 1, SliceCut::kAll});
    components.push_back({{"components", cut.num_trajectories}, {"bytes", cut.bytes}});
  }
  nlohmann::ordered_json layers = nlohmann::ordered_json::array();
  for (std::uint32_t group = 0; group < summary.layer_group_size.size(); ++group) {
    const SliceTotals cut = summary.totals({SliceCut::kAll, group + 1});
    layers.push_back({{"layers", cut.num_layers}, {"bytes", cut.bytes}});
  }
  json["layer_group_size"] = summary.layer_group_size;
  json["bytes"] = summary.bytes;
  json["slices"] = std::move(slices);
  json["cut_to_components"] = std::move(components);
  json["cut_to_layers"] = std::move(layers);
}

// Adds the sizes of a GOF when cut to fewer temporal layers.
void add_temporal_layers(const GofSummary& gof, nlohmann::ordered_json& json) {
  for (std::uint32_t layers = 1; layers <= gof.num_temporal_layers(); ++layers) {
    const SliceTotals cut = gof.totals({SliceCut::kAll, SliceCut::kAll, layers});
    json["cut_to_temporal_layers"].push_back(
        {{"temporal_layers", layers}, {"bytes", cut.bytes}});
  }
}

// Adds the numbers of vertices of each frame that follow the motion of their patch.
void add_vertex_modes(const GofSummary& gof, nlohmann::ordered_json& json) {
  for (const VertexModes& modes : gof.vertex_modes) {
    json["vertices_of_frame"].push_back(
        {{"from_neighbours", modes.from_neighbours},
         {"motion_with_residuals", modes.with_residuals},
         {"motion_without_residuals", modes.without_residuals}});
  }
}

nlohmann::ordered_json json_of(const GofSummary& gof) {
  nlohmann::ordered_json json = {{"first_frame", gof.first_frame},
                                 {"num_frames", gof.num_frames}};
  if (gof.rig) json["rig"] = gof.rig->number;
  for (const GofFigure& figure : gof.figures) json[figure.key] = figure.value;
  if (has_slices(gof.kind)) {
    add_slices(gof, json);
    add_temporal_layers(gof, json);
    add_vertex_modes(gof, json);
  } else {
    json["bytes"] = gof.bytes;
  }
  return json;
}

nlohmann::ordered_json json_of(const RigSummary& rig) {
  nlohmann::ordered_json json = {{"rig_idx", rig.rig_idx}, {"num_gofs", rig.num_gofs}};
  for (const GofFigure& figure : rig.figures) json[figure.key] = figure.value;
  add_slices(rig, json);
  return json;
}

nlohmann::ordered_json json_of(const CoarseMeshes& meshes) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
    const MeshSize size = meshes.size(layers);
    json.push_back({{"layers", layers},
                    {"vertices", size.num_vertices},
                    {"triangles", size.num_triangles}});
  }
  return json;
}

// Returns metadata as JSON. It is not validated: text that is not JSON, is nested too deeply,
// or needs more memory as a tree, is shown as plain text.
nlohmann::ordered_json metadata_json(const std::string& text, std::uint64_t max_bytes) {
  JsonProblem problem;
  auto json = read_json<nlohmann::ordered_json>(text, max_bytes, problem);
  return json ? *std::move(json) : nlohmann::ordered_json(text);
}

struct Noun {
  const char* one;
  const char* many;
};

// Formats "1 cluster", "12 clusters".
std::string counted(std::uint64_t count, const Noun& noun) {
  return std::to_string(count) + " " + (count == 1 ? noun.one : noun.many);
}

using Summaries = std::vector<const SlicedSummary*>;

// Formats a figure over all GOFs or shared rigs: "12 clusters", or "3 to 12 clusters".
std::string range_over(const Summaries& list, std::size_t place) {
  const auto value = [&](const SlicedSummary* summary) {
    return summary->figures[place].value;
  };
  const auto compare = [&](const auto& a, const auto& b) { return value(a) < value(b); };
  const auto [min, max] = std::minmax_element(list.begin(), list.end(), compare);
  const GofFigure& figure = (*max)->figures[place];
  const std::string max_counted = counted(figure.value, {figure.one, figure.many});
  return value(*min) == figure.value ? max_counted
                                     : std::to_string(value(*min)) + " to " + max_counted;
}

// Formats a list: "a", "a and b", "a, b and c".
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

bool is_shown(const Summaries& list, std::size_t place) {
  if (list[0]->figures[place].many == nullptr) return false;
  return std::any_of(list.begin(), list.end(), [&](const SlicedSummary* summary) {
    const GofFigure& figure = summary->figures[place];
    return !figure.only_many || figure.value > 1;
  });
}

void print_figures(const std::string& name, const Summaries& list) {
  std::vector<std::string> ranges;
  for (std::size_t i = 0; i < list[0]->figures.size(); ++i) {
    if (is_shown(list, i)) ranges.push_back(range_over(list, i));
  }
  std::printf("  %s: %zu, with %s each\n", name.c_str(), list.size(), listed(ranges).c_str());
}

// Prints a line for shared rigs, and one per kind of GOF.
void print_kinds(const StreamSummary& stream) {
  Summaries rigs;
  for (const auto& rig : stream.rigs) rigs.push_back(rig.get());
  if (!rigs.empty()) print_figures("shared rigs", rigs);
  std::vector<GofKind> kinds;
  for (const GofSummary& gof : stream.gofs) {
    if (std::find(kinds.begin(), kinds.end(), gof.kind) == kinds.end())
      kinds.push_back(gof.kind);
  }
  for (const GofKind kind : kinds) {
    Summaries gofs;
    for (const GofSummary& gof : stream.gofs) {
      if (gof.kind == kind) gofs.push_back(&gof);
    }
    const char* with_rigs = properties_of(kind).has_rig ? " with shared rigs" : "";
    print_figures(std::string(kind_name(kind)) + " GOFs" + with_rigs, gofs);
  }
}

// Prints a row per temporal layer except the first, with the totals of its slices.
void print_temporal_layers(const SlicedSummary& summary) {
  for (std::uint32_t layer = 1; layer < summary.num_temporal_layers(); ++layer) {
    const SliceTotals with = summary.totals({SliceCut::kAll, SliceCut::kAll, layer + 1});
    const SliceTotals without = summary.totals({SliceCut::kAll, SliceCut::kAll, layer});
    std::printf("  temporal layer %-25u %9" PRIu64, layer, with.bytes - without.bytes);
    for (std::size_t i = 1; i < summary.layer_group_size.size(); ++i) std::printf(" %9s", "");
    std::printf(" %12" PRIu64 "\n", with.bytes);
  }
}

// Prints a row per component group, a column per layer group, and the size of the GOF or shared
// rig when cut after each of them; and a row per temporal layer.
template <class Summary>
void print_slices(const Summary& summary, const char* to_here) {
  std::printf("  %-40s", "layers");
  for (const std::uint32_t size : summary.layer_group_size) std::printf(" %9u", size);
  std::printf(" %12s\n", to_here);
  const std::vector<SliceEntry> slices = summary.slices_by_group();
  auto slice = slices.begin();
  for (std::uint32_t group = 0; group < summary.num_groups(); ++group) {
    const SliceTotals cut = summary.totals({group + 1, SliceCut::kAll});
    const bool has_rest = slice->component_group_idx == 0 && slice->temporal_layer_idx == 0;
    if (group == 0 && !has_rest) continue;  // a GOF that uses a shared rig
    const std::string name =
        group == 0 ? summary.first_group
                   : "group " + std::to_string(group) +
                         ", trajectories: " + std::to_string(slice->num_trajectories);
    std::printf("  %-40s", name.c_str());
    for (std::uint32_t layers = 0; layers < summary.layer_group_size.size(); ++layers) {
      const bool present = slice != slices.end() && slice->component_group_idx == group &&
                           slice->temporal_layer_idx == 0;
      std::printf(" %9s", present ? std::to_string(slice->bytes).c_str() : "");
      if (present) ++slice;
    }
    std::printf(" %12" PRIu64 "\n", cut.bytes);
  }
  std::printf("  %-40s", to_here);
  for (std::uint32_t layers = 0; layers < summary.layer_group_size.size(); ++layers) {
    std::printf(" %9" PRIu64, summary.totals({SliceCut::kAll, layers + 1}).bytes);
  }
  std::printf("\n");
  print_temporal_layers(summary);
}

std::vector<std::string> figures_of(const SlicedSummary& summary) {
  std::vector<std::string> figures;
  for (const GofFigure& figure : summary.figures) {
    if (figure.many == nullptr || (figure.only_many && figure.value <= 1)) continue;
    figures.push_back(counted(figure.value, {figure.one, figure.many}));
  }
  return figures;
}

void print_rig(const RigSummary& rig) {
  std::printf("\n  shared rig %zu, used by %s: %s in %" PRIu64 " bytes; slices in bytes\n",
              rig.number, counted(rig.num_gofs, {"GOF", "GOFs"}).c_str(),
              figures_of(rig)[0].c_str(), rig.bytes);
  print_slices(rig, "rig to here");
}

// Prints "  49 frames with motions of patches; ...".
void print_vertex_modes(const GofSummary& gof) {
  std::uint32_t frames = 0;
  double with = 0;
  double without = 0;
  for (const VertexModes& modes : gof.vertex_modes) {
    if (modes.with_residuals + modes.without_residuals == 0) continue;
    ++frames;
    with += modes.with_residuals;
    without += modes.without_residuals;
  }
  if (gof.vertex_modes.empty()) return;
  std::printf("  %s with motions of patches", counted(frames, {"frame", "frames"}).c_str());
  if (frames > 0) {
    std::printf("; vertices that follow them, on average: %.1f with residuals, %.1f without",
                with / frames, without / frames);
  }
  std::printf("\n");
}

void print_gof(const GofSummary& gof) {
  std::printf("\n  frames %u to %u: ", gof.first_frame, gof.first_frame + gof.num_frames - 1);
  if (!has_slices(gof.kind)) {
    std::printf("%s in %" PRIu64 " bytes\n", listed(figures_of(gof)).c_str(), gof.bytes);
    return;
  }
  const std::string what = gof.rig ? "tracks of shared rig " + std::to_string(gof.rig->number)
                                   : figures_of(gof)[0];  // the table has the others
  const char* units = slice_type(gof.kind) == UnitType::kFrame ? "frame units" : "slices";
  std::printf("%s in %" PRIu64 " bytes; %s in bytes\n", what.c_str(), gof.bytes, units);
  print_slices(gof, "GOF to here");
  print_vertex_modes(gof);
}

// Prints each shared rig before the first GOF that uses it, and unused rigs at the end.
void print_all(const StreamSummary& stream) {
  std::vector<bool> listed(stream.rigs.size(), false);
  for (const GofSummary& gof : stream.gofs) {
    if (gof.rig && !listed[gof.rig->number]) print_rig(*gof.rig);
    if (gof.rig) listed[gof.rig->number] = true;
    print_gof(gof);
  }
  for (const auto& rig : stream.rigs) {
    if (!listed[rig->number]) print_rig(*rig);
  }
}

void print_coarse_meshes(const CoarseMeshes& meshes) {
  std::printf("\n  coarse meshes\n  %8s %10s %10s\n", "layers", "vertices", "triangles");
  for (std::uint32_t layers = 1; layers <= meshes.num_layers(); ++layers) {
    const MeshSize size = meshes.size(layers);
    std::printf("  %8u %10u %10u\n", layers, size.num_vertices, size.num_triangles);
  }
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
      {"open_ended", h.open_end_flag},
      {"frame_rate", {h.frame_rate.numerator, h.frame_rate.denominator}},
      {"duration", clip_seconds(h.frame_rate, h.num_frames)},
      {"grid_log2_step", h.grid.log2_step},
      {"grid_origin", h.grid.origin},
      {"position_bits", h.position_bits},
      {"num_gofs", s.summary.gofs.size()},
      {"num_units", s.counter.num_units()},
      {"bytes", s.bytes},
      {"bpvf", bpvf(s, 8.0 * static_cast<double>(s.bytes))},
      {"bits", bits}};
  for (const auto& rig : s.summary.rigs) json["rigs"].push_back(json_of(*rig));
  for (const GofSummary& gof : s.summary.gofs) json["gofs"].push_back(json_of(gof));
  if (s.coarse != nullptr) json["coarse_meshes"] = json_of(*s.coarse);
  for (const Clip& clip : s.clips) {
    json["clips"].push_back({{"name", clip.name},
                             {"first_frame", clip.first_frame},
                             {"num_frames", clip.num_frames},
                             {"duration", clip_seconds(h.frame_rate, clip.num_frames)}});
  }
  s.attributes.add_to(json);
  if (!s.metadata.empty()) json["metadata"] = metadata_json(s.metadata, s.max_json_bytes);
  std::cout << json_text(json, 2) << "\n";
}

std::string frames_text(const Clip& clip) {
  return std::to_string(clip.first_frame) + "-" + std::to_string(clip.last_frame());
}

void print_clips(const std::vector<Clip>& clips, const FrameRate& rate) {
  if (clips.empty()) return;
  std::size_t width = 4;
  for (const Clip& clip : clips) width = std::max(width, printable(clip.name).size());
  std::printf("\n  %-*s %16s %10s\n", static_cast<int>(width), "clip", "frames", "seconds");
  for (const Clip& clip : clips) {
    std::printf("  %-*s %16s %10.3f\n", static_cast<int>(width), printable(clip.name).c_str(),
                frames_text(clip).c_str(), clip_seconds(rate, clip.num_frames));
  }
}

std::string clips_text(const std::vector<Clip>& clips) {
  std::string text;
  for (const Clip& clip : clips) {
    text += (text.empty() ? "" : ", ") + printable(clip.name) + " " + frames_text(clip);
  }
  return text;
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
              h.frame_rate.denominator,
              counted(s.summary.gofs.size(), {"GOF", "GOFs"}).c_str());
  print_kinds(s.summary);
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
  print_clips(s.clips, h.frame_rate);
  const std::vector<std::string> attributes = s.attributes.lines();
  if (!attributes.empty()) std::printf("\n  attributes\n");
  for (const std::string& line : attributes) std::printf("    %s\n", line.c_str());
  if (!s.metadata.empty())
    std::printf("\n  metadata: %s\n", printable_lines(s.metadata).c_str());
  if (s.coarse != nullptr) print_coarse_meshes(*s.coarse);
  if (with_gofs) print_all(s.summary);
}

std::string joined(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += (text.empty() ? "" : "; ") + line;
  return text;
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
  if (!s.clips.empty()) page.add_fact("clips", clips_text(s.clips));
  if (const auto lines = s.attributes.lines(); !lines.empty()) {
    page.add_fact("attributes", joined(lines));
  }
  if (!s.metadata.empty()) page.add_fact("metadata", s.metadata);
  const StreamRates rates{h.num_vertices, h.num_frames, s.bytes, &s.counter, &s.summary};
  const double total = 8.0 * static_cast<double>(s.bytes);
  const double seconds =
      static_cast<double>(h.num_frames) * h.frame_rate.denominator / h.frame_rate.numerator;
  page.add_key_figures({{number_text(bpvf(s, total)), "bits per vertex and frame"},
                        {grouped_text(s.bytes), "bytes"},
                        {number_text(total / seconds / 1000, 3), "kbit per second"},
                        {number_text(96 / bpvf(s, total), 3) + " : 1", "against 32-bit floats"},
                        {std::to_string(s.summary.gofs.size()),
                         s.summary.gofs.size() == 1 ? "group of frames" : "groups of frames"}});
  add_rate_section(page, rates);
  add_gof_section(page, rates);
  add_picture_section(page, *s.pictured);
  if (s.coarse != nullptr)
    add_coarse_section(page, *s.coarse, s.pictured->frame, s.pictured->xyz);
  return page.text();
}

}  // namespace rlpc
