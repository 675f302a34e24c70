#include "encoder/meshes/source_rig.h"

namespace rlpc {

SourceRig rig_of_vertices(const SourceRig& rig, const std::vector<std::uint32_t>& vertices) {
  SourceRig some{rig.bones, {}, {0}, {}};
  for (const std::uint32_t v : vertices) {
    const auto rest = rig.rest.begin() + 3 * static_cast<std::ptrdiff_t>(v);
    some.rest.insert(some.rest.end(), rest, rest + 3);
    for (std::size_t i = rig.first_influence[v]; i < rig.first_influence[v + 1]; ++i) {
      some.influences.push_back(rig.influences[i]);
    }
    some.first_influence.push_back(some.influences.size());
  }
  return some;
}

}  // namespace rlpc
