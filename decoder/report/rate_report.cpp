#include "decoder/report/rate_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <vector>

#include "decoder/report/svg_chart.h"

namespace rlpc {
namespace {

constexpr std::size_t kMaxBars = 300;
constexpr std::size_t kMaxGofRows = 200;
constexpr std::size_t kMaxSliceTables = 20;

// Colours of the parts, in their order, the same on all pages. Parts that are usually the
// largest have the first colours of the plots of scripts/compare.
constexpr std::array<const char*, kNumStreamParts> kColours{
    "#8a8f98", "#b9bec6", "#0072b2", "#56b4e9", "#5f6b7a", "#d55e00",
    "#e69f00", "#009e73", "#8c564b", "#b8a800", "#a6761d", "#cc79a7",
    "#7b61c4", "#1f8a9e", "#3f7d20", "#94b447", "#c4c9d1"};

// Returns a series per part that occurs, with its bits as the only value.
std::vector<ChartSeries> part_series(const PartSizes& bits) {
  std::vector<ChartSeries> series;
  for (std::size_t p = 0; p < kNumStreamParts; ++p) {
    if (bits[p] == 0) continue;
    series.push_back(
        {std::string(stream_part_names()[p]), kColours[p], {static_cast<double>(bits[p])}});
  }
  std::stable_sort(series.begin(), series.end(), [](const auto& a, const auto& b) {
    return a.values.front() > b.values.front();
  });
  return series;
}

std::string cell(const std::string& text) { return "<td>" + escape_html(text) + "</td>"; }

std::string frames_text(const GofSummary& gof) {
  return std::to_string(gof.first_frame) + " – " +
         std::to_string(gof.first_frame + gof.num_frames - 1);
}

std::uint64_t sum(const PartSizes& bits) {
  std::uint64_t total = 0;
  for (const std::uint64_t part : bits) total += part;
  return total;
}

// Returns a row per temporal layer except the first, with the totals of its slices.
std::string temporal_layer_rows(const SlicedSummary& summary) {
  std::string html;
  for (std::uint32_t layer = 1; layer < summary.num_temporal_layers(); ++layer) {
    const std::uint64_t with =
        summary.totals({SliceCut::kAll, SliceCut::kAll, layer + 1}).bytes;
    const std::uint64_t without = summary.totals({SliceCut::kAll, SliceCut::kAll, layer}).bytes;
    html += "<tr>" + cell("temporal layer " + std::to_string(layer)) +
            cell(grouped_text(with - without));
    for (std::size_t i = 1; i < summary.layer_group_size.size(); ++i) html += cell("");
    html += cell(grouped_text(with)) + "</tr>\n";
  }
  return html;
}

// Returns a row per component group, a column per layer group, and the size of the GOF or
// shared rig when cut after each of them; and a row per temporal layer.
template <class Summary>
std::string slice_table(const Summary& summary, const std::string& to_here) {
  std::string html = "<div class=\"wide\"><table>\n<thead><tr><th>bytes of slices</th>";
  const std::size_t columns = summary.layer_group_size.size();
  for (const std::uint32_t layers : summary.layer_group_size) {
    html += "<th>" + std::to_string(layers) + (layers == 1 ? " layer</th>" : " layers</th>");
  }
  html += "<th>" + to_here + "</th></tr></thead>\n";
  // Component groups begin with 1 in a GOF that uses a shared rig.
  const std::vector<SliceEntry> slices = summary.slices_by_group();
  std::uint32_t group = slices.front().component_group_idx;
  const auto end = std::find_if(slices.begin(), slices.end(),
                                [](const SliceEntry& s) { return s.temporal_layer_idx > 0; });
  for (auto slice = slices.begin(); slice != end; ++group) {
    html += "<tr>";
    html += cell(group == 0 ? summary.first_group
                            : "group " + std::to_string(group) +
                                  ", trajectories: " + std::to_string(slice->num_trajectories));
    for (std::size_t layers = 0; layers < columns; ++layers) {
      const bool present = slice != end && slice->component_group_idx == group;
      html += cell(present ? grouped_text(slice->bytes) : "");
      if (present) ++slice;
    }
    html += cell(grouped_text(summary.totals({group + 1, SliceCut::kAll}).bytes)) + "</tr>\n";
  }
  html += "<tr>" + cell(to_here);
  for (std::uint32_t layers = 0; layers < columns; ++layers) {
    html += cell(grouped_text(summary.totals({SliceCut::kAll, layers + 1}).bytes));
  }
  return html + cell("") + "</tr>\n" + temporal_layer_rows(summary) + "</table></div>\n";
}

std::string part_table(const StreamRates& rates, const std::vector<ChartSeries>& series) {
  const double total = 8.0 * static_cast<double>(rates.bytes);
  std::string html =
      "<div class=\"card wide\"><table>\n<thead><tr><th>part</th><th>bytes</th>"
      "<th>share</th><th>bpvf</th></tr></thead>\n";
  const auto row = [&](const std::string& name, double bits) {
    html += "<tr><td>" + name + "</td>" +
            cell(grouped_text(static_cast<std::uint64_t>(std::llround(bits / 8)))) +
            cell(number_text(100 * bits / total, 3) + " %") +
            cell(number_text(rates.bpvf(bits))) + "</tr>\n";
  };
  for (const ChartSeries& s : series) {
    row("<i class=\"swatch\" style=\"background:" + s.colour + "\"></i>" + escape_html(s.name),
        s.values.front());
  }
  row("<b>all</b>", total);
  return html + "</table></div>\n";
}

// Draws the rates of GOFs, without shared rigs, which belong to several GOFs.
std::string gof_rate_chart(const StreamRates& rates) {
  const std::vector<GofSummary>& gofs = rates.summary->gofs;
  const std::vector<PartSizes>& bits = rates.counter->gof_bits();
  const std::size_t together = (gofs.size() + kMaxBars - 1) / kMaxBars;
  std::vector<Bar> bars;
  std::vector<PartSizes> bar_bits;
  PartSizes all{};
  for (std::size_t g = 0; g < gofs.size(); ++g) {
    if (g % together == 0) {
      bars.push_back({gofs[g].first_frame, 0});
      bar_bits.emplace_back();
    }
    bars.back().num_frames += gofs[g].num_frames;
    for (std::size_t p = 0; p < kNumStreamParts; ++p) {
      bar_bits.back()[p] += bits[g][p];
      all[p] += bits[g][p];
    }
  }
  std::vector<ChartSeries> series;
  for (std::size_t p = 0; p < kNumStreamParts; ++p) {
    if (all[p] == 0) continue;
    ChartSeries s{std::string(stream_part_names()[p]), kColours[p], {}};
    for (std::size_t b = 0; b < bars.size(); ++b) {
      s.values.push_back(static_cast<double>(bar_bits[b][p]) /
                         (static_cast<double>(rates.num_vertices) * bars[b].num_frames));
    }
    series.push_back(std::move(s));
  }
  const std::string title =
      (together == 1 ? "Rate of each GOF"
                     : "Rate of " + std::to_string(together) + " GOFs each") +
      std::string(rates.summary->rigs.empty() ? "" : ", without shared rigs");
  return stacked_bars(title, "bits per vertex and frame", bars, series);
}

}  // namespace

void add_rate_section(HtmlPage& page, const StreamRates& rates) {
  const std::vector<ChartSeries> series = part_series(rates.counter->bits());
  page.add_section(
      "Rate",
      "Everything in the file is counted. bpvf: bits per vertex and frame. GOF: group of "
      "frames, with its slices and hashes.",
      stacked_line(series) + "<div class=\"charts\">\n" + part_table(rates, series) +
          gof_rate_chart(rates) + "</div>\n");
}

// Returns the displayed counts of each kind of GOF that occurs.
std::vector<GofFigure> figures_of_all_kinds(const std::vector<GofSummary>& gofs) {
  std::vector<GofFigure> figures;
  std::set<GofKind> kinds;
  for (const GofSummary& gof : gofs) {
    if (!kinds.insert(gof.kind).second) continue;
    for (const GofFigure& figure : gof.figures) {
      if (figure.many != nullptr) figures.push_back(figure);
    }
  }
  return figures;
}

namespace {

// Returns rows with the figures, bytes and slices of each shared rig.
std::string rig_table(const StreamRates& rates) {
  const auto& rigs = rates.summary->rigs;
  if (rigs.empty()) return "";
  std::string html =
      "<div class=\"card wide\"><table>\n<thead><tr><th>shared rig</th><th>GOFs</th>";
  for (const GofFigure& figure : rigs[0]->figures) {
    if (figure.many != nullptr) html += std::string("<th>") + figure.many + "</th>";
  }
  html += "<th>bytes</th></tr></thead>\n";
  for (std::size_t m = 0; m < std::min(rigs.size(), kMaxGofRows); ++m) {
    html += "<tr>" + cell(std::to_string(m)) + cell(grouped_text(rigs[m]->num_gofs));
    for (const GofFigure& figure : rigs[m]->figures) {
      if (figure.many != nullptr) html += cell(grouped_text(figure.value));
    }
    html += cell(grouped_text(sum(rates.counter->model_bits()[m]) / 8)) + "</tr>\n";
  }
  html += "</table></div>\n";
  for (std::size_t m = 0; m < std::min(rigs.size(), kMaxSliceTables); ++m) {
    if (rigs[m]->slices.empty()) continue;
    html += "<details class=\"card\"><summary>Slices of shared rig " + std::to_string(m) +
            "</summary>\n" + slice_table(*rigs[m], "rig to here") + "</details>\n";
  }
  return html;
}

}  // namespace

void add_gof_section(HtmlPage& page, const StreamRates& rates) {
  const std::vector<GofSummary>& gofs = rates.summary->gofs;
  const bool has_rigs = !rates.summary->rigs.empty();
  const std::vector<GofFigure> columns = figures_of_all_kinds(gofs);
  std::string html =
      rig_table(rates) + "<div class=\"card wide\"><table>\n<thead><tr><th>frames</th>";
  if (has_rigs) html += "<th>shared rig</th>";
  for (const GofFigure& column : columns) html += std::string("<th>") + column.many + "</th>";
  html += "<th>bytes</th><th>bpvf</th></tr></thead>\n";
  const auto count = [](std::uint64_t n) { return cell(n == 0 ? "" : grouped_text(n)); };
  for (std::size_t g = 0; g < std::min(gofs.size(), kMaxGofRows); ++g) {
    const GofSummary& gof = gofs[g];
    const std::uint64_t bits = sum(rates.counter->gof_bits()[g]);
    html += "<tr>" + cell(frames_text(gof));
    if (has_rigs) html += cell(gof.rig ? std::to_string(gof.rig->number) : "");
    for (const GofFigure& column : columns) html += count(gof.figure(column.key));
    html += count(bits / 8) +
            cell(number_text(static_cast<double>(bits) /
                             (static_cast<double>(rates.num_vertices) * gof.num_frames))) +
            "</tr>\n";
  }
  html += "</table></div>\n";
  if (gofs.size() > kMaxGofRows) {
    html += "<p class=\"note\">The first " + std::to_string(kMaxGofRows) + " of " +
            std::to_string(gofs.size()) + ". rlpcinfo --gofs lists all.</p>\n";
  }
  for (std::size_t g = 0; g < std::min(gofs.size(), kMaxSliceTables); ++g) {
    if (gofs[g].slices.empty()) continue;
    html += "<details class=\"card\"><summary>Units of frames " +
            escape_html(frames_text(gofs[g])) + "</summary>\n" +
            slice_table(gofs[g], "GOF to here") + "</details>\n";
  }
  page.add_section(
      "Groups of frames",
      std::string(has_rigs ? "Each GOF decodes without the others, with its shared rig. "
                           : "GOFs decode independently. ") +
          "Those of bones can be cut to fewer components or "
          "layers, those of frames to fewer layers, without re-encoding (rlpcinfo --extract).",
      html);
}

}  // namespace rlpc
