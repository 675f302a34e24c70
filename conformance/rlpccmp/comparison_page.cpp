#include "conformance/rlpccmp/comparison_page.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <utility>
#include <vector>

#include "decoder/describe_error.h"
#include "decoder/report/html_page.h"
#include "decoder/report/rate_report.h"
#include "decoder/report/svg_chart.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

constexpr const char* kBlue = "var(--blue)";
constexpr const char* kRed = "var(--red)";
constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();

template <class Frame, class Value>
ChartSeries over_frames(const std::string& name, const char* colour,
                        const std::vector<Frame>& frames, const Value& value) {
  ChartSeries series{name, colour, {}};
  for (const Frame& frame : frames) series.values.push_back(value(frame));
  return series;
}

std::string distortion_charts(const Distortion& d) {
  const auto& frames = d.metrics.frames;
  const auto& surface = d.surface.frames;
  const auto line = [](const char* name, const char* colour, const auto& of,
                       const auto& value) { return over_frames(name, colour, of, value); };
  ChartSeries temporal =
      line("temporal part", kRed, surface, [](const auto& f) { return f.ring_temporal; });
  temporal.values.front() = temporal.values.back() = kNothing;
  std::string html = "<div class=\"charts\">\n";
  html +=
      line_chart("Distance of vertices", "units of A",
                 {line("RMS", kBlue, frames, [](const auto& f) { return f.rms_error; }),
                  line("largest", kRed, frames, [](const auto& f) { return f.max_error; })});
  html += line_chart(
      "KG error", "per cent",
      {line("KG error", kBlue, frames, [](const auto& f) { return kg_error_percent(f); })});
  html += line_chart(
      "STED, spatial part", "of edges in each frame",
      {line("spatial part", kBlue, surface, [](const auto& f) { return f.sted_spatial; })});
  html += line_chart(
      "Edge difference in one ring", "of edges in each frame, and over time",
      {line("spatial part", kBlue, surface, [](const auto& f) { return f.ring_spatial; }),
       temporal});
  ChartSeries psnr =
      line("PSNR", kBlue, frames, [](const auto& f) { return f.diagonal_psnr_db; });
  psnr.worst_is_smallest = true;
  html += line_chart("PSNR, peak: the diagonal", "dB", {psnr});
  html += line_chart(
      "Deviation of vertex normals, RMS", "degrees",
      {line("deviation", kBlue, surface, [](const auto& f) { return f.vertex_normals; }),
       line("flicker", kRed, surface, [](const auto& f) { return f.normal_flicker; })});
  html += line_chart("Normal deviation, mean", "degrees",
                     {line("mean by area", kBlue, surface,
                           [](const auto& f) { return f.mean_normal_angle; })});
  html += line_chart(
      "Normal deviation, largest", "degrees",
      {line("largest", kRed, surface, [](const auto& f) { return f.max_normal_angle; })});
  return html + "</div>\n";
}

std::vector<KeyFigure> key_figures(const Distortion& d) {
  const Metrics& m = d.metrics;
  const SurfaceMetrics& s = d.surface;
  return {{number_text(m.kg_error_percent, 3) + " %", "KG error, mean of each frame"},
          {number_text(m.kg_sequence_error_percent, 3) + " %", "KG error, one mean"},
          {number_text(m.rms_error_percent, 3) + " %", "of the diagonal, RMS distance"},
          {number_text(m.max_error_percent, 3) + " %", "of the diagonal, largest"},
          {number_text(m.diagonal_psnr_db, 3) + " dB", "PSNR, peak: the diagonal"},
          {s.has_sted ? number_text(s.sted, 3) : "none", "STED"},
          {number_text(s.vertex_normals, 3) + "°", "vertex normals, RMS"},
          {number_text(s.normal_flicker, 3) + "°", "their flicker, RMS"},
          {number_text(s.mean_normal_angle, 3) + "°", "normal deviation, mean"},
          {number_text(s.max_normal_angle, 3) + "°", "normal deviation, largest"}};
}

struct Parsed {
  BitCounter counter;
  StreamSummary summary;
  StreamRates rates;
};

// Reads all of the stream, for its bits.
std::optional<InputError> parse(const std::string& path, Parsed& parsed) {
  const auto complain = [&](const Error& error) {
    return InputError{path + ": " + describe_error(error)};
  };
  auto source = file_source(path);
  if (!source) return complain(source.error());
  const std::uint64_t bytes = (*source)->size();
  DecoderOptions options;
  options.trace = &parsed.counter;
  StreamReader stream(std::move(*source), options);
  if (const auto opened = stream.open(); !opened) return complain(opened.error());
  auto summary = summarise_all(stream);
  if (!summary) return complain(summary.error());
  parsed.summary = std::move(*summary);
  parsed.counter.finish(8 * bytes);
  parsed.rates = {stream.header().num_vertices, stream.header().num_frames, bytes,
                  &parsed.counter, &parsed.summary};
  return std::nullopt;
}

std::string file_name(const std::string& name) {
  return std::filesystem::path(name).filename().string();
}

}  // namespace

double kg_error_percent(const FrameMetrics& frame) {
  if (frame.spread > 0) return 100 * std::sqrt(frame.squared_error) / std::sqrt(frame.spread);
  return frame.squared_error > 0 ? std::numeric_limits<double>::infinity() : 0;
}

InputResult<std::string> comparison_page_text(const ComparisonPage& comparison) {
  const ComparisonPair& pair = comparison.pair;
  const FrameSource& a = *pair.a.frames;
  Parsed parsed;
  if (!comparison.stream.empty()) {
    if (auto error = parse(comparison.stream, parsed)) return *error;
  }
  HtmlPage page(file_name(pair.b.name) + " against its original");
  page.add_fact("A, original", pair.a.name);
  page.add_fact("B, decoded", pair.b.name);
  page.add_fact("mesh", grouped_text(a.num_vertices()) + " vertices, " +
                            grouped_text(a.triangles().size()) + " triangles, " +
                            grouped_text(a.num_frames()) + " frames");
  std::vector<KeyFigure> figures = key_figures(comparison.distortion);
  const StreamRates& rates = parsed.rates;
  if (rates.bytes > 0) {
    figures.insert(figures.begin(),
                   {number_text(rates.bpvf(8.0 * static_cast<double>(rates.bytes))),
                    "bits per vertex and frame"});
  }
  page.add_key_figures(figures);
  page.add_section("Where the error is", comparison.view.note(),
                   comparison.view.html(comparison.distortion.metrics.diagonal));
  if (comparison.view.stride() > 0) page.use_viewer();
  page.add_section("Error along the frames",
                   "Point at a chart for its values; click to see the frame above.",
                   distortion_charts(comparison.distortion));
  if (rates.bytes > 0) add_rate_section(page, rates);
  return page.text();
}

}  // namespace rlpc
