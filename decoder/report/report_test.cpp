// Tests of the building blocks of pages.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include "decoder/meshes/base64.h"
#include "decoder/report/coarse_report.h"
#include "decoder/report/html_page.h"
#include "decoder/report/mesh_view.h"
#include "decoder/report/svg_chart.h"
#include "decoder/testing/occurrences.h"

namespace rlpc {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string encoded(const std::string& text) {
  const std::vector<std::uint8_t> bytes(text.begin(), text.end());
  return base64(bytes);
}

TEST(Report, NumbersHaveSignificantDigits) {
  EXPECT_EQ(number_text(0), "0");
  EXPECT_EQ(number_text(1), "1.000");
  EXPECT_EQ(number_text(0.012345), "0.01235");
  EXPECT_EQ(number_text(-12.3456), "-12.35");
  EXPECT_EQ(number_text(0.99996), "1.000");
  EXPECT_EQ(number_text(99.96, 3), "100");
  EXPECT_EQ(number_text(123456.7), "123457");
  EXPECT_EQ(number_text(1.5e-9, 3), "1.50e-09");
  EXPECT_EQ(number_text(kInfinity), "∞");
  EXPECT_EQ(grouped_text(0), "0");
  EXPECT_EQ(grouped_text(999), "999");
  EXPECT_EQ(grouped_text(1000), "1,000");
  EXPECT_EQ(grouped_text(1234567), "1,234,567");
}

TEST(Report, NamesCannotBecomeMarkup) {
  HtmlPage page("<script>alert('a & b')</script>");
  page.add_fact("name", "\"<b>\"");
  const std::string text = page.text();
  EXPECT_EQ(text.find("<script>alert"), std::string::npos);
  EXPECT_NE(text.find("&lt;script&gt;alert(&#39;a &amp; b&#39;)"), std::string::npos);
  EXPECT_NE(text.find("&quot;&lt;b&gt;&quot;"), std::string::npos);
}

TEST(Report, LongLinesShowTheLargestOfSeveralFrames) {
  ChartSeries series{"error", "red", std::vector<double>(2500, 1.0)};
  series.values[1234] = 7;
  const std::string html = line_chart("Errors", "units", {series});
  EXPECT_NE(html.find("the largest of 3 each"), std::string::npos);
  EXPECT_NE(html.find("7.0"), std::string::npos);
  EXPECT_EQ(line_chart("Errors", "units", {{"e", "red", {1, 2}}}).find("largest of"),
            std::string::npos);
}

// Returns the values that the script of the page shows, in groups of 2.
std::string shown_in_pairs(const std::vector<double>& first, bool worst_is_smallest) {
  ChartSeries series{"e", "red", std::vector<double>(2000, 1.0), worst_is_smallest};
  std::copy(first.begin(), first.end(), series.values.begin());
  const std::string html = line_chart("E", "u", {series});
  const std::string start = "values&quot;:[[";
  const std::size_t at = html.find(start) + start.size();
  return html.substr(at, html.find(",1.0,1.0", at) - at);
}

TEST(Report, LongLinesShowTheWorstOfSeveralFrames) {
  const std::vector<double> values{3, 2, 4, 7};
  EXPECT_EQ(shown_in_pairs(values, false), "3.0,7.0");
  EXPECT_EQ(shown_in_pairs(values, true), "2.0,4.0");
  ChartSeries error{"error", "red", std::vector<double>(1001, 1.0)};
  ChartSeries psnr{"psnr", "blue", error.values, true};
  const auto has = [](const std::string& html, const char* words) {
    return html.find(words) != std::string::npos;
  };
  EXPECT_TRUE(has(line_chart("E", "u", {error}), "the largest of 2 each"));
  EXPECT_TRUE(has(line_chart("E", "u", {psnr}), "the smallest of 2 each"));
  EXPECT_TRUE(has(line_chart("E", "u", {error, psnr}), "the worst of 2 each"));
}

TEST(Report, NonFiniteValuesLeaveNoGapInAGroup) {
  for (const double none : {kInfinity, -kInfinity, kNan}) {
    const std::vector<double> values{3, none, none, 4, none, none};
    EXPECT_EQ(shown_in_pairs(values, false), "3.0,4.0,null") << none;
    EXPECT_EQ(shown_in_pairs(values, true), "3.0,4.0,null") << none;
  }
}

TEST(Report, InfiniteValuesInterruptALine) {
  const std::string html = line_chart("E", "u", {{"e", "red", {1, 2, kInfinity, 3, 4}}});
  const std::size_t path = html.find("class=\"line\" d=\"");
  ASSERT_NE(path, std::string::npos);
  const std::string d = html.substr(path, html.find("stroke", path) - path);
  EXPECT_EQ(std::count(d.begin(), d.end(), 'M'), 2);
  EXPECT_EQ(std::count(d.begin(), d.end(), 'L'), 2);
  EXPECT_NE(html.find("null"), std::string::npos);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

TEST(Report, ViewsOmitFramesAboveTheirLimit) {
  const std::vector<Triangle> triangles{{0, 1, 2}};
  const FrameRate rate;
  const auto stride = [&](std::uint32_t frames, std::size_t bytes) {
    return MeshView(3, frames, triangles, rate, bytes).stride();
  };
  EXPECT_EQ(stride(10, 12 + 39 * 10), 1U);
  EXPECT_EQ(stride(10, 12 + 39 * 10 - 1), 2U);
  EXPECT_EQ(stride(10, 12 + 39), 10U);
  EXPECT_EQ(stride(10, 12 + 38), 0U);
  const MeshView none(3, 10, triangles, rate, 50);
  EXPECT_FALSE(none.shows(0));
  EXPECT_NE(none.note().find("too large"), std::string::npos);
  const MeshView half(3, 10, triangles, rate, 12 + 39 * 10 - 1);
  EXPECT_TRUE(half.shows(0) && half.shows(8));
  EXPECT_FALSE(half.shows(1) || half.shows(9));
  EXPECT_NE(half.note().find("every 2 frames"), std::string::npos);
  EXPECT_EQ(MeshView(3, 10, triangles, rate).note(), "");
}

TEST(Report, ViewsHoldPositionsAndErrorsInLevels) {
  MeshView view(2, 1, {}, FrameRate{});
  view.add_frame(std::vector<float>{0, 0, 5, 1, 0, 5}, std::vector<float>{0, 0, 5, 1, 2, 5});
  const std::string html = view.html(1);
  // x 0 and 65535, y 0, z has no extent.
  EXPECT_NE(html.find("id=\"mesh-original\">" +
                      encoded(std::string("\0\0\0\0\0\0\xFF\xFF\0\0\0\0", 12)) + "<"),
            std::string::npos);
  EXPECT_NE(html.find("id=\"mesh-decoded\">" +
                      encoded(std::string("\0\0\0\0\0\0\xFF\xFF\xFF\xFF\0\0", 12)) + "<"),
            std::string::npos);
  EXPECT_NE(html.find("id=\"mesh-errors\">" + encoded(std::string("\0\xFF", 2)) + "<"),
            std::string::npos);
}

CoarseMeshes strip_of_squares(std::uint32_t length) {
  std::vector<Triangle> triangles;
  for (std::uint32_t v = 0; v + 5 < 4 * length; ++v) {
    if (v % 4 == 3) continue;
    triangles.push_back({v, v + 1, v + 5});
    triangles.push_back({v, v + 5, v + 4});
  }
  return {4 * length, triangles};
}

TEST(Report, PicturesOfCoarseMeshesSpanTheSizesThatFit) {
  const CoarseMeshes meshes = strip_of_squares(200);
  const std::vector<std::uint32_t> all = layers_of_pictures(meshes, 1U << 24);
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all.back(), meshes.num_layers());
  for (std::size_t i = 1; i < all.size(); ++i) {
    const std::uint32_t fewer = meshes.size(all[i - 1]).num_triangles;
    const std::uint32_t more = meshes.size(all[i]).num_triangles;
    EXPECT_GT(more, 3 * fewer);
    EXPECT_LT(more, 5 * fewer);
  }
  const std::uint32_t num_triangles = meshes.size(4).num_triangles;
  EXPECT_EQ(layers_of_pictures(meshes, num_triangles).back(), 4U);
  EXPECT_EQ(layers_of_pictures(meshes, num_triangles - 1).back(), 3U);
  EXPECT_TRUE(layers_of_pictures(meshes, 0).empty());
  EXPECT_TRUE(layers_of_pictures(CoarseMeshes(3, {}), 10).empty()) << "points";
}

TEST(Report, PicturesOfCoarseMeshesShowAllTriangles) {
  const CoarseMeshes meshes = strip_of_squares(30);
  std::vector<float> xyz;
  for (std::uint32_t v = 0; v < 120; ++v) {
    for (const std::uint32_t x : {v / 4, v % 4, v % 3}) xyz.push_back(static_cast<float>(x));
  }
  HtmlPage page("coarse");
  add_coarse_section(page, meshes, 0, xyz);
  const std::string html = page.text();
  std::size_t triangles = 0;
  for (const std::uint32_t layers : layers_of_pictures(meshes, 6000)) {
    triangles += meshes.size(layers).num_triangles;
    EXPECT_NE(html.find(std::to_string(meshes.size(layers).num_vertices) + " vertices, "),
              std::string::npos);
  }
  EXPECT_EQ(occurrences(html, "<path class=\"m"), triangles);
  EXPECT_EQ(html.find("nan"), std::string::npos);
}

}  // namespace
}  // namespace rlpc
