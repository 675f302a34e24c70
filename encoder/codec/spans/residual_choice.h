// Rounds residuals to integers: to nearest, with a dead zone, or by rate and distortion.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/bits/residual_models.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/spans/lagrangian.h"
#include "encoder/codec/write/bit_cost.h"
#include "encoder/codec/write/write_residual.h"

namespace rlpc {

// Where rates are not compared, residuals are rounded up from 1/2 plus this part of a step:
// there, rounding up saves as much error as it costs if the next magnitude takes one bit more.
inline constexpr double kDeadZone = kLambda / 2.0;  // fixed: arithmetic

// Rounds the magnitude of `wanted` (in steps) up if its fraction is at least 1 - round_up.
inline std::int32_t rounded_residual(double wanted, double round_up) {
  constexpr double kMax = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const auto magnitude = static_cast<std::int32_t>(std::min(std::abs(wanted), kMax) + round_up);
  return wanted < 0.0 ? -magnitude : magnitude;
}

// Returns the one of the two integers next to `wanted` (in steps) with the lower Lagrangian
// cost under the models. The larger magnitude is considered only if it is nearer.
inline std::int32_t cheaper_residual(ResidualModels& models, std::uint32_t expected,
                                     double wanted) {
  constexpr double kMax = static_cast<double>(kMaxResidual) - 1.0;  // fixed: format
  const double steps = std::min(std::abs(wanted), kMax);
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
// Copies can continue with different vertices of a layer, as in VertexContexts.
class VertexResidualChoice {
 public:
  VertexResidualChoice(const OrderedMesh& mesh, std::size_t num_factors)
      : contexts_(mesh, num_factors), models_(1) {}

  // A residual, with the contexts that it was chosen in.
  struct Chosen {
    std::int32_t residual = 0;
    std::uint32_t expected = 0;
    std::uint32_t activity = 0;
  };

  void start(std::uint32_t v) { contexts_.start(v); }
  // Chooses the residual of the next factor and adapts to it. wanted: in steps.
  Chosen next(double wanted) {
    Chosen chosen{0, contexts_.expected(), static_cast<std::uint32_t>(contexts_.activity())};
    ResidualModels& models = models_.front()[chosen.activity];
    chosen.residual = cheaper_residual(models, chosen.expected, wanted);
    adapt(chosen);
    contexts_.update(chosen.residual);
    return chosen;
  }
  // Adapts to the residuals of all factors that a copy has chosen for a vertex.
  void follow(std::span<const Chosen> vertex) {
    for (std::size_t k = 0; k < vertex.size(); ++k) {
      adapt(vertex[k]);
      contexts_.follow(k, vertex[k].residual);
    }
  }

 private:
  void adapt(const Chosen& chosen) {
    BitCost unused;  // writing adapts the models
    write_residual(unused, models_.front()[chosen.activity], chosen.expected, chosen.residual);
  }

  VertexContexts contexts_;
  std::vector<VertexModels> models_;  // a single one, too large for the stack
};

}  // namespace rlpc
