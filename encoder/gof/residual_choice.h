// Residuals by rate and distortion: of the two next to what is wanted, the one that costs less.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>

#include "common/bitstream/residual_models.h"
#include "common/mesh/coded_mesh.h"
#include "common/skinned_gof/slice_models.h"
#include "encoder/gof/lagrangian.h"
#include "encoder/write/bit_cost.h"
#include "encoder/write/write_residual.h"

namespace rlpc {

// Where rates are not compared, residuals are rounded up from 1/2 and this part of a step.
inline constexpr double kDeadZone = 0.06;  // tuned (off: 0): of rounding

// To the next magnitude from 1 - round_up above the last; wanted is in steps.
inline std::int32_t rounded_residual(double wanted, double round_up) {
  constexpr double kMost = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const auto magnitude =
      static_cast<std::int32_t>(std::min(std::abs(wanted), kMost) + round_up);
  return wanted < 0.0 ? -magnitude : magnitude;
}

// wanted is in steps.
inline std::int32_t cheaper_residual(ResidualModels& models, std::uint32_t expected,
                                     double wanted) {
  constexpr double kMost = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const double steps = std::min(std::abs(wanted), kMost);
  auto magnitude = static_cast<std::int32_t>(steps);
  const double part = steps - magnitude;
  const auto bits = [&](std::int32_t of) {
    BitEstimate estimate;
    write_residual(estimate, models, expected, of);
    return estimate.bits();
  };
  if (part >= 0.5) {
    const double more_error = part * part - (1.0 - part) * (1.0 - part);
    if (kLambda * (bits(magnitude + 1) - bits(magnitude)) < more_error) ++magnitude;
  }
  return wanted < 0.0 ? -magnitude : magnitude;
}

// Residuals of the factors of vertices, as if there were one slice.
class VertexResidualChoice {
 public:
  VertexResidualChoice(const CodedMesh& mesh, std::size_t num_factors)
      : contexts_(mesh, num_factors), models_(std::make_unique<VertexModels>()) {}

  void start(std::uint32_t v) { contexts_.start(v); }
  // Of the next factor; wanted, in steps.
  std::int32_t next(double wanted) {
    ResidualModels& models = (*models_)[contexts_.activity()];
    const std::uint32_t expected = contexts_.expected();
    const std::int32_t residual = cheaper_residual(models, expected, wanted);
    BitCost cost;  // adapts the models
    write_residual(cost, models, expected, residual);
    contexts_.update(residual);
    return residual;
  }

 private:
  VertexContexts contexts_;
  std::unique_ptr<VertexModels> models_;
};

}  // namespace rlpc
