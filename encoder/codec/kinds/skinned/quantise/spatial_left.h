// What prediction along the mesh leaves of spatial factors, before these are coded.
#pragma once

#include <vector>

#include "common/codec/mesh/ordered_mesh.h"
#include "encoder/codec/math/principal_components.h"

namespace rlpc {

// What prediction leaves of the spatial factors near each of some vertices, mean square:
// [vertex of a sample][component].
std::vector<float> find_spatial_left(const OrderedMesh& mesh, const ComponentsByRow& pc);

}  // namespace rlpc
