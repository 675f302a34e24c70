#include "decoder/report/svg_chart.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "common/json/json.h"
#include "decoder/report/html_page.h"
#include "decoder/report/svg_axis.h"

namespace rlpc {
namespace {

constexpr double kWidth = 560;
constexpr double kChartHeight = 270;
constexpr double kLeftMargin = 64;
constexpr double kRightMargin = 14;
constexpr double kTopMargin = 14;
constexpr double kBottomMargin = 42;
constexpr std::size_t kMaxPoints = 1000;  // per line

struct Frames {
  Axis x;
  Axis y;
};

Frames axes(double last_frame, double highest) {
  return {Axis(0, last_frame, false, kLeftMargin, kWidth - kRightMargin),
          Axis(0, highest > 0 ? 1.06 * highest : 1, false, kChartHeight - kBottomMargin,
               kTopMargin)};
}

std::string grid(const Frames& axes, std::string_view x_label) {
  std::string svg;
  for (const double value : axes.y.ticks(5)) {
    const std::string y = pixel_text(axes.y.at(value));
    svg += "<path class=\"grid\" d=\"M" + pixel_text(kLeftMargin) + " " + y + "H" +
           pixel_text(kWidth - kRightMargin) + "\"/>\n" +
           svg_text(kLeftMargin - 8, axes.y.at(value) + 4, "end", tick_text(value));
  }
  for (const double value : axes.x.ticks(8, 1)) {
    svg += svg_text(axes.x.at(value), kChartHeight - kBottomMargin + 18, "middle",
                    tick_text(value));
  }
  return svg + svg_text((kLeftMargin + kWidth - kRightMargin) / 2, kChartHeight - 4, "middle",
                        x_label);
}

std::string legend(const std::vector<ChartSeries>& series) {
  std::string html = "<div class=\"legend\">";
  for (const ChartSeries& s : series) {
    html +=
        "<span><i style=\"background:" + s.colour + "\"></i>" + escape_html(s.name) + "</span>";
  }
  return html + "</div>\n";
}

std::string figure(std::string_view title, std::string_view unit, const std::string& svg,
                   const std::vector<ChartSeries>& series, nlohmann::ordered_json data) {
  data["left"] = kLeftMargin;
  data["right"] = kWidth - kRightMargin;
  data["top"] = kTopMargin;
  data["bottom"] = kChartHeight - kBottomMargin;
  for (const ChartSeries& s : series) data["names"].push_back(s.name);
  std::string html = "<figure class=\"card chart\" data-chart=\"";
  html += escape_html(json_text(data)) + "\">\n<figcaption><b>" + escape_html(title) +
          "</b> <span>";
  html += escape_html(unit) + "</span></figcaption>\n<svg viewBox=\"0 0 " + tick_text(kWidth) +
          " " + tick_text(kChartHeight) + "\" role=\"img\" aria-label=\"" + escape_html(title) +
          "\">\n";
  return html + svg + "</svg>\n" + legend(series) + "</figure>\n";
}

// Returns the worst of every `group` values, of the finite ones if any.
std::vector<double> grouped(const ChartSeries& series, std::size_t group) {
  const auto takes_its_place = [&](double value, double worst) {
    if (!std::isfinite(value) || !std::isfinite(worst)) return std::isfinite(value);
    return series.worst_is_smallest ? value < worst : value > worst;
  };
  std::vector<double> worst;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const double value = series.values[i];
    if (i % group == 0) {
      worst.push_back(value);
    } else if (takes_its_place(value, worst.back())) {
      worst.back() = value;
    }
  }
  return worst;
}

// Returns the axis label of groups.
std::string frame_label(const std::vector<ChartSeries>& series, std::size_t group) {
  if (group == 1) return "frame";
  const auto count = std::count_if(series.begin(), series.end(),
                                   [](const ChartSeries& s) { return s.worst_is_smallest; });
  const bool all = count == static_cast<std::ptrdiff_t>(series.size());
  const std::string worst = count == 0 ? "largest" : all ? "smallest" : "worst";
  return "frame; the " + worst + " of " + std::to_string(group) + " each";
}

double rounded(double value) {  // to the digits shown
  char text[32];
  std::snprintf(text, sizeof text, "%.5g", value);
  return std::strtod(text, nullptr);
}

std::string line(const ChartSeries& series, const Frames& axes, std::size_t group) {
  std::string path;
  bool open = false;
  std::size_t points = 0;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    if (!std::isfinite(series.values[i])) {
      open = false;
      continue;
    }
    path += open ? "L" : "M";
    path += pixel_text(axes.x.at(static_cast<double>(i * group))) + " " +
            pixel_text(axes.y.at(series.values[i]));
    open = true;
    ++points;
  }
  if (points == 1) path += "h0.1";  // a dot, with round ends
  return "<path class=\"line\" d=\"" + path + "\" stroke=\"" + series.colour + "\"/>\n";
}

}  // namespace

std::string line_chart(std::string_view title, std::string_view unit,
                       const std::vector<ChartSeries>& series) {
  const std::size_t num_frames = series.front().values.size();
  const std::size_t group = (num_frames + kMaxPoints - 1) / kMaxPoints;
  std::vector<ChartSeries> shown = series;
  double highest = 0;
  nlohmann::ordered_json data = {{"group", group}, {"frames", num_frames}};
  for (ChartSeries& s : shown) {
    s.values = grouped(s, group);
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    for (const double value : s.values) {
      if (std::isfinite(value)) highest = std::max(highest, value);
      values.push_back(rounded(value));  // infinite: null
    }
    data["values"].push_back(std::move(values));
  }
  const double last = std::max<double>(1, static_cast<double>(num_frames) - 1);
  data["last"] = last;
  const Frames frames = axes(last, highest);
  std::string svg = grid(frames, frame_label(series, group));
  for (const ChartSeries& s : shown) svg += line(s, frames, group);
  return figure(title, unit, svg, shown, std::move(data));
}

std::string stacked_bars(std::string_view title, std::string_view unit,
                         const std::vector<Bar>& bars, const std::vector<ChartSeries>& series) {
  double highest = 0;
  nlohmann::ordered_json data;
  for (std::size_t b = 0; b < bars.size(); ++b) {
    double sum = 0;
    for (const ChartSeries& s : series) sum += s.values[b];
    highest = std::max(highest, sum);
    data["bars"].push_back({bars[b].first_frame, bars[b].num_frames});
  }
  const double end = bars.back().first_frame + bars.back().num_frames;
  data["last"] = end;
  const Frames frames = axes(end, highest);
  std::string svg = grid(frames, "frame");
  std::vector<double> below(bars.size(), 0.0);
  for (const ChartSeries& s : series) {
    nlohmann::ordered_json values = nlohmann::ordered_json::array();
    std::string path;
    for (std::size_t b = 0; b < bars.size(); ++b) {
      values.push_back(rounded(s.values[b]));
      const double left = frames.x.at(bars[b].first_frame);
      const double right = frames.x.at(bars[b].first_frame + bars[b].num_frames);
      const double gap = right - left > 4 ? 1 : 0;  // between bars that are wide enough
      path += "M" + pixel_text(left) + " " + pixel_text(frames.y.at(below[b])) + "V" +
              pixel_text(frames.y.at(below[b] + s.values[b])) + "H" + pixel_text(right - gap) +
              "V" + pixel_text(frames.y.at(below[b])) + "z";
      below[b] += s.values[b];
    }
    data["values"].push_back(std::move(values));
    svg += "<path d=\"" + path + "\" fill=\"" + s.colour + "\"/>\n";
  }
  return figure(title, unit, svg, series, std::move(data));
}

std::string stacked_line(const std::vector<ChartSeries>& series) {
  double sum = 0;
  for (const ChartSeries& s : series) sum += s.values.front();
  std::string html = "<div class=\"stack\">";
  for (const ChartSeries& s : series) {
    const double share = 100 * s.values.front() / sum;
    html += "<i style=\"background:" + s.colour + ";width:" + number_text(share) +
            "%\" title=\"" + escape_html(s.name) + ": " + number_text(share, 3) + " %\"></i>";
  }
  return html + "</div>\n";
}

}  // namespace rlpc
