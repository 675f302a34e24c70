#include "encoder/codec/attributes/quantise_attribute.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>
#include <utility>

#include "common/codec/attributes/attribute_names.h"
#include "common/codec/attributes/recon/attribute_prediction.h"
#include "encoder/codec/math/det_math.h"

namespace rlpc {
namespace {

constexpr int kMaxBits = 16;

struct ValueRange {
  double low = 0.0;
  double high = 0.0;
};

ValueRange range_of(const SourceAttribute& source, std::uint32_t component) {
  ValueRange range{source.values[component], source.values[component]};
  for (std::size_t i = component; i < source.values.size(); i += source.num_components) {
    range.low = std::min<double>(range.low, source.values[i]);
    range.high = std::max<double>(range.high, source.values[i]);
  }
  return range;
}

std::uint32_t bits_for(std::int64_t max) {
  return std::max(1U,
                  static_cast<std::uint32_t>(std::bit_width(static_cast<std::uint64_t>(max))));
}

void quantise_floats(const SourceAttribute& source, QuantisedAttribute& out) {
  out.header.kind = ValueKind::kFloats;
  out.header.value_bits = 32;
  for (const float value : source.values) {
    out.values.push_back(ordered_bits(std::bit_cast<std::uint32_t>(value)));
  }
}

void quantise_integers(const SourceAttribute& source, QuantisedAttribute& out) {
  out.header.kind = ValueKind::kIntegers;
  std::uint32_t max = source.max_value;
  for (const float value : source.values) {
    out.values.push_back(static_cast<std::uint32_t>(value));
    if (source.max_value == 0) max = std::max(max, out.values.back());
  }
  out.header.value_bits = bits_for(max);
  if (source.max_value != 0) out.header.scale = ValueScale::kNormalised;
}

// Quantises on a grid with a step of a power of two: the finest of at most 16 bits, but not
// finer than log2_step.
void quantise_numbers(const SourceAttribute& source, int log2_step, QuantisedAttribute& out) {
  out.header.kind = ValueKind::kIntegers;
  out.header.scale = ValueScale::kGrid;
  const std::uint32_t n = source.num_components;
  for (bool fits = false; !fits; ++log2_step) {
    fits = true;
    out.header.log2_step = log2_step;
    const double steps = exact_exp2(-log2_step);
    std::int64_t max = 0;
    for (std::uint32_t c = 0; c < n; ++c) {
      const ValueRange range = range_of(source, c);
      const double low = range.low * steps;
      const double high = range.high * steps;
      constexpr double kMaxOrigin = 1 << 24;
      if (!(std::abs(low) < kMaxOrigin && std::abs(high) < kMaxOrigin)) {
        fits = false;
        break;
      }
      out.header.origin[c] = static_cast<std::int32_t>(round_to_int(low));
      max = std::max<std::int64_t>(max, round_to_int(high) - out.header.origin[c]);
    }
    fits = fits && max < (std::int64_t{1} << kMaxBits);
    out.header.value_bits = bits_for(max);
  }
  const double steps = exact_exp2(-out.header.log2_step);
  for (std::size_t i = 0; i < source.values.size(); ++i) {
    const std::int64_t value = round_to_int(double{source.values[i]} * steps);
    out.values.push_back(static_cast<std::uint32_t>(value - out.header.origin[i % n]));
  }
}

double widest_range(const SourceAttribute& source) {
  double widest = 0.0;
  for (std::uint32_t c = 0; c < source.num_components; ++c) {
    const ValueRange range = range_of(source, c);
    widest = std::max(widest, range.high - range.low);
  }
  return widest;
}

// Returns the step that gives the widest component so many bits.
int log2_step_of_range(const SourceAttribute& source, int bits) {
  const double widest = widest_range(source);
  int log2_step = -126;
  while (widest > exact_exp2(log2_step) * (exact_exp2(bits) - 1.0)) ++log2_step;
  return log2_step;
}

// Returns the step for the bits of an image, also if a transform repeats it along the unit of
// the coordinates. Coordinates that repeat an image n times show it at about 1/n of its size:
// as many bits over their range serve as well as over an image that appears once, as long as
// its edges move by at most an eighth of a texel within the image. morph-stress, which repeats
// an image of 64 texels 10 times, takes 1.1 kB less of its 3.9 kB of attributes; half or double
// that part of a texel changes nothing there, nor in the other models, which repeat no image.
int log2_step_of_uv(const SourceAttribute& source, const AttributeSettings& settings) {
  constexpr double kStep = 0.25;         // fixed: part of a texel; 12 bits for images of 1024
  constexpr double kMaxScale = 1 << 10;  // fixed: beyond, textures are noise
  UvUse use;
  for (std::size_t set = 0; set < settings.uv_uses.size(); ++set) {
    if (source.name == uv_name(static_cast<std::uint32_t>(set))) use = settings.uv_uses[set];
  }
  const double scale = std::min(use.scale, kMaxScale);
  int log2_step = -settings.uv_bits;
  while (exact_exp2(log2_step) * scale > exact_exp2(-settings.uv_bits)) --log2_step;
  if (!(use.texels > 0.0)) return log2_step;
  const double coarsest =
      std::min(kStep / use.texels, exact_exp2(log2_step) * scale * widest_range(source));
  while (exact_exp2(log2_step + 1) <= coarsest) ++log2_step;
  return log2_step;
}

// Quantises texture coordinates on a grid; as floats if a few that lie far from all others
// would make its step so much coarser than requested that the others lost their place in the
// image.
void quantise_uv(const SourceAttribute& source, const AttributeSettings& settings,
                 QuantisedAttribute& out) {
  // fixed: the step of 12 bits is then 2 texels of an image of 1024, and the largest error 1.
  // Ranges of up to 128 images still have a grid, which takes about half the bits of floats.
  constexpr int kMaxDoublings = 3;
  const int log2_step = log2_step_of_uv(source, settings);
  QuantisedAttribute on_grid = out;
  quantise_numbers(source, log2_step, on_grid);
  if (on_grid.header.log2_step > log2_step + kMaxDoublings) {
    quantise_floats(source, out);
  } else {
    out = std::move(on_grid);
  }
}

void quantise_normals(const SourceAttribute& source, int bits, QuantisedAttribute& out) {
  out.header.kind = ValueKind::kUnitVectors;
  out.header.num_components = 2;
  out.header.value_bits = static_cast<std::uint32_t>(bits);
  for (std::size_t i = 0; i < source.values.size(); i += 3) {
    const auto point = octahedron_point(
        {source.values[i], source.values[i + 1], source.values[i + 2]}, out.header.value_bits);
    out.values.insert(out.values.end(), point.begin(), point.end());
  }
}

}  // namespace

std::array<double, 3> octahedron_vector(const std::array<std::uint32_t, 2>& point,
                                        std::uint32_t value_bits) {
  const double h = exact_exp2(static_cast<int>(value_bits) - 1) - 1.0;
  std::array<double, 3> v{point[0] - h, point[1] - h, 0.0};
  v[2] = h - std::abs(v[0]) - std::abs(v[1]);
  if (v[2] < 0.0) {
    const double fold = v[2];
    for (std::size_t c = 0; c < 2; ++c) v[c] += v[c] < 0.0 ? -fold : fold;
  }
  const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (double& x : v) x /= length;
  return v;
}

std::array<std::uint32_t, 2> octahedron_point(const std::array<double, 3>& normal,
                                              std::uint32_t value_bits) {
  const std::array<double, 3>& n = normal;
  const double length = std::abs(n[0]) + std::abs(n[1]) + std::abs(n[2]);
  const double h = exact_exp2(static_cast<int>(value_bits) - 1) - 1.0;
  if (!(length > 0.0)) {
    const auto middle = static_cast<std::uint32_t>(h);
    return {middle, middle};
  }
  double u = n[0] / length;
  double v = n[1] / length;
  if (n[2] < 0.0) {
    const double x = 1.0 - std::abs(v);
    const double y = 1.0 - std::abs(u);
    u = u < 0.0 ? -x : x;
    v = v < 0.0 ? -y : y;
  }
  // Takes the nearest in angle of the points around it.
  const auto first = [&](double x) {
    return static_cast<std::int64_t>(std::floor((x + 1.0) * h));
  };
  std::array<std::uint32_t, 2> best{};
  double best_cosine = -2.0 * length;
  for (std::int64_t a = first(u); a <= first(u) + 1; ++a) {
    for (std::int64_t b = first(v); b <= first(v) + 1; ++b) {
      if (a < 0 || b < 0 || a > 2 * static_cast<std::int64_t>(h) ||
          b > 2 * static_cast<std::int64_t>(h)) {
        continue;
      }
      const std::array<std::uint32_t, 2> point{static_cast<std::uint32_t>(a),
                                               static_cast<std::uint32_t>(b)};
      const auto w = octahedron_vector(point, value_bits);
      const double cosine = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
      if (cosine > best_cosine) {
        best_cosine = cosine;
        best = point;
      }
    }
  }
  return best;
}

QuantisedAttribute quantise_attribute(const SourceAttribute& source,
                                      const AttributeSettings& settings) {
  QuantisedAttribute out;
  out.header.name = source.name;
  out.header.domain = source.domain;
  out.header.num_components = source.num_components;
  if (source.kind == SourceAttribute::Kind::kNormals) {
    quantise_normals(source, settings.exact ? kMaxBits : settings.normal_bits, out);
  } else if (source.kind == SourceAttribute::Kind::kIntegers) {
    quantise_integers(source, out);
  } else if (settings.exact) {
    quantise_floats(source, out);
  } else if (source.name.starts_with(kUvPrefix)) {
    quantise_uv(source, settings, out);
  } else {
    quantise_numbers(source, log2_step_of_range(source, settings.number_bits), out);
  }
  return out;
}

}  // namespace rlpc
