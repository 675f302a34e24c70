// Charts over the frames of an animation, as SVG within HTML. Colours and fonts come from the
// style of the page; values under the pointer from its script, which finds them in the data
// attributes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Of lines and bars alike: what a colour stands for.
struct ChartSeries {
  std::string name;
  std::string colour;  // as in CSS
  std::vector<double> values;
  bool worst_is_smallest = false;  // as of PSNR
};

// One value of each series for each frame; what is no finite number is left out. Of long
// animations, the worst of several frames; the axis says so.
std::string line_chart(std::string_view title, std::string_view unit,
                       const std::vector<ChartSeries>& series);

// Bars that follow each other along the frames, each as wide as its frames and with the values
// of all series upon each other.
struct Bar {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
};
std::string stacked_bars(std::string_view title, std::string_view unit,
                         const std::vector<Bar>& bars, const std::vector<ChartSeries>& series);

// One line, with a share for each series' first value.
std::string stacked_line(const std::vector<ChartSeries>& series);

}  // namespace rlpc
