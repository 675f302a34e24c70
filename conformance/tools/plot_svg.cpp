// plot_svg: draws measurements of scripts/compare, scripts/reproduce and scripts/bench.

#include <cstdio>
#include <exception>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/files/messages.h"
#include "common/json/json.h"
#include "decoder/report/svg_plot.h"

namespace {

constexpr const char* kUsage = R"(Draws a line plot.

  plot_svg <PLOT.json >PLOT.svg

PLOT.json: {"title": "", "x": {"label": "", "is_log": true}, "y": the same, "series": [
  {"name": "", "colour": "#0072b2", "points": [[x, y], ...], "line": "solid", "dashed" or "none",
   "marker": "circle", "square" or "none", "width": 2}, ...]}
With "categories": ["a", "b", ...], an axis has these words at 1, 2, ... in place of numbers.

Exit code: 0 drawn; 1 not a plot; 64 usage.
)";

template <class Kind>
Kind kind_of(const std::string& word, std::initializer_list<const char*> names) {
  int index = 0;
  for (const char* name : names) {
    if (word == name) return static_cast<Kind>(index);
    ++index;
  }
  throw std::runtime_error("unknown line or marker `" + word + "`");
}

rlpc::PlotAxis axis_of(const nlohmann::json& json) {
  return {json.at("label"), json.at("is_log"),
          json.value("categories", std::vector<std::string>())};
}

rlpc::Plot plot_of(const nlohmann::json& json) {
  rlpc::Plot plot{json.at("title"), axis_of(json.at("x")), axis_of(json.at("y")), {}};
  for (const nlohmann::json& s : json.at("series")) {
    plot.series.push_back(
        {s.at("name"), s.at("colour"), s.at("points"),
         kind_of<rlpc::PlotLine>(s.at("line"), {"solid", "dashed", "none"}),
         kind_of<rlpc::PlotMarker>(s.at("marker"), {"circle", "square", "none"}),
         s.at("width")});
  }
  return plot;
}

}  // namespace

int main(int argc, char**) try {
  if (argc > 1) {
    std::fputs(kUsage, stderr);
    return 64;
  }
  const std::string text(std::istreambuf_iterator<char>(std::cin), {});
  rlpc::JsonProblem problem;
  const auto json = rlpc::read_json<nlohmann::json>(text, UINT64_MAX, problem);
  if (!json) throw std::runtime_error(problem.message);
  const rlpc::Plot plot = plot_of(*json);
  if (const std::string wrong = rlpc::check_plot(plot); !wrong.empty()) {
    throw std::runtime_error(wrong);
  }
  std::cout << rlpc::plot_svg(plot) << std::flush;
  return std::cout ? 0 : 1;
} catch (const std::exception& error) {
  rlpc::print_message("plot_svg", error.what());
  return 1;
}
