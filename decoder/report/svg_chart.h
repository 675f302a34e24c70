// Charts over the frames of an animation, as SVG within HTML. Colours and fonts come from the
// style of the page; tooltips from its script, which reads the data attributes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Line or bars of a chart, with their legend.
struct ChartSeries {
  std::string name;
  std::string colour;  // CSS
  std::vector<double> values;
  bool worst_is_smallest = false;  // true for PSNR, for example
};

// Draws one value per series and frame; values that are not finite are omitted. Long animations
// show the worst of several frames each, which the axis states.
std::string line_chart(std::string_view title, std::string_view unit,
                       const std::vector<ChartSeries>& series);

// Frames of a stacked bar, which is as wide as they are.
struct Bar {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
};
std::string stacked_bars(std::string_view title, std::string_view unit,
                         const std::vector<Bar>& bars, const std::vector<ChartSeries>& series);

// Draws a single bar, divided by the first value of each series.
std::string stacked_line(const std::vector<ChartSeries>& series);

}  // namespace rlpc
