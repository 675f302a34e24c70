#include "decoder/report/svg_plot.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "decoder/report/html_page.h"
#include "decoder/report/svg_axis.h"

namespace rlpc {
namespace {

constexpr double kHeight = 600;
constexpr double kLeft = 80;
constexpr double kRight = 670;
constexpr double kTop = 56;
constexpr double kBottom = 536;
constexpr double kLegendGap = 22;
constexpr double kNameLeft = 44;  // in the legend, after the line
constexpr double kLegendWidth = 228;
constexpr double kCharacter = 8;  // width: names in wide fonts have room
constexpr const char* kInk = "#222222";
constexpr const char* kFaint = "#e4e4e4";

Axis axis_of(const Plot& plot, std::size_t which, double first_pixel, double last_pixel) {
  const PlotAxis& axis = which == 0 ? plot.x : plot.y;
  if (!axis.categories.empty()) {
    return {0.5, static_cast<double>(axis.categories.size()) + 0.5, false, first_pixel,
            last_pixel};
  }
  double low = HUGE_VAL;
  double high = -HUGE_VAL;
  for (const PlotSeries& series : plot.series) {
    for (const auto& point : series.points) {
      low = std::min(low, point[which]);
      high = std::max(high, point[which]);
    }
  }
  if (axis.is_log) return {low / 1.15, high * 1.15, true, first_pixel, last_pixel};
  low = std::min(low, 0.0);
  const double span = high - low;
  return {low, high + (span > 0 ? 0.04 * span : 1), false, first_pixel, last_pixel};
}

std::string words(double x, double y, std::string_view anchor, std::string_view text, int size,
                  const std::string& more = "") {
  return svg_text(x, y, anchor, text, " font-size=\"" + std::to_string(size) + "\"" + more);
}

struct Tick {
  double value = 0;
  std::string words;
};

std::vector<Tick> ticks_of(const PlotAxis& axis, const Axis& scale) {
  std::vector<Tick> ticks;
  for (const std::string& name : axis.categories) {
    ticks.push_back({static_cast<double>(ticks.size()) + 1, name});
  }
  if (!ticks.empty()) return ticks;
  for (const double value : scale.ticks(8)) ticks.push_back({value, tick_text(value)});
  return ticks;
}

std::string grid(const Plot& plot, const Axis& x_axis, const Axis& y_axis) {
  std::string svg;
  const auto line = [&svg](const std::string& path) {
    svg += "<path d=\"" + path + "\" stroke=\"" + kFaint + "\"/>\n";
  };
  for (const Tick& tick : ticks_of(plot.x, x_axis)) {
    const double x = x_axis.at(tick.value);
    line("M" + pixel_text(x) + " " + pixel_text(kTop) + "V" + pixel_text(kBottom));
    svg += words(x, kBottom + 20, "middle", tick.words, 13);
  }
  for (const Tick& tick : ticks_of(plot.y, y_axis)) {
    const double y = y_axis.at(tick.value);
    line("M" + pixel_text(kLeft) + " " + pixel_text(y) + "H" + pixel_text(kRight));
    svg += words(kLeft - 8, y + 4.5, "end", tick.words, 13);
  }
  svg += "<rect x=\"" + pixel_text(kLeft) + "\" y=\"" + pixel_text(kTop) + "\" width=\"" +
         pixel_text(kRight - kLeft) + "\" height=\"" + pixel_text(kBottom - kTop) +
         "\" fill=\"none\" stroke=\"" + kInk + "\"/>\n";
  svg += words((kLeft + kRight) / 2, kHeight - 18, "middle", plot.x.label, 14);
  const double middle = (kTop + kBottom) / 2;
  return svg + words(22, middle, "middle", plot.y.label, 14,
                     " transform=\"rotate(-90 22 " + pixel_text(middle) + ")\"");
}

std::string line_style(const PlotSeries& series) {
  return "fill=\"none\" stroke=\"" + escape_html(series.colour) + "\" stroke-width=\"" +
         tick_text(series.width) + "\"" +
         (series.line == PlotLine::kDashed ? " stroke-dasharray=\"7 4\"" : "");
}

std::string marker(const PlotSeries& series, double x, double y) {
  const std::string colour = escape_html(series.colour);
  switch (series.marker) {
    case PlotMarker::kCircle:
      return "<circle cx=\"" + pixel_text(x) + "\" cy=\"" + pixel_text(y) +
             "\" r=\"3.4\" fill=\"" + colour + "\"/>\n";
    case PlotMarker::kSquare:
      return "<rect x=\"" + pixel_text(x - 4.5) + "\" y=\"" + pixel_text(y - 4.5) +
             "\" width=\"9\" height=\"9\" fill=\"white\" stroke=\"" + colour +
             "\" stroke-width=\"2\"/>\n";
    case PlotMarker::kNone:
      break;
  }
  return "";
}

std::string curve(const PlotSeries& series, const Axis& x_axis, const Axis& y_axis) {
  std::string path;
  std::string markers;
  for (const auto& [x_value, y_value] : series.points) {
    const double x = x_axis.at(x_value);
    const double y = y_axis.at(y_value);
    path += (path.empty() ? "M" : "L") + pixel_text(x) + " " + pixel_text(y);
    markers += marker(series, x, y);
  }
  if (series.line == PlotLine::kNone || path.empty()) return markers;
  return "<path d=\"" + path + "\" stroke-linejoin=\"round\" " + line_style(series) + "/>\n" +
         markers;
}

std::string legend(const std::vector<PlotSeries>& all) {
  const double x = kRight + kLegendGap;
  double y = kTop + 14;
  std::string svg;
  for (const PlotSeries& series : all) {
    if (series.line != PlotLine::kNone) {
      svg += "<path d=\"M" + pixel_text(x) + " " + pixel_text(y) + "h34\" " +
             line_style(series) + "/>\n";
    }
    svg += marker(series, x + 17, y) + words(x + kNameLeft, y + 4.5, "start", series.name, 13);
    y += 24;
  }
  return svg;
}

}  // namespace

std::string check_plot(const Plot& plot) {
  bool is_empty = true;
  const auto is_category = [](const PlotAxis& axis, double value) {
    return axis.categories.empty() ||
           (value >= 1 && value <= static_cast<double>(axis.categories.size()) &&
            value == std::floor(value));
  };
  for (const PlotSeries& series : plot.series) {
    for (const auto& [x, y] : series.points) {
      is_empty = false;
      if (!std::isfinite(x) || !std::isfinite(y)) return series.name + ": not a finite number";
      if (!is_category(plot.x, x) || !is_category(plot.y, y)) {
        return series.name + ": not the number of a category";
      }
      if ((plot.x.is_log && x <= 0) || (plot.y.is_log && y <= 0)) {
        return series.name + ": not above 0, but the axis is logarithmic";
      }
    }
  }
  return is_empty ? "no points" : "";
}

std::string plot_svg(const Plot& plot) {
  assert(check_plot(plot).empty());
  std::size_t longest = 0;
  for (const PlotSeries& series : plot.series) longest = std::max(longest, series.name.size());
  const double width =
      kRight + kLegendGap +
      std::max(kLegendWidth, kNameLeft + kCharacter * static_cast<double>(longest));
  const std::string size =
      "width=\"" + tick_text(width) + "\" height=\"" + tick_text(kHeight) + "\"";
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" " + size + " viewBox=\"0 0 " +
                    tick_text(width) + " " + tick_text(kHeight) +
                    "\" font-family=\"Helvetica, Arial, sans-serif\" fill=\"" + kInk +
                    "\">\n<rect " + size + " fill=\"white\"/>\n";
  svg += words(kLeft, 32, "start", plot.title, 17, " font-weight=\"bold\"");
  const Axis x_axis = axis_of(plot, 0, kLeft, kRight);
  const Axis y_axis = axis_of(plot, 1, kBottom, kTop);
  svg += grid(plot, x_axis, y_axis);
  for (const PlotSeries& series : plot.series) svg += curve(series, x_axis, y_axis);
  return svg + legend(plot.series) + "</svg>\n";
}

}  // namespace rlpc
