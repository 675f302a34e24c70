#include "encoder/codec/write/write_cluster_gof.h"

#include <cassert>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/cluster/cluster_models.h"
#include "encoder/codec/write/section_writer.h"
#include "encoder/codec/write/write_cluster_map.h"
#include "encoder/codec/write/write_gof_header.h"

namespace rlpc {
namespace {

class ClusterSectionWriter {
 public:
  ClusterSectionWriter(const SequenceHeader& header, const Topology& topology,
                       const ClusterGof& gof)
      : header_(header), topology_(topology), gof_(gof) {}

  std::vector<std::uint8_t> write();

 private:
  void header_delta(HeaderField field, int value, int previous);
  void cluster_headers();
  void seed_tracks();
  void component_counts();
  void component(const Component& component);

  const SequenceHeader& header_;
  const Topology& topology_;
  const ClusterGof& gof_;
  SectionWriter section_;
  ClusterModels models_;
  std::vector<std::uint32_t> frame_mean_;
  int previous_scale_idx_ = Component{}.scale_idx;
  int previous_spatial_bits_ = Component{}.spatial_bits;
  int previous_temporal_bits_ = Component{}.temporal_bits;
};

// 9.5.4 ae_header( field )
void ClusterSectionWriter::header_delta(HeaderField field, int value, int previous) {
  std::uint32_t& mean = models_.header_mean[static_cast<std::size_t>(field)];
  section_.header_value(models_.header, mean, value, previous);
}

// 6.5.2 cluster_headers( )
void ClusterSectionWriter::cluster_headers() {
  for (const Cluster& cluster : gof_.clusters) {
    section_.bin(models_.lcf_flag, cluster.lcf_flag);
    if (!cluster.lcf_flag) continue;
    for (const std::uint32_t v : cluster.seed_vertex) {
      assert(v < header_.num_vertices);
      section_.bypass(ceil_log2(header_.num_vertices), v);
    }
  }
}

// 6.5.4 seed_tracks( )
void ClusterSectionWriter::seed_tracks() {
  frame_mean_.assign(gof_.num_frames, 0);
  const std::vector<TrackPlace> order = track_order(gof_.num_frames, 0, 0);
  for (const SeedTrack& track : gof_.seed_tracks) {
    section_.track({&models_.seed, 1}, frame_mean_, order, track.residual);
  }
}

// 6.5.5 component_counts( )
void ClusterSectionWriter::component_counts() {
  int previous = 0;
  for (const Cluster& cluster : gof_.clusters) {
    const int count = static_cast<int>(cluster.components.size());
    header_delta(HeaderField::kNumComponents, count, previous);
    previous = count;
  }
}

// 6.5.7 component( )
void ClusterSectionWriter::component(const Component& component) {
  header_delta(HeaderField::kScaleIdx, component.scale_idx, previous_scale_idx_);
  header_delta(HeaderField::kSpatialBits, component.spatial_bits, previous_spatial_bits_);
  header_delta(HeaderField::kTemporalBits, component.temporal_bits, previous_temporal_bits_);
  previous_scale_idx_ = component.scale_idx;
  previous_spatial_bits_ = component.spatial_bits;
  previous_temporal_bits_ = component.temporal_bits;
  section_.truncated_unary(models_.temporal_predictor, component.temporal_predictor);
  section_.truncated_unary(models_.spatial_predictor,
                           static_cast<int>(component.spatial_predictor));

  TemporalContext temporal(frame_mean_, component);
  for (std::uint32_t f = 0; f < gof_.num_frames; ++f) {
    const std::int32_t residual = component.temporal_residual[f];
    section_.residual(models_.temporal, temporal.expected(f), residual);
    temporal.update(f, residual);
  }
  SpatialContext spatial(component);
  const std::size_t n = component.spatial_residual.size() / 3;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t residual = component.spatial_residual[c * n + i];
      section_.residual(models_.spatial, spatial.expected(c), residual);
      spatial.update(c, residual);
    }
  }
}

// 6.5.1 gof_section( )
std::vector<std::uint8_t> ClusterSectionWriter::write() {
  cluster_headers();
  write_cluster_map(section_, topology_, models_, gof_.clusters.size(), gof_.cluster_of_vertex);
  seed_tracks();
  component_counts();
  for (const Cluster& cluster : gof_.clusters) {
    frame_mean_.assign(gof_.num_frames, 0);
    for (const Component& c : cluster.components) component(c);
  }
  return section_.finish();
}

}  // namespace

// 6.5 gof( )
std::vector<std::uint8_t> write_cluster_gof(const ClusterGof& gof, const SequenceHeader& header,
                                            const Topology& topology) {
  BitWriter w;
  write_gof_header(w, gof, header.profile_idc);
  w.ue(static_cast<std::uint32_t>(gof.clusters.size()) - 1);
  w.u(5, static_cast<std::uint32_t>(gof.fraction_bits));
  w.ue(gof.seed_step - 1);
  w.u(3, static_cast<std::uint32_t>(gof.seed_predictor));
  w.flag(gof.seed_coupling_flag);
  w.byte_alignment();
  w.append(ClusterSectionWriter(header, topology, gof).write());
  return w.take();
}

}  // namespace rlpc
