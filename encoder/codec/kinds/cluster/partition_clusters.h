// Clusters that are the parts of a partition.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/mesh/mesh.h"
#include "encoder/codec/kinds/cluster/clustering.h"
#include "encoder/codec/kinds/cluster/seed_choice.h"
#include "encoder/codec/partition/partition.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/spans/span_frames.h"

namespace rlpc {

// Each part gets the best of the seed triangles near its centre, with vertices of the part if
// possible. Parts without such a triangle have no LCF.
class PartitionClusters : public ClusterMaker {
 public:
  // Keeps references to the frames and triangles. method: not kSeeds.
  PartitionClusters(PartitionMethod method, const SpanFrames& frames,
                    std::span<const Triangle> triangles, int position_bits);

  Clustering clusters(std::uint32_t count) override;
  Clustering spread_clusters(std::uint32_t count) override;

 private:
  Clustering make_clusters(std::uint32_t count) const;
  std::optional<Seed> seed_of(const std::vector<std::uint32_t>& vertices,
                              const Partition& partition) const;

  PartitionMethod method_;
  const SpanFrames& frames_;
  std::span<const Triangle> triangles_;
  SeedChoice choice_;
  std::map<std::uint32_t, Clustering> known_;  // [count]
};

}  // namespace rlpc
