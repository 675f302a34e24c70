// 8.1 Decoding a GOF: reconstructs integer positions from residuals, frame by frame. Used by
// the decoder, and by the encoder for closed-loop coding.
#pragma once

#include <cstdint>
#include <span>

#include "common/codec/kernels/component_sum.h"
#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/cluster/recon/lcf.h"
#include "common/codec/kinds/cluster/recon/seed_tracks.h"
#include "common/codec/mesh/skeleton.h"
#include "common/codec/mesh/topology.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.3 Spatial prediction process: undoes it in place. planes: x, y and z values [3][n] of the
// coded vertices of one cluster; on return, values clipped to spatial_bits.
class SpatialPrediction {
 public:
  // vertices: coded vertices of the cluster, ascending. local_index [num_vertices]: place of a
  // vertex in the list of its cluster.
  SpatialPrediction(const Topology& topology, std::span<const std::uint32_t> vertices,
                    std::span<const std::uint16_t> cluster_of_vertex,
                    std::span<const std::uint32_t> local_index);

  // 8.3.3 Prediction of a spatial value: predicts value i from the values before it.
  std::int64_t predict(SpatialPredictor predictor, std::span<const std::int32_t> plane,
                       std::size_t i) const;

 private:
  ListOfLists<std::uint32_t> neighbours_;
  ListOfLists<Parallelogram> parallelograms_;
};

// Coded vertices of each cluster, ascending, and the place of each vertex in its list.
struct ClusterMembers {
  Vector<Vector<std::uint32_t>> vertices;
  Vector<std::uint32_t> local_index;  // [num_vertices]; unspecified for seeds
};
ClusterMembers cluster_members(const ClusterGof& gof);

// 8.5.1 Temporal values of a component, predictions undone; [num_gof_frames], 24 bits.
Vector<std::int32_t> recon_temporal(const Component& component);
// 8.3: spatial values of a component, predictions undone; [3][n], within spatial_bits.
Vector<std::int32_t> recon_spatial(const Component& component,
                                   const SpatialPrediction& prediction);

class ClusterRecon {
 public:
  // Prepares the GOF. Reads the arguments only during the call. Cannot fail: parsing has
  // checked every range, and sums are clipped.
  ClusterRecon(const SequenceHeader& header, const Topology& topology, const ClusterGof& gof);

  // Reconstructs frames first to first + count - 1 of the GOF, grid units,
  // [count][num_vertices][3]. Several frames at a time are faster than single ones.
  void frames(std::uint32_t first, std::uint32_t count,
              std::span<std::int32_t> positions) const;
  void frame(std::uint32_t f, std::span<std::int32_t> positions) const {
    frames(f, 1, positions);
  }
  std::uint32_t num_frames() const { return num_frames_; }
  // Return the clusters as bones, in decoded order, and their local coordinate frames in a
  // frame of the GOF. The rest shape has their places in the first frame.
  Skeleton skeleton() const;
  Vector<BonePlace> places(std::uint32_t f) const;
  static constexpr std::size_t values_of_frame() { return 0; }

 private:
  struct ClusterState {
    bool lcf_flag;
    std::array<std::size_t, 3> seed_track;
    Vector<std::uint32_t> vertices;
    ComponentSum factors;
  };

  Vector<std::int32_t> local_coordinates(const ComponentSum& factors, std::uint32_t first,
                                         std::uint32_t count) const;
  void cluster_frame(const ClusterState& cluster, std::uint32_t f,
                     std::span<const std::int32_t> local,
                     std::span<std::int32_t> positions) const;

  std::uint32_t num_frames_;
  int position_bits_;
  int fraction_bits_;
  std::uint32_t seed_step_;
  Vector<std::uint32_t> track_vertex_;
  Vector<Track> tracks_;
  Vector<ClusterState> clusters_;
};

}  // namespace rlpc
