// Estimates the residuals of predicting spatial factors along the mesh, before these are coded.
#pragma once

#include <vector>

#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/math/principal_components.h"

namespace rlpc {

// Returns the mean squared prediction residual of the spatial factors near each of some
// vertices, [vertex of a sample][component].
std::vector<float> find_spatial_left(const OrderedMesh& mesh, const ComponentsByRow& pc);

}  // namespace rlpc
