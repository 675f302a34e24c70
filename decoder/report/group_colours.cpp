#include "decoder/report/group_colours.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <set>
#include <tuple>

namespace rlpc {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr int kHues = 12;
constexpr std::array<double, 3> kLightness{0.70, 0.84, 0.56};
// Smallest distance between neighbours, if possible.
constexpr double kDistinct = 0.11;
// Part of its lightness that a colour loses in the darkest shade.
constexpr double kDarkening = 0.24;

Colour colour_of(double lightness, double chroma, double degrees) {
  const double hue = degrees * kPi / 180;
  return {lightness, chroma * std::cos(hue), chroma * std::sin(hue)};
}

// Makes the palette. Successive colours have distant hues; it has all twelve hues in one
// lightness before the next.
std::vector<Colour> make_palette() {
  std::vector<Colour> palette;
  for (const double lightness : kLightness) {
    for (int i = 0; i < kHues; ++i) {
      palette.push_back(colour_of(lightness, 0.13, 25 + 360.0 / kHues * (i * 5 % kHues)));
    }
  }
  return palette;
}

// Returns the groups with which each group shares an edge.
std::vector<std::set<std::uint32_t>> neighbours_of_groups(
    std::uint32_t num_groups, std::span<const std::uint32_t> group_of_vertex,
    std::span<const Triangle> triangles) {
  std::vector<std::set<std::uint32_t>> neighbours(num_groups);
  for (const Triangle& t : triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = group_of_vertex[t[k]];
      const std::uint32_t b = group_of_vertex[t[(k + 1) % 3]];
      if (a == b) continue;
      neighbours[a].insert(b);
      neighbours[b].insert(a);
    }
  }
  return neighbours;
}

// Returns the level of a component from 0 to 1, linear in light.
int level_of(double linear) {
  const double v = std::clamp(linear, 0.0, 1.0);
  const double srgb = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
  return static_cast<int>(std::lround(255 * srgb));
}

}  // namespace

double colour_distance(const Colour& a, const Colour& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

std::vector<Colour> group_colours(std::uint32_t num_groups,
                                  std::span<const std::uint32_t> group_of_vertex,
                                  std::span<const Triangle> triangles) {
  const std::vector<Colour> palette = make_palette();
  const auto neighbours = neighbours_of_groups(num_groups, group_of_vertex, triangles);
  std::vector<std::size_t> uses(palette.size());
  std::vector<Colour> colours;
  for (std::uint32_t group = 0; group < num_groups; ++group) {
    // Prefers unused colours, then colours distinct from the neighbours, then least used ones.
    const auto cost = [&](std::size_t c) {
      const bool recurs = uses[c] > 0 && num_groups <= palette.size();
      double nearest = kDistinct;
      for (const std::uint32_t other : neighbours[group]) {
        if (other >= group) break;  // not yet coloured
        nearest = std::min(nearest, colour_distance(palette[c], colours[other]));
      }
      return std::tuple(recurs, -nearest, uses[c], c);
    };
    std::size_t best = 0;
    for (std::size_t c = 1; c < palette.size(); ++c) {
      if (cost(c) < cost(best)) best = c;
    }
    ++uses[best];
    colours.push_back(palette[best]);
  }
  return colours;
}

std::vector<Colour> ramp_colours(std::uint32_t num_groups) {
  std::vector<Colour> colours;
  for (std::uint32_t i = 0; i < num_groups; ++i) {
    const double share = num_groups > 1 ? static_cast<double>(i) / (num_groups - 1) : 1;
    colours.push_back(colour_of(0.42 + 0.48 * share, 0.15, 310 - 205 * share));
  }
  return colours;
}

std::string colour_text(const Colour& colour, double shade) {
  const double scale = 1 - kDarkening * (1 - shade);
  const double lightness = scale * colour[0];
  const double a = scale * colour[1];
  const double b = scale * colour[2];
  const double l = std::pow(lightness + 0.3963377774 * a + 0.2158037573 * b, 3);
  const double m = std::pow(lightness - 0.1055613458 * a - 0.0638541728 * b, 3);
  const double s = std::pow(lightness - 0.0894841775 * a - 1.2914855480 * b, 3);
  char text[8];
  std::snprintf(text, sizeof text, "#%02x%02x%02x",
                level_of(4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s),
                level_of(-1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s),
                level_of(-0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s));
  return text;
}

}  // namespace rlpc
