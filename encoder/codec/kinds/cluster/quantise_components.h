// Quantises principal components to the integers of a stream (inverse of clause 8.5).
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/kernels/component_sum.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/cluster/recon/cluster_recon.h"

namespace rlpc {

// Quantiser steps of the spatial and the temporal values of one component. Only their product
// is coded: in units of local coordinates (1/16 grid step) it is 2^(product_eighths / 8),
// rounded as in Table 8-1.
struct StepPair {
  double spatial = 1.0;
  double temporal = 1.0;
  int product_eighths = 0;
};

// Returns the nearest legal pair: keeps the temporal step, scales the spatial one by at most
// 2^(1/16).
StepPair make_steps(double spatial_step, double temporal_step);

// Quantised values of one component, with the best predictors.
struct QuantisedComponent {
  StepPair steps;
  std::vector<std::int32_t> temporal;  // [num_frames]
  std::vector<std::int32_t> spatial;   // [3][n]
  int temporal_predictor = 0;
  SpatialPredictor spatial_predictor = SpatialPredictor::kNone;
  double bits = 0.0;  // estimate
};

// dead_zone 0 rounds to nearest; 0.5 truncates.
std::vector<std::int32_t> quantise(const std::vector<double>& values, double step,
                                   double dead_zone);

// Chooses the predictors of quantised values and estimates their bits.
void choose_predictors(QuantisedComponent& component, const SpatialPrediction& prediction);

// Returns the number of fraction bits at which all temporal factors are precise enough.
int choose_fraction_bits(const std::vector<std::vector<QuantisedComponent>>& clusters);

// Returns the component as it is written. fraction_bits: from choose_fraction_bits().
Component make_component(const QuantisedComponent& component,
                         const SpatialPrediction& prediction, int fraction_bits);

// Estimates the bits of residuals coded with adaptive models: the entropy of the two-sided
// geometric distribution with the same mean magnitude.
double estimate_bits(const std::vector<std::int32_t>& residuals);

}  // namespace rlpc
