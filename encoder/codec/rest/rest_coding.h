// Codes rest positions in an order of their own (8.18), with the weights, axes and counterparts
// that have the lowest Lagrangian cost.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/rest/rest_shape.h"

namespace rlpc {

struct RestEncoding {
  RestSettings settings;
  std::vector<std::int32_t> residual;     // [num_vertices][3]
  std::vector<std::int32_t> values;       // [num_vertices][3], as decoded
  std::vector<Counterpart> counterparts;  // [num_vertices], or empty
  double bits = 0.0;                      // bits of settings, residuals and counterparts
  double cost = 0.0;                      // D + lambda R, in squared steps of rest positions
};

struct RestChoices {
  bool few = false;  // only the usual settings
  bool counterparts = true;
  bool exact = false;  // values on the grid are coded without loss
};

// Codes rest positions. wanted: [num_vertices][3], 1/16 grid units, in the range of rest
// positions.
RestEncoding code_rest_in_order(const OrderedMesh& mesh, std::span<const std::int32_t> wanted,
                                std::uint32_t rest_step, int position_bits,
                                const RestChoices& choices);

// Returns the cost of rest positions coded in the order of the mesh (9.8.4). residual, values
// (as decoded): [num_vertices][3].
double rest_cost_in_layers(const OrderedMesh& mesh, std::span<const std::int32_t> wanted,
                           std::uint32_t rest_step, std::span<const std::int32_t> residual,
                           std::span<const std::int32_t> values);

}  // namespace rlpc
