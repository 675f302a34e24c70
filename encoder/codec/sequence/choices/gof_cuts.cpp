#include "encoder/codec/sequence/choices/gof_cuts.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/spans/component_cost.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/spans/sample_size.h"

namespace rlpc {
namespace {

constexpr std::uint64_t kMaxSampleValues = std::uint64_t{1} << 21;  // fixed: memory
constexpr std::uint32_t kMinVertices = 8;                           // fixed: fewer say nothing
constexpr std::uint32_t kMaxCutFrames = kMaxSampleValues / 3 / kMinVertices;  // fixed: memory
// tuned (off: 1): GOFs of unequal length are used only if their expected cost is lower by this
// fraction. The estimate leaves out bones, which gain from long GOFs, so small differences mean
// nothing.
constexpr double kMinGain = 0.03;

// Estimates the cost of GOFs from a sample of the vertices.
class GofCosts {
 public:
  GofCosts(std::uint32_t num_vertices, std::uint32_t num_frames, double step)
      : num_vertices_(num_vertices), step_(step) {
    const auto max =
        static_cast<std::uint32_t>(kMaxSampleValues / (3 * std::uint64_t{num_frames}));
    const std::uint32_t count = std::min({num_vertices, kProbeVertices, max});
    for (std::uint32_t i = 0; i < count; ++i) {
      vertices_.push_back(static_cast<std::uint32_t>(std::uint64_t{i} * num_vertices / count));
    }
  }

  // Adds a frame; call it for all frames in order. Stores positions relative to the centre of
  // the sample.
  void add_frame(std::span<const float> xyz) {
    std::array<double, 3> centre{};
    for (const std::uint32_t v : vertices_) {
      for (std::size_t c = 0; c < 3; ++c) {
        centre[c] += xyz[3 * std::size_t{v} + c] / static_cast<double>(vertices_.size());
      }
    }
    for (const std::uint32_t v : vertices_) {
      for (std::size_t c = 0; c < 3; ++c) {
        sample_.push_back(static_cast<float>(xyz[3 * std::size_t{v} + c] - centre[c]));
      }
    }
  }

  // Returns the expected Lagrangian cost of a GOF, cached.
  double of(const FrameRange& span) {
    // tuned: Frames of a GOF in its sample. More barely change the estimate.
    constexpr std::uint32_t kFrames = 16;
    const auto [place, is_new] = known_.try_emplace({span.first, span.count}, 0.0);
    if (is_new) place->second = expected(span, kFrames);
    return place->second;
  }
  // Returns the same for equal GOFs of at most `longest` frames, from every eighth frame, so
  // that lengths can be compared.
  double equal_cost(std::uint32_t num_frames, std::uint32_t longest) const {
    constexpr std::uint32_t kEvery = 8;  // fixed: 16 of 128 frames, as above
    double sum = 0.0;
    for (const FrameRange& span : equal_gofs(num_frames, longest)) {
      sum += expected(span, (span.count + kEvery - 1) / kEvery);
    }
    return sum;
  }

 private:
  // Returns displacements of the vertices from their mean positions in a sample of frames. The
  // sample includes the first and the last frame, which reveal a slightly misplaced cut.
  TrajectoryMatrix displacements(const FrameRange& span, std::uint32_t max) const {
    const std::uint32_t count = std::min(span.count, max);
    TrajectoryMatrix matrix;
    matrix.num_values = vertices_.size();
    matrix.num_frames = 3 * std::size_t{count};
    matrix.a.resize(matrix.num_values * matrix.num_frames);
    for (std::uint32_t i = 0; i < count; ++i) {
      const auto frame = static_cast<std::size_t>(
          span.first + (count < 2 ? 0 : std::uint64_t{i} * (span.count - 1) / (count - 1)));
      const float* from = &sample_[frame * 3 * vertices_.size()];
      for (std::size_t v = 0; v < vertices_.size(); ++v) {
        for (std::size_t c = 0; c < 3; ++c) matrix.row(v)[c * count + i] = *from++;
      }
    }
    for (std::size_t v = 0; v < vertices_.size(); ++v) {
      for (std::size_t c = 0; c < 3; ++c) {
        double* row = matrix.row(v) + c * count;
        double mean = 0.0;
        for (std::uint32_t i = 0; i < count; ++i) mean += row[i] / count;
        for (std::uint32_t i = 0; i < count; ++i) row[i] -= mean;
      }
    }
    return matrix;
  }

  double expected(const FrameRange& span, std::uint32_t max) const {
    // tuned (off: 0): Bits of a rest position, which each GOF codes again: about five for each
    // coordinate. Without this cost, GOFs would be cut far too often.
    constexpr double kRestBits = 15.0;
    const TrajectoryMatrix matrix = displacements(span, max);
    const double vertices = num_vertices_;
    const double values = 3.0 * span.count;
    const double scale =
        vertices * values / static_cast<double>(matrix.num_values * matrix.num_frames);
    double cost = lambda(step_) * kRestBits * vertices;
    for (const double sampled : principal_components(matrix, 0, 0.0).energy) {
      const double energy = scale * sampled;
      cost += expected_component_cost(energy, vertices, values,
                                      kPredictionLeft * energy / vertices, step_);
    }
    return cost;
  }

  std::uint32_t num_vertices_;
  double step_;
  std::vector<std::uint32_t> vertices_;
  std::vector<float> sample_;  // [frame][vertex][3]
  std::map<std::pair<std::uint32_t, std::uint32_t>, double> known_;
};

double cost(GofCosts& costs, const std::vector<FrameRange>& spans) {
  double sum = 0.0;
  for (const FrameRange& span : spans) sum += costs.of(span);
  return sum;
}

// Returns the cheapest division into GOFs that all begin at multiples of `unit`, by dynamic
// programming.
std::vector<FrameRange> cheapest_of_units(GofCosts& costs, std::uint32_t num_frames,
                                          std::uint32_t longest, std::uint32_t unit) {
  struct Best {
    double cost = std::numeric_limits<double>::infinity();
    std::uint32_t before = 0;  // start of the last span, in units
  };
  const std::uint32_t num_units = (num_frames + unit - 1) / unit;
  std::vector<Best> best(num_units + 1);  // [end]: division of the frames before end * unit
  best[0].cost = 0.0;
  for (std::uint32_t end = 1; end <= num_units; ++end) {
    const std::uint32_t end_frame = std::min(end * unit, num_frames);
    for (std::uint32_t begin = end; begin-- > 0;) {
      const FrameRange span{begin * unit, end_frame - begin * unit};
      if (span.count > longest) break;
      const double sum = best[begin].cost + costs.of(span);
      if (sum < best[end].cost) best[end] = {sum, begin};
    }
  }
  std::vector<FrameRange> spans;
  for (std::uint32_t end = num_units; end > 0; end = best[end].before) {
    const std::uint32_t first = best[end].before * unit;
    spans.push_back({first, std::min(end * unit, num_frames) - first});
  }
  std::reverse(spans.begin(), spans.end());
  return spans;
}

// Moves the cut between two adjacent spans, by halving distances, where that lowers the cost.
void refine(GofCosts& costs, std::uint32_t longest, std::uint32_t unit, FrameRange& a,
            FrameRange& b) {
  for (std::uint32_t by = unit / 2; by > 0; by /= 2) {
    for (const bool later : {false, true}) {
      const FrameRange& from = later ? b : a;
      const FrameRange& to = later ? a : b;
      if (from.count <= by || to.count + by > longest) continue;
      const std::uint32_t count = later ? a.count + by : a.count - by;
      const FrameRange left{a.first, count};
      const FrameRange right{a.first + count, a.count + b.count - count};
      if (costs.of(left) + costs.of(right) >= costs.of(a) + costs.of(b)) continue;
      a = left;
      b = right;
      break;
    }
  }
}

std::optional<InputError> read_all(FrameSource& source, GofCosts& costs) {
  std::vector<float> xyz(std::size_t{source.num_vertices()} * 3);
  for (std::uint32_t f = 0; f < source.num_frames(); ++f) {
    if (auto error = source.read_frame(f, xyz)) return error;
    costs.add_frame(xyz);
  }
  return std::nullopt;
}

}  // namespace

InputResult<std::vector<FrameRange>> cheapest_gofs(FrameSource& source, std::uint32_t longest,
                                                   double step) {
  // tuned (off: 1): GOFs are first cut at multiples of the longest length divided by this
  // number; the cuts are then refined to single frames. Finer units cost time in proportion to
  // the square.
  constexpr std::uint32_t kUnitsOfLongest = 8;
  const std::uint32_t num_frames = source.num_frames();
  std::vector<FrameRange> equal = equal_gofs(num_frames, longest);
  const std::uint32_t unit = longest / kUnitsOfLongest;
  if (equal.size() < 2 || unit == 0 || num_frames > kMaxCutFrames) return equal;
  GofCosts costs(source.num_vertices(), num_frames, step);
  if (auto error = read_all(source, costs)) return *error;
  std::vector<FrameRange> spans = cheapest_of_units(costs, num_frames, longest, unit);
  for (std::size_t i = 1; i < spans.size(); ++i) {
    refine(costs, longest, unit, spans[i - 1], spans[i]);
  }
  const bool better = cost(costs, spans) < (1.0 - kMinGain) * cost(costs, equal);
  return better ? std::move(spans) : std::move(equal);
}

InputResult<std::uint32_t> choose_longest_gof(FrameSource& source, std::uint32_t shortest,
                                              std::uint32_t longest, double step) {
  // tuned (off: 0): A length is preferred to longer ones if its expected cost is higher by at
  // most this fraction.
  constexpr double kWorthLength = 0.05;
  const std::uint32_t num_frames = source.num_frames();
  if (num_frames <= shortest || longest <= shortest) return shortest;
  if (num_frames > kMaxCutFrames) return longest;
  GofCosts costs(source.num_vertices(), num_frames, step);
  if (auto error = read_all(source, costs)) return *error;
  std::vector<std::uint32_t> lengths{shortest};
  while (lengths.back() < std::min(longest, num_frames)) {
    lengths.push_back(std::min(2 * lengths.back(), longest));
  }
  std::vector<double> length_cost;
  length_cost.reserve(lengths.size());
  for (const std::uint32_t length : lengths) {
    length_cost.push_back(costs.equal_cost(num_frames, length));
  }
  const double min = *std::min_element(length_cost.begin(), length_cost.end());
  std::size_t i = 0;
  while (length_cost[i] > (1.0 + kWorthLength) * min) ++i;
  return lengths[i];
}

}  // namespace rlpc
