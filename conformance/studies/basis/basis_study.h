// The experiments of Vasa and Skala 2009 (COBRA) with the basis of a principal component
// analysis of trajectories: how coarsely it can be quantised, and how well it can be predicted.
// In doubles; coefficients are exact, and nothing is coded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

// The basis of the trajectories minus their mean, (1) to (3).
struct TrajectoryBasis {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_frames = 0;
  double total_energy = 0.0;                 // the squared denominator of the KG error
  std::vector<double> energy;                // [vector]: its eigenvalue, descending
  std::vector<double> sums;                  // [vector]: of absolute coefficients, (17)
  std::vector<std::vector<double>> vectors;  // [vector][3 num_frames], x of all frames first
};

InputResult<TrajectoryBasis> analyse_trajectories(FrameSource& source, std::size_t max_vectors);

// Steps of the vectors: all the same; inverse to `sums`, (19); or inverse to the eigenvalues
// (Heu et al. 2006).
enum class StepRule : std::uint8_t { kUniform, kCobra, kEigenvalue };
inline constexpr std::array kStepRules{StepRule::kUniform, StepRule::kCobra,
                                       StepRule::kEigenvalue};
const char* name_of(StepRule rule);

// The steps of the first `count` vectors, up to a factor.
std::vector<double> relative_steps(const TrajectoryBasis& basis, StepRule rule,
                                   std::size_t count);

// Predicts a value from those before it on its axis.
struct BasisPredictor {
  std::string name;
  std::vector<double> weights;  // for the last value, the one before, ...
  double offset = 0.0;
};

inline constexpr std::size_t kMaxPredicting = 4;  // number of values

// No prediction; LPC1 to LPC4, fitted by least squares; Cob1 to Cob4, (11), (12), (14), (15).
std::vector<BasisPredictor> basis_predictors(std::span<const std::vector<double>> vectors);

// Returns the sum of squared prediction errors of values with kMaxPredicting values before
// them.
double missed_squares(std::span<const std::vector<double>> vectors,
                      const BasisPredictor& predictor);

// Result of Algorithm 1 for vectors.
struct QuantisedBasis {
  double entropy = 0.0;       // bits per value, first values included
  std::vector<double> error;  // [vector]: squared
};
QuantisedBasis quantise(std::span<const std::vector<double>> vectors,
                        std::span<const double> steps, const BasisPredictor& predictor);

// Returns the KG error in per cent if only the basis has errors.
double kg_error(const TrajectoryBasis& basis, std::span<const double> errors);

// Returns steps in the proportions of `relative` that lead to a KG error of `kg`.
std::vector<double> steps_for(const TrajectoryBasis& basis, std::span<const double> relative,
                              const BasisPredictor& predictor, double kg);

// [vector]: the KG error if its step is three times as large.
std::vector<double> tripled(const TrajectoryBasis& basis, std::span<const double> steps,
                            const BasisPredictor& predictor);

}  // namespace rlpc
