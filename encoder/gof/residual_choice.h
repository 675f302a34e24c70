// Rounds residuals to integers: to nearest, with a dead zone, or by rate and distortion.
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

// Where rates are not compared, residuals are rounded up from 1/2 and this part of a step:
// there, rounding up saves as much error as it costs if the next magnitude takes one bit more.
inline constexpr double kDeadZone = kLambda / 2.0;  // fixed: arithmetic

// Rounds the magnitude of `wanted` (in steps) up if its fraction is at least 1 - round_up.
inline std::int32_t rounded_residual(double wanted, double round_up) {
  constexpr double kMost = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const auto magnitude =
      static_cast<std::int32_t>(std::min(std::abs(wanted), kMost) + round_up);
  return wanted < 0.0 ? -magnitude : magnitude;
}

// Of the two integers next to `wanted` (in steps), the one with the lower Lagrangian cost under
// the models. The larger magnitude is considered only if it is the nearer.
inline std::int32_t cheaper_residual(ResidualModels& models, std::uint32_t expected,
                                     double wanted) {
  constexpr double kMost = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const double steps = std::min(std::abs(wanted), kMost);
  auto magnitude = static_cast<std::int32_t>(steps);
  const double fraction = steps - magnitude;
  const auto bits = [&](std::int32_t residual) {
    BitEstimate estimate;
    write_residual(estimate, models, expected, residual);
    return estimate.bits();
  };
  if (fraction >= 0.5) {
    const double saved = fraction * fraction - (1.0 - fraction) * (1.0 - fraction);
    if (kLambda * (bits(magnitude + 1) - bits(magnitude)) < saved) ++magnitude;
  }
  return wanted < 0.0 ? -magnitude : magnitude;
}

// Chooses the residuals of vertex factors, with contexts as if the GOF were a single slice.
class VertexResidualChoice {
 public:
  VertexResidualChoice(const CodedMesh& mesh, std::size_t num_factors)
      : contexts_(mesh, num_factors), models_(std::make_unique<VertexModels>()) {}

  void start(std::uint32_t v) { contexts_.start(v); }
  // Chooses the residual of the next factor and adapts the models; wanted: in steps.
  std::int32_t next(double wanted) {
    ResidualModels& models = (*models_)[contexts_.activity()];
    const std::uint32_t expected = contexts_.expected();
    const std::int32_t residual = cheaper_residual(models, expected, wanted);
    BitCost cost;  // unused: writing adapts the models
    write_residual(cost, models, expected, residual);
    contexts_.update(residual);
    return residual;
  }

 private:
  VertexContexts contexts_;
  std::unique_ptr<VertexModels> models_;
};

}  // namespace rlpc
