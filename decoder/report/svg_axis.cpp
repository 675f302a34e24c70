#include "decoder/report/svg_axis.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>

#include "decoder/report/html_page.h"

namespace rlpc {
namespace {

// Returns whether a tick is within the axis, with a tolerance for rounding.
bool is_within(double value, double low, double high) {
  const double slack = 1e-9 * (high - low);
  return low - slack <= value && value <= high + slack;
}

}  // namespace

Axis::Axis(double low, double high, bool is_log, double first_pixel, double last_pixel)
    : low_(low),
      high_(high),
      is_log_(is_log),
      first_pixel_(first_pixel),
      last_pixel_(last_pixel) {
  assert(low < high && (low > 0 || !is_log));
}

double Axis::at(double value) const {
  const double share = is_log_ ? std::log(value / low_) / std::log(high_ / low_)
                               : (value - low_) / (high_ - low_);
  return first_pixel_ + share * (last_pixel_ - first_pixel_);
}

std::vector<double> Axis::ticks(int num_ticks, double min_step) const {
  std::vector<double> values;
  const auto add = [&](double value) {
    if (is_within(value, low_, high_)) values.push_back(value);
  };
  if (is_log_) {
    const int last = static_cast<int>(std::floor(std::log10(high_)));
    for (int e = static_cast<int>(std::floor(std::log10(low_))); e <= last; ++e) {
      for (const double m : {1.0, 2.0, 5.0}) add(m * std::pow(10.0, e));
    }
    return values;
  }
  const double rough = std::max((high_ - low_) / num_ticks, min_step);
  const double unit = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10 * unit;
  for (const double m : {5.0, 2.0, 1.0}) {
    if (m * unit >= rough * (1 - 1e-9)) step = m * unit;
  }
  const double first = std::ceil(low_ / step * (1 - 1e-9));
  const double last = std::floor(high_ / step * (1 + 1e-9));
  const auto count = static_cast<int>(last - first) + 1;
  for (int i = 0; i < count; ++i) add((first + i) * step);
  return values;
}

std::string pixel_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", value);
  return text;
}

std::string tick_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string svg_text(double x, double y, std::string_view anchor, std::string_view words,
                     std::string_view attributes) {
  std::string svg = "<text x=\"" + pixel_text(x) + "\" y=\"" + pixel_text(y) +
                    "\" text-anchor=\"" + std::string(anchor) + "\"";
  svg += attributes;
  return svg + ">" + escape_html(words) + "</text>\n";
}

}  // namespace rlpc
