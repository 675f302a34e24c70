#include "encoder/codec/kinds/cluster/local_motion.h"

#include <cmath>

#include "encoder/codec/math/widest.h"

namespace rlpc {

LocalFrame::LocalFrame(const Lcf& lcf) {
  for (std::size_t c = 0; c < 3; ++c) {
    origin[c] = 0.5 * static_cast<double>(lcf.doubled_origin[c]);
    for (std::size_t k = 0; k < 3; ++k) axis[k][c] = static_cast<double>(lcf.axis[k][c]);
  }
}

namespace {

template <DistanceSum kSum>
[[gnu::always_inline]] inline void add(const LocalFrame& frame, std::size_t num_vertices,
                                       const double* xyz, double* before,
                                       double* motion) noexcept {
  const LocalFrame f = frame;  // a copy that the writes below cannot alias
  for (std::size_t v = 0; v < num_vertices; ++v) {
    const std::array<double, 3> q = f.to_local(xyz + 3 * v);
    const double dx = q[0] - before[3 * v];
    const double dy = q[1] - before[3 * v + 1];
    const double dz = q[2] - before[3 * v + 2];
    const double squared = dx * dx + dy * dy + dz * dz;
    motion[v] += kSum == DistanceSum::kPlain ? std::sqrt(squared) : squared;
    before[3 * v] = q[0];
    before[3 * v + 1] = q[1];
    before[3 * v + 2] = q[2];
  }
}

RLPC_WIDEST void add_squared(const LocalFrame& frame, std::size_t num_vertices,
                             const double* xyz, double* before, double* motion) noexcept {
  add<DistanceSum::kSquared>(frame, num_vertices, xyz, before, motion);
}

RLPC_WIDEST void add_plain(const LocalFrame& frame, std::size_t num_vertices, const double* xyz,
                           double* before, double* motion) noexcept {
  add<DistanceSum::kPlain>(frame, num_vertices, xyz, before, motion);
}

}  // namespace

void add_local_motion(DistanceSum sum, const LocalFrame& frame, std::size_t num_vertices,
                      const double* xyz, double* before, double* motion) noexcept {
  (sum == DistanceSum::kPlain ? add_plain : add_squared)(frame, num_vertices, xyz, before,
                                                         motion);
}

}  // namespace rlpc
