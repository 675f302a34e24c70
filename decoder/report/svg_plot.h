// Line plots as SVG files, for papers and pages: all styles are in them.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rlpc {

enum class PlotLine { kSolid, kDashed, kNone };
enum class PlotMarker { kCircle, kSquare, kNone };

struct PlotSeries {
  std::string name;
  std::string colour;  // as in CSS
  std::vector<std::array<double, 2>> points;
  PlotLine line = PlotLine::kSolid;
  PlotMarker marker = PlotMarker::kCircle;
  double width = 2.0;
};

struct PlotAxis {
  std::string label;
  bool is_log = false;  // values are above 0; else, 0 is on the axis
  // If there are any, the axis has these words at 1, 2, 3 ... in place of numbers, and is
  // linear.
  std::vector<std::string> categories = {};
};

struct Plot {
  std::string title;
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotSeries> series;
};

// The reason why a plot cannot be drawn; empty: it can.
std::string check_plot(const Plot& plot);

// The plot as SVG; it must be drawable.
std::string plot_svg(const Plot& plot);

}  // namespace rlpc
