// Tests of axes, and of plots as SVG files.
#include "decoder/report/svg_plot.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "decoder/report/svg_axis.h"
#include "decoder/testing/occurrences.h"

namespace rlpc {
namespace {

Plot two_points(const std::string& name) {
  return {"t", {"x", true}, {"y", false}, {{name, "red", {{1, 1}, {100, 3}}}}};
}

TEST(Axis, TicksAreRound) {
  EXPECT_EQ(Axis(0, 10, false, 0, 1).ticks(5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(Axis(-3, 4, false, 0, 1).ticks(4), (std::vector<double>{-2, 0, 2, 4}));
  EXPECT_EQ(Axis(0, 2, false, 0, 1).ticks(8, 1), (std::vector<double>{0, 1, 2}));
  const auto logarithmic = Axis(0.15, 6, true, 0, 1).ticks(8);
  ASSERT_EQ(logarithmic.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_DOUBLE_EQ(logarithmic[i], (std::vector<double>{0.2, 0.5, 1, 2, 5})[i]);
  }
}

TEST(Axis, PlacesAreLinearOrLogarithmic) {
  EXPECT_DOUBLE_EQ(Axis(-1, 3, false, 100, 200).at(0), 125);
  EXPECT_DOUBLE_EQ(Axis(1, 100, true, 200, 100).at(10), 150);
}

TEST(Plot, LinesMarkersAndLegendFollowTheSeries) {
  Plot plot = two_points("a & b");
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(occurrences(svg, "<circle"), 3U);  // one of them in the legend
  EXPECT_EQ(occurrences(svg, ">a &amp; b</text>"), 1U);
  EXPECT_EQ(occurrences(svg, "stroke=\"red\""), 2U);
  EXPECT_EQ(occurrences(svg, "dasharray"), 0U);
  plot.series[0].line = PlotLine::kDashed;
  plot.series[0].marker = PlotMarker::kSquare;
  EXPECT_EQ(occurrences(plot_svg(plot), "dasharray"), 2U);
  EXPECT_EQ(occurrences(plot_svg(plot), "<rect"), 2U + 3U);  // page and frame
  plot.series[0].line = PlotLine::kNone;
  plot.series[0].marker = PlotMarker::kNone;
  EXPECT_EQ(occurrences(plot_svg(plot), "red"), 0U);
}

TEST(Plot, LongNamesHaveRoom) {
  const auto width = [](const std::string& name) {
    const std::string svg = plot_svg(two_points(name));
    return std::stod(svg.substr(svg.find("width=\"") + 7));
  };
  EXPECT_EQ(width("a"), width("ab"));
  EXPECT_GT(width(std::string(30, 'a')), width("a") + 40);
}

TEST(Plot, ReportsWhyAPlotCannotBeDrawn) {
  Plot plot = two_points("a");
  EXPECT_EQ(check_plot(plot), "");
  plot.series[0].points.push_back({0, 5});
  EXPECT_EQ(check_plot(plot), "a: not above 0, but the axis is logarithmic");
  plot.series[0].points.back() = {5, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(check_plot(plot), "a: not a finite number");
  plot.series[0].points.clear();
  EXPECT_EQ(check_plot(plot), "no points");
}

TEST(Plot, CategoriesHaveWordsInPlaceOfNumbers) {
  Plot plot{"t", {"kind", false, {"first & last", "none"}}, {"y", false, {}}, {}};
  plot.series.push_back({"a", "red", {{1, 7}, {2, 9}}});
  ASSERT_EQ(check_plot(plot), "");
  const std::string svg = plot_svg(plot);
  EXPECT_NE(svg.find(">first &amp; last</text>"), std::string::npos);
  EXPECT_NE(svg.find(">none</text>"), std::string::npos);
  for (const char* number : {">1</text>", ">0.5</text>", ">1.5</text>", ">2.5</text>"}) {
    EXPECT_EQ(svg.find(number), std::string::npos) << number;
  }
  for (const double wrong : {0.0, 1.5, 3.0}) {
    plot.series[0].points[0][0] = wrong;
    EXPECT_EQ(check_plot(plot), "a: not the number of a category");
  }
}

TEST(Plot, OnePointIsEnough) {
  Plot plot = two_points("a");
  plot.series[0].points = {{7, -2}};
  const std::string svg = plot_svg(plot);
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

}  // namespace
}  // namespace rlpc
