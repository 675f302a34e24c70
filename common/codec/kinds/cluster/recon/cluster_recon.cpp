#include "common/codec/kinds/cluster/recon/cluster_recon.h"

#include <algorithm>
#include <utility>

#include "common/codec/bits/int_math.h"
#include "common/codec/components/series_predictor.h"
#include "common/memory/owned.h"

namespace rlpc {

// 8.3 Spatial prediction process
SpatialPrediction::SpatialPrediction(const Topology& topology,
                                     std::span<const std::uint32_t> vertices,
                                     std::span<const std::uint16_t> cluster_of_vertex,
                                     std::span<const std::uint32_t> local_index) {
  Vector<std::uint32_t> neighbour_first{0};
  Vector<std::uint32_t> parallelogram_first{0};
  Vector<std::uint32_t> neighbours;
  Vector<Parallelogram> parallelograms;
  for (const std::uint32_t v : vertices) {
    const std::uint16_t cluster = cluster_of_vertex[v];
    const auto inside = [&](std::uint32_t u) { return cluster_of_vertex[u] == cluster; };
    for (const std::uint32_t u : topology.earlier_neighbours[v]) {
      if (inside(u)) neighbours.push_back(local_index[u]);
    }
    for (const Parallelogram& p : topology.parallelograms[v]) {
      if (!inside(p.a) || !inside(p.b) || !inside(p.c)) continue;
      parallelograms.push_back({local_index[p.a], local_index[p.b], local_index[p.c]});
    }
    neighbour_first.push_back(static_cast<std::uint32_t>(neighbours.size()));
    parallelogram_first.push_back(static_cast<std::uint32_t>(parallelograms.size()));
  }
  neighbours_ = {std::move(neighbour_first), std::move(neighbours)};
  parallelograms_ = {std::move(parallelogram_first), std::move(parallelograms)};
}

// 8.3.3 Prediction of a spatial value
std::int64_t SpatialPrediction::predict(SpatialPredictor predictor,
                                        std::span<const std::int32_t> plane,
                                        std::size_t i) const {
  if (predictor == SpatialPredictor::kNone || i == 0) return 0;
  std::int64_t sum = 0;
  if (predictor == SpatialPredictor::kParallelogram && !parallelograms_[i].empty()) {
    const auto list = parallelograms_[i];
    for (const Parallelogram& p : list) {
      sum += std::int64_t{plane[p.a]} + plane[p.b] - plane[p.c];
    }
    return div_round(sum, static_cast<std::int64_t>(list.size()));
  }
  const auto list = neighbours_[i];
  if (list.empty()) return plane[i - 1];
  for (const std::uint32_t u : list) sum += plane[u];
  return div_round(sum, static_cast<std::int64_t>(list.size()));
}

ClusterMembers cluster_members(const ClusterGof& gof) {
  ClusterMembers members;
  members.vertices.resize(gof.clusters.size());
  members.local_index.resize(gof.cluster_of_vertex.size());
  for (std::uint32_t v = 0; v < gof.cluster_of_vertex.size(); ++v) {
    const std::uint16_t cluster = gof.cluster_of_vertex[v];
    if (cluster == kSeedCluster) continue;
    auto& list = members.vertices[cluster];
    members.local_index[v] = static_cast<std::uint32_t>(list.size());
    list.push_back(v);
  }
  return members;
}

// 8.5.1 Temporal values
Vector<std::int32_t> recon_temporal(const Component& component) {
  Vector<std::int32_t> values(component.temporal_residual.size());
  for (std::uint32_t f = 0; f < values.size(); ++f) {
    const std::int64_t prediction =
        predict_series([&](std::uint32_t g) { return std::int64_t{values[g]}; }, f,
                       component.temporal_predictor);
    values[f] = clip_signed(kTemporalIndexBits, prediction + component.temporal_residual[f]);
  }
  return values;
}

// 8.3 Spatial prediction process
Vector<std::int32_t> recon_spatial(const Component& component,
                                   const SpatialPrediction& prediction) {
  Vector<std::int32_t> values = component.spatial_residual;
  const std::size_t n = values.size() / 3;
  for (std::size_t c = 0; c < 3; ++c) {
    const std::span<std::int32_t> plane(values.data() + c * n, n);
    for (std::size_t i = 0; i < n; ++i) {
      plane[i] =
          clip_signed(component.spatial_bits,
                      prediction.predict(component.spatial_predictor, plane, i) + plane[i]);
    }
  }
  return values;
}

// 8.1 Decoding a GOF
ClusterRecon::ClusterRecon(const SequenceHeader& header, const Topology& topology,
                           const ClusterGof& gof)
    : num_frames_(gof.num_frames),
      position_bits_(header.position_bits),
      fraction_bits_(gof.fraction_bits),
      seed_step_(gof.seed_step),
      tracks_(recon_seed_tracks(gof, header.position_bits)) {
  Vector<std::size_t> track_of_vertex(header.num_vertices, 0);
  for (const SeedTrack& track : gof.seed_tracks) {
    track_of_vertex[track.vertex] = track_vertex_.size();
    track_vertex_.push_back(track.vertex);
  }
  ClusterMembers members = cluster_members(gof);
  clusters_.reserve(gof.clusters.size());
  for (std::size_t i = 0; i < gof.clusters.size(); ++i) {
    const Cluster& cluster = gof.clusters[i];
    Vector<std::uint32_t>& vertices = members.vertices[i];
    const SpatialPrediction prediction(topology, vertices, gof.cluster_of_vertex,
                                       members.local_index);
    const auto spatial = make_shared_owned<SpatialFactors>(3 * vertices.size());
    Vector<TemporalFactor> temporal;
    for (const Component& component : cluster.components) {
      spatial->add(recon_spatial(component, prediction), component.spatial_bits);
      temporal.push_back({recon_temporal(component), component.temporal_bits});
      for (std::int32_t& t : temporal.back().values) {
        t = scale_temporal(t, component.scale_idx, component.temporal_bits);
      }
    }
    std::array<std::size_t, 3> seed_track{};
    if (cluster.lcf_flag) {
      for (std::size_t k = 0; k < 3; ++k)
        seed_track[k] = track_of_vertex[cluster.seed_vertex[k]];
    }
    clusters_.push_back({cluster.lcf_flag, seed_track, std::move(vertices),
                         ComponentSum(spatial, temporal, num_frames_)});
  }
}

// 8.5.3 Spatial factor, and sum over the components: the local coordinates of frames first to
// first + count - 1, [count][3][vertices].
Vector<std::int32_t> ClusterRecon::local_coordinates(const ComponentSum& factors,
                                                     std::uint32_t first,
                                                     std::uint32_t count) const {
  const std::size_t size = factors.num_values();
  Vector<std::int32_t> local(count * size);
  Vector<std::int64_t> sums(count * kTileValues);
  for (std::size_t begin = 0; begin < size; begin += kTileValues) {
    std::fill(sums.begin(), sums.end(), 0);
    factors.add_tile(begin / kTileValues, first, count, sums);
    const std::size_t n = std::min(kTileValues, size - begin);
    for (std::size_t f = 0; f < count; ++f) {
      for (std::size_t i = 0; i < n; ++i) {
        const std::int64_t q = round2(sums[f * kTileValues + i], fraction_bits_);
        local[f * size + begin + i] = clip_signed(kLocalBits, q);
      }
    }
  }
  return local;
}

// 8.5.4 Positions of a cluster
void ClusterRecon::cluster_frame(const ClusterState& cluster, std::uint32_t f,
                                 std::span<const std::int32_t> local,
                                 std::span<std::int32_t> positions) const {
  const std::size_t n = cluster.vertices.size();
  const std::int32_t* x = local.data();
  const std::int32_t* y = x + n;
  const std::int32_t* z = y + n;
  Lcf lcf{};
  if (cluster.lcf_flag) {
    const auto& s = cluster.seed_track;
    lcf = make_lcf(tracks_[s[0]][f], tracks_[s[1]][f], tracks_[s[2]][f]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3l world = cluster.lcf_flag ? lcf_to_world(lcf, x[i], y[i], z[i])
                                         : Vec3l{round2(x[i], kLocalFractionBits),
                                                 round2(y[i], kLocalFractionBits),
                                                 round2(z[i], kLocalFractionBits)};
    std::int32_t* out = &positions[3 * std::size_t{cluster.vertices[i]}];
    for (std::size_t c = 0; c < 3; ++c) out[c] = clip_signed(position_bits_, world[c]);
  }
}

// Estimate of the coded values per vertex. Components are not counted: with so many values, the
// error is that of a step, which is nearly true.
constexpr std::size_t kValuesOfVertex = 12;

Skeleton ClusterRecon::skeleton() const {
  Skeleton skeleton;
  skeleton.step = seed_step_ << kLocalFractionBits;
  skeleton.values_of_vertex = kValuesOfVertex;
  for (const BonePlace& place : places(0)) skeleton.bones.push_back({-1, place});
  std::size_t num_vertices = track_vertex_.size();
  for (const ClusterState& cluster : clusters_) num_vertices += cluster.vertices.size();
  skeleton.influences.resize(num_vertices);
  for (std::size_t i = 0; i < clusters_.size(); ++i) {
    const SkeletonInfluence whole{static_cast<std::uint16_t>(i), 1};
    for (const std::uint32_t v : clusters_[i].vertices) skeleton.influences[v] = {whole};
    if (!clusters_[i].lcf_flag) continue;
    for (const std::size_t t : clusters_[i].seed_track) {
      skeleton.influences[track_vertex_[t]] = {whole};
    }
  }
  for (auto& list : skeleton.influences) {
    if (list.empty()) list = {{0, 1}};  // seed without a cluster
  }
  return skeleton;
}

Vector<BonePlace> ClusterRecon::places(std::uint32_t f) const {
  Vector<BonePlace> places;
  for (const ClusterState& cluster : clusters_) {
    constexpr std::int64_t kOne = std::int64_t{1} << kAxisFractionBits;
    BonePlace place{{{{kOne, 0, 0}, {0, kOne, 0}, {0, 0, kOne}}}, {}};
    if (cluster.lcf_flag) {
      const auto& s = cluster.seed_track;
      const Lcf lcf = make_lcf(tracks_[s[0]][f], tracks_[s[1]][f], tracks_[s[2]][f]);
      place.axes = lcf.axis;
      for (std::size_t c = 0; c < 3; ++c) {
        place.origin[c] = lcf.doubled_origin[c] * (std::int64_t{1} << (kLocalFractionBits - 1));
      }
    }
    places.push_back(place);
  }
  return places;
}

void ClusterRecon::frames(std::uint32_t first, std::uint32_t count,
                          std::span<std::int32_t> positions) const {
  const std::size_t size = positions.size() / count;
  for (std::uint32_t f = 0; f < count; ++f) {
    for (std::size_t t = 0; t < tracks_.size(); ++t) {
      for (std::size_t c = 0; c < 3; ++c) {
        positions[f * size + 3 * std::size_t{track_vertex_[t]} + c] = tracks_[t][first + f][c];
      }
    }
  }
  for (const ClusterState& cluster : clusters_) {
    const Vector<std::int32_t> local = local_coordinates(cluster.factors, first, count);
    for (std::uint32_t f = 0; f < count; ++f) {
      const std::size_t num_values = cluster.factors.num_values();
      cluster_frame(cluster, first + f, std::span(local).subspan(f * num_values, num_values),
                    positions.subspan(f * size, size));
    }
  }
}

}  // namespace rlpc
