#include "encoder/codec/partition/lloyd.h"

#include <vector>

#include "encoder/codec/partition/k_means.h"

namespace rlpc {

Partition lloyd_partition(std::span<const Point3> points, std::uint32_t count) {
  std::vector<double> values;
  values.reserve(3 * points.size());
  for (const Point3& p : points) values.insert(values.end(), p.begin(), p.end());
  return k_means(values, 3, count);
}

}  // namespace rlpc
