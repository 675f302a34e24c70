// Line plots as SVG files with all styles, for papers and pages.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace rlpc {

enum class PlotLine { kSolid, kDashed, kNone };
enum class PlotMarker { kCircle, kSquare, kNone };

struct PlotSeries {
  std::string name;
  std::string colour;  // CSS
  std::vector<std::array<double, 2>> points;
  PlotLine line = PlotLine::kSolid;
  PlotMarker marker = PlotMarker::kCircle;
  double width = 2.0;
};

struct PlotAxis {
  std::string label;
  bool is_log = false;  // true: values are above 0; false: 0 is on the axis
  // Words at 1, 2, 3 ... in place of numbers, on a linear axis; empty: numbers.
  std::vector<std::string> categories = {};
};

struct Plot {
  std::string title;
  PlotAxis x;
  PlotAxis y;
  std::vector<PlotSeries> series;
};

// Returns why a plot cannot be drawn; empty if it can.
std::string check_plot(const Plot& plot);

// Returns the plot as SVG. check_plot() must have passed.
std::string plot_svg(const Plot& plot);

}  // namespace rlpc
