#include "conformance/studies/basis/basis_study.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "encoder/codec/math/principal_components.h"
#include "encoder/codec/math/small_system.h"

namespace rlpc {
namespace {

// Below this share of the energy, vectors are noise of the analysis.
constexpr double kMinEnergy = 1e-12;
// Halvings of the exponent of a scale: 2^-40 to 2^4, to within 2^-20.
constexpr int kHalvings = 26;

// Values of one axis.
std::size_t axis_length(const std::vector<double>& vector) {
  return std::max(vector.size() / 3, std::size_t{1});
}

// Returns the prediction from the values before `v`, of which there are enough.
double predicted(const BasisPredictor& predictor, const double* v) {
  double sum = predictor.offset;
  for (std::size_t k = 0; k < predictor.weights.size(); ++k) {
    sum += predictor.weights[k] * *(v - 1 - k);
  }
  return sum;
}

BasisPredictor fitted(std::span<const std::vector<double>> vectors, std::size_t order) {
  SmallSystem<kMaxPredicting + 1> system;
  for (const std::vector<double>& vector : vectors) {
    for (std::size_t j = 0; j < vector.size(); ++j) {
      if (j % axis_length(vector) < kMaxPredicting) continue;
      std::array<double, kMaxPredicting + 1> known{};  // the last one: the offset
      for (std::size_t k = 0; k < order; ++k) known[k] = vector[j - 1 - k];
      known[order] = 1.0;
      for (std::size_t a = 0; a <= order; ++a) {
        for (std::size_t b = 0; b <= order; ++b) system.a[a][b] += known[a] * known[b];
        system.b[a] += known[a] * vector[j];
      }
    }
  }
  const auto solution = solve_small(system, order + 1);
  const auto& x = solution.x;
  return {"LPC" + std::to_string(order),
          {x.begin(), x.begin() + static_cast<std::ptrdiff_t>(order)},
          x[order]};
}

double entropy_of(const std::map<std::int64_t, std::size_t>& counts, std::size_t total) {
  double bits = 0.0;
  for (const auto& [symbol, count] : counts) {
    const double share = static_cast<double>(count) / static_cast<double>(total);
    bits -= share * std::log2(share);
  }
  return bits;
}

}  // namespace

InputResult<TrajectoryBasis> analyse_trajectories(FrameSource& source,
                                                  std::size_t max_vectors) {
  TrajectoryBasis basis{source.num_vertices(), source.num_frames(), 0.0, {}, {}, {}};
  const std::size_t width = 3 * std::size_t{basis.num_frames};
  std::vector<double> rows(basis.num_vertices * width);
  std::vector<float> xyz(3 * std::size_t{basis.num_vertices});
  for (std::uint32_t f = 0; f < basis.num_frames; ++f) {
    if (auto error = source.read_frame(f, xyz)) return *error;
    for (std::size_t c = 0; c < 3; ++c) {
      double mean = 0.0;
      for (std::size_t v = 0; v < basis.num_vertices; ++v) mean += double{xyz[3 * v + c]};
      mean /= basis.num_vertices;
      for (std::size_t v = 0; v < basis.num_vertices; ++v) {
        rows[v * width + c * basis.num_frames + f] = double{xyz[3 * v + c]} - mean;
      }
    }
  }
  double total = 0.0;
  for (const double x : rows) total += x * x;
  const auto write = [&](std::size_t first, std::span<double> out) {
    std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(first * width), out.size(),
                out.begin());
  };
  ComponentsByRow found =
      components_by_row({basis.num_vertices, width, write}, max_vectors, kMinEnergy * total);
  const std::size_t count = found.temporal.size();
  basis.total_energy = total;
  basis.energy.assign(found.energy.begin(),
                      found.energy.begin() + static_cast<std::ptrdiff_t>(count));
  basis.vectors = std::move(found.temporal);
  basis.sums.assign(count, 0.0);
  for (std::size_t i = 0; i < found.spatial.size(); ++i) {
    basis.sums[i % count] += std::abs(double{found.spatial[i]});
  }
  return basis;
}

const char* name_of(StepRule rule) {
  constexpr std::array kNames{"uniform", "cobra", "eigenvalue"};
  return kNames[static_cast<std::size_t>(rule)];
}

std::vector<double> relative_steps(const TrajectoryBasis& basis, StepRule rule,
                                   std::size_t count) {
  std::vector<double> steps(count, 1.0);
  const std::vector<double>& by = rule == StepRule::kCobra ? basis.sums : basis.energy;
  for (std::size_t i = 0; i < count && rule != StepRule::kUniform; ++i) {
    steps[i] = by[0] / by[i];
  }
  return steps;
}

std::vector<BasisPredictor> basis_predictors(std::span<const std::vector<double>> vectors) {
  std::vector<BasisPredictor> list{{"direct", {}, 0.0}};
  for (std::size_t order = 1; order <= kMaxPredicting; ++order) {
    list.push_back(fitted(vectors, order));
  }
  list.push_back({"Cob1", {1.0}, 0.0});
  list.push_back({"Cob2", {2.0, -1.0}, 0.0});
  list.push_back({"Cob3", {3.0, -3.0, 1.0}, 0.0});
  list.push_back({"Cob4", {4.0, -6.0, 4.0, -1.0}, 0.0});
  return list;
}

double missed_squares(std::span<const std::vector<double>> vectors,
                      const BasisPredictor& predictor) {
  double sum = 0.0;
  for (const std::vector<double>& vector : vectors) {
    for (std::size_t j = 0; j < vector.size(); ++j) {
      if (j % axis_length(vector) < kMaxPredicting) continue;
      const double missed = vector[j] - predicted(predictor, &vector[j]);
      sum += missed * missed;
    }
  }
  return sum;
}

QuantisedBasis quantise(std::span<const std::vector<double>> vectors,
                        std::span<const double> steps, const BasisPredictor& predictor) {
  QuantisedBasis coded;
  std::map<std::int64_t, std::size_t> counts;
  std::size_t total = 0;
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    std::vector<double> decoded(vectors[i].size());
    double error = 0.0;
    for (std::size_t j = 0; j < decoded.size(); ++j) {
      const bool is_first = j % axis_length(decoded) < predictor.weights.size();
      const double start = is_first ? 0.0 : predicted(predictor, &decoded[j]);
      const std::int64_t q = std::llround((vectors[i][j] - start) / steps[i]);
      decoded[j] = start + static_cast<double>(q) * steps[i];
      error += (decoded[j] - vectors[i][j]) * (decoded[j] - vectors[i][j]);
      ++counts[q];
      ++total;
    }
    coded.error.push_back(error);
  }
  coded.entropy = entropy_of(counts, total);
  return coded;
}

// The coefficients of different vectors are uncorrelated, so that errors add up.
double kg_error(const TrajectoryBasis& basis, std::span<const double> errors) {
  double sum = 0.0;
  for (std::size_t i = 0; i < errors.size(); ++i) sum += basis.energy[i] * errors[i];
  return 100.0 * std::sqrt(sum / basis.total_energy);
}

std::vector<double> steps_for(const TrajectoryBasis& basis, std::span<const double> relative,
                              const BasisPredictor& predictor, double kg) {
  const auto vectors = std::span(basis.vectors).first(relative.size());
  const auto scaled = [&](double log2_scale) {
    std::vector<double> steps(relative.begin(), relative.end());
    for (double& step : steps) step *= std::exp2(log2_scale);
    return steps;
  };
  double low = -40.0;
  double high = 4.0;  // values are below 1: all become 0
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2.0;
    const bool fits = kg_error(basis, quantise(vectors, scaled(middle), predictor).error) <= kg;
    (fits ? low : high) = middle;
  }
  return scaled(low);
}

std::vector<double> tripled(const TrajectoryBasis& basis, std::span<const double> steps,
                            const BasisPredictor& predictor) {
  const auto vectors = std::span(basis.vectors).first(steps.size());
  const std::vector<double> errors = quantise(vectors, steps, predictor).error;
  std::vector<double> found;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    std::vector<double> changed = errors;
    const std::array coarse{3.0 * steps[i]};
    changed[i] = quantise(vectors.subspan(i, 1), coarse, predictor).error[0];
    found.push_back(kg_error(basis, changed));
  }
  return found;
}

}  // namespace rlpc
