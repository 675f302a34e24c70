// Axes and text, shared by plots and charts.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace rlpc {

// Maps values to pixels.
class Axis {
 public:
  // low < high; a logarithmic axis needs 0 < low.
  Axis(double low, double high, bool is_log, double first_pixel, double last_pixel);

  double at(double value) const;
  // Returns the ticks: 1, 2 and 5 of each decade of a logarithmic axis; otherwise about
  // num_ticks round numbers, at least min_step apart.
  std::vector<double> ticks(int num_ticks, double min_step = 0) const;

 private:
  double low_;
  double high_;
  bool is_log_;
  double first_pixel_;
  double last_pixel_;
};

std::string pixel_text(double value);  // in tenths
std::string tick_text(double value);

// Returns a text element; `attributes` follow those of its place.
std::string svg_text(double x, double y, std::string_view anchor, std::string_view words,
                     std::string_view attributes = "");

}  // namespace rlpc
