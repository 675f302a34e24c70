#include "conformance/fuzz/promise_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "conformance/rlpcval/validator.h"
#include "decoder/describe_error.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {
namespace {

PromiseResult wrong(const std::string& what) { return {Outcome::kWrong, what}; }

double largest_rounding(std::span<const double> exact, std::span<const float> xyz) {
  double largest = 0.0;
  for (std::size_t i = 0; i < xyz.size(); i += 3) {
    largest = std::max(largest, std::hypot(exact[i] - xyz[i], exact[i + 1] - xyz[i + 1],
                                           exact[i + 2] - xyz[i + 2]));
  }
  return largest;
}

InputResult<PromiseStream> encode_frame_by_frame(const PromiseCase& c, ExactFrames& source) {
  FrameFormat format;
  format.num_vertices = source.num_vertices();
  format.num_frames = c.open_ended ? 0 : source.num_frames();
  format.frame_rate = source.frame_rate();
  format.triangles = source.triangles();
  format.attributes = source.attributes();
  format.max_held_frames = c.max_held_frames;
  format.least_level = 4;
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  format.box_min.fill(kInfinity);
  format.box_max.fill(-kInfinity);
  std::vector<float> xyz(3 * std::size_t{source.num_vertices()});
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    source.read_frame(f, xyz);
    format.max_rounding = std::max(format.max_rounding, largest_rounding(c.frames[f], xyz));
    for (std::size_t i = 0; i < xyz.size(); ++i) {
      format.box_min[i % 3] = std::min(format.box_min[i % 3], xyz[i]);
      format.box_max[i % 3] = std::max(format.box_max[i % 3], xyz[i]);
    }
  }
  PromiseStream stream;
  auto encoder = FrameEncoder::create(format, c.settings, [&](auto more) {
    stream.bytes.insert(stream.bytes.end(), more.begin(), more.end());
    return true;
  });
  if (!encoder) return encoder.error();
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    source.read_frame(f, xyz);
    const auto exact = source.is_finer_than_floats() ? std::span<const double>(c.frames[f])
                                                     : std::span<const double>();
    if (auto error = encoder->add_frame(xyz, exact)) return *error;
  }
  auto report = encoder->finish();
  if (!report) return report.error();
  stream.report = std::move(*report);
  return stream;
}

InputResult<PromiseStream> encode_case(const PromiseCase& c) {
  ExactFrames source(c.shape, c.frames);
  if (c.way != PromiseCase::kWhole) return encode_frame_by_frame(c, source);
  PromiseStream stream;
  auto report = encode(source, c.settings, [&](std::span<const std::uint8_t> more) {
    stream.bytes.insert(stream.bytes.end(), more.begin(), more.end());
    return true;
  });
  if (!report) return report.error();
  stream.report = std::move(*report);
  return stream;
}

// Differences between the decoded frames and the input.
struct Measured {
  double largest_error = 0.0;
  long double squared_error = 0.0L;
  long double spread = 0.0L;
  long double squared_angles = 0.0L;  // of vertex normals: degrees squared, times area
  long double area = 0.0L;
  bool is_exact = true;    // equal as floats
  bool is_nearest = true;  // nearest on the grid

  double kg_error_percent() const {
    if (squared_error == 0.0L) return 0.0;
    if (spread == 0.0L) return std::numeric_limits<double>::infinity();
    return 100.0 * static_cast<double>(std::sqrt(squared_error / spread));
  }
};

using Vector3 = std::array<long double, 3>;

Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
long double length(const Vector3& a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

// Returns the sum of the normals of the triangles around each vertex; `area`: a third of their
// areas.
template <class T>
std::vector<Vector3> normals_of(std::span<const Triangle> triangles, const std::vector<T>& xyz,
                                std::vector<long double>& area) {
  std::vector<Vector3> normals(xyz.size() / 3);
  area.assign(normals.size(), 0.0L);
  for (const Triangle& t : triangles) {
    Vector3 side[2];
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        side[i][c] = static_cast<long double>(xyz[3 * std::size_t{t[i + 1]} + c]) -
                     xyz[3 * std::size_t{t[0]} + c];
      }
    }
    const Vector3 n = cross(side[0], side[1]);
    for (const std::uint32_t v : t) {
      for (std::size_t c = 0; c < 3; ++c) normals[v][c] += n[c];
      area[v] += length(n) / 6.0L;
    }
  }
  return normals;
}

void compare_normals(std::span<const Triangle> triangles, const std::vector<double>& frame,
                     const std::vector<float>& decoded, Measured& m) {
  std::vector<long double> unused;
  std::vector<long double> area;
  const std::vector<Vector3> b = normals_of(triangles, decoded, unused);
  const std::vector<Vector3> a = normals_of(triangles, frame, area);
  for (std::size_t v = 0; v < a.size(); ++v) {
    if (length(a[v]) == 0.0L) continue;
    const long double along = a[v][0] * b[v][0] + a[v][1] * b[v][1] + a[v][2] * b[v][2];
    const long double angle = length(b[v]) == 0.0L
                                  ? 90.0L
                                  : std::atan2(length(cross(a[v], b[v])), along) * 180.0L /
                                        std::numbers::pi_v<long double>;
    m.squared_angles += angle * angle * area[v];
    m.area += area[v];
  }
}

// Relative to the first vertex, so that it is 0 if all coincide.
void add_spread(const std::vector<double>& frame, Measured& m) {
  const std::size_t n = frame.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    long double mean = 0.0L;
    for (std::size_t v = 0; v < n; ++v) mean += frame[3 * v + c] - frame[c];
    mean /= static_cast<long double>(n);
    for (std::size_t v = 0; v < n; ++v) {
      const long double d = frame[3 * v + c] - frame[c] - mean;
      m.spread += d * d;
    }
  }
}

void compare_frame(const SequenceHeader& header, std::span<const Triangle> triangles,
                   const std::vector<double>& frame, const std::vector<std::int32_t>& positions,
                   const std::vector<std::uint32_t>& order, Measured& m) {
  const Grid& grid = header.grid;
  std::vector<float> output(frame.size());
  for (std::size_t v = 0; v < order.size(); ++v) {
    long double squared = 0.0L;
    for (std::size_t k = 0; k < 3; ++k) {
      const double original = frame[3 * std::size_t{order[v]} + k];
      const auto coded = static_cast<float>(original);
      // 7.3, in doubles: a sum of 28 bits times a power of two.
      const double on_grid = std::ldexp(
          static_cast<double>(positions[3 * v + k]) + grid.origin[k], grid.log2_step);
      const auto decoded = static_cast<float>(on_grid);
      output[3 * std::size_t{order[v]} + k] = decoded;
      m.is_exact = m.is_exact && decoded == coded;
      m.is_nearest =
          m.is_nearest && std::abs(on_grid - coded) <= std::ldexp(0.5, grid.log2_step);
      const long double d = static_cast<long double>(original) - decoded;
      squared += d * d;
    }
    m.squared_error += squared;
    m.largest_error = std::max(m.largest_error, static_cast<double>(std::sqrt(squared)));
  }
  add_spread(frame, m);
  compare_normals(triangles, frame, output, m);
}

std::optional<std::string> find_violation(const PromiseStream& stream) {
  const auto source =
      memory_source(Vector<std::uint8_t>(stream.bytes.begin(), stream.bytes.end()));
  const ValidationReport report = validate(*source);
  for (const Finding& f : report.findings) {
    if (f.severity == Severity::kWarning) continue;
    return "breaks " + std::string(f.id) + " (" + f.element + "): " + f.detail;
  }
  if (!report.complete || report.stopped) return "was not validated completely";
  return std::nullopt;
}

// Whether a value exceeds a bound by more than another order of sums explains.
bool exceeds(double value, double max) { return value > max * (1.0 + 1e-9); }

// Whether the RMS deviation of vertex normals is at most `max` degrees. Other sums may differ
// where triangles of a vertex cancel out.
bool keeps_normals(const Measured& m, double max) {
  constexpr double kOther = 1.0 + 1e-6;
  return m.squared_angles <= static_cast<long double>(max * kOther * max * kOther) * m.area;
}

std::optional<std::string> find_broken_promise(const PromiseCase& c,
                                               const PromiseStream& stream,
                                               const SequenceHeader& header,
                                               const Measured& m) {
  const Target& target = c.settings.target;
  const EncodeReport& r = stream.report;
  const double bits = 8.0 * static_cast<double>(stream.bytes.size());
  const double bpvf = bits / (1.0 * c.shape.num_vertices) / c.shape.num_frames;
  if (exceeds(m.largest_error, r.metrics.max_error)) {
    return "the largest error is " + std::to_string(m.largest_error) + ", reported as " +
           std::to_string(r.metrics.max_error);
  }
  if (!r.target_met) return std::nullopt;
  switch (target.kind) {
    case Target::kLossless:
      if (target.value == 0.0 && !m.is_exact) return "not lossless";
      if (!m.is_nearest) return "not the nearest on the grid";
      if (target.value > 0.0 && header.position_bits > target.value) return "too many bits";
      break;
    case Target::kMaxError:
      if (exceeds(m.largest_error, target.value)) {
        return "the largest error is " + std::to_string(m.largest_error) + ", not " +
               std::to_string(target.value);
      }
      break;
    case Target::kKg:
      if (exceeds(m.kg_error_percent(), target.value)) {
        return "the KG error is " + std::to_string(m.kg_error_percent());
      }
      if (target.max_normals > 0.0 && !keeps_normals(m, target.max_normals)) {
        return "vertex normals deviate more than they may";
      }
      break;
    case Target::kBpvf:
      if (exceeds(bpvf, target.value)) return "the rate is " + std::to_string(bpvf);
      break;
    case Target::kNone:
      break;
  }
  return std::nullopt;
}

// Whether an error is true: floats cannot keep the bound, or there is no grid.
bool is_explained(const PromiseCase& c, const std::string& message) {
  if (message.find("no common grid of 24 bits") != std::string::npos) {
    return c.settings.target.kind == Target::kLossless && c.settings.target.value == 0.0;
  }
  if (message.find("nearest 32-bit floats") == std::string::npos) return false;
  double farthest = 0.0;
  for (const auto& frame : c.frames) {
    for (std::size_t i = 0; i < frame.size(); i += 3) {
      double squared = 0.0;
      for (std::size_t k = i; k < i + 3; ++k) {
        const double d = frame[k] - static_cast<double>(static_cast<float>(frame[k]));
        squared += d * d;
      }
      farthest = std::max(farthest, std::sqrt(squared));
    }
  }
  return c.settings.target.kind == Target::kMaxError && farthest > c.settings.target.value;
}

}  // namespace

PromiseResult check_stream(const PromiseCase& c, const PromiseStream& stream) {
  auto decoder = Decoder::open(
      memory_source(Vector<std::uint8_t>(stream.bytes.begin(), stream.bytes.end())));
  if (!decoder) return wrong("does not open: " + describe_error(decoder.error()));
  if (decoder->num_vertices() != c.shape.num_vertices) return wrong("other vertices");
  if (const auto sets = decoder->attributes(); !sets) {
    return wrong("attributes: " + describe_error(sets.error()));
  } else if (sets->size() != c.shape.attributes.sets.size()) {
    return wrong("other attributes");
  }
  std::vector<std::uint32_t> order = stream.report.input_vertex;
  if (c.settings.keep_order) {
    for (std::uint32_t v = 0; v < order.size(); ++v) order[v] = v;
  }
  if (order.size() != c.shape.num_vertices) return wrong("no order of vertices");
  Measured measured;
  std::vector<std::int32_t> positions(3 * order.size());
  for (const auto& frame : c.frames) {
    const auto more = decoder->next_frame(positions);
    if (!more) return wrong("does not decode: " + describe_error(more.error()));
    if (!*more) return wrong("ends too early");
    compare_frame(decoder->header(), c.shape.triangles, frame, positions, order, measured);
  }
  const auto more = decoder->next_frame(positions);
  if (!more || *more) return wrong("does not end well");
  if (const auto broken = find_broken_promise(c, stream, decoder->header(), measured)) {
    return wrong(*broken);
  }
  if (const auto violation = find_violation(stream)) return wrong(*violation);
  return {stream.report.target_met ? Outcome::kKept : Outcome::kMissed, ""};
}

PromiseResult check_promises(const PromiseCase& c) {
  const auto stream = encode_case(c);
  if (stream) return check_stream(c, *stream);
  const std::string& message = stream.error().message;
  if (is_explained(c, message)) return {Outcome::kRefused, message};
  return wrong("refused: " + message);
}

}  // namespace rlpc
