#include "decoder/codec/kinds/cluster/parse/parse_cluster_gof.h"

#include <algorithm>

#include "common/codec/bits/int_math.h"
#include "common/codec/kinds/cluster/cluster_models.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/parse_cluster_map.h"
#include "decoder/codec/parse/parse_component_header.h"
#include "decoder/codec/parse/parse_track.h"
#include "decoder/codec/parse/rig_memory.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {
namespace {

// Bytes per value of a seed track: the residual, and the position.
constexpr std::uint64_t kBytesPerTrackValue = 14;

// Memory of the components of a cluster: residuals, and factors laid out for reconstruction
// (ComponentSum): spatial factors in tiles with two limbs, temporal factors with two limbs for
// each of these, in vectors whose capacity may be twice their size.
constexpr std::uint64_t kBytesPerComponent = 500;
constexpr std::uint64_t kBytesPerResidual = 4;
constexpr std::uint64_t kBytesPerTemporalFactor = 4 + 16;  // before and after it is laid out
constexpr std::uint64_t kBytesPerTile = kTileValues * 8 + 48;

std::uint64_t component_memory(std::uint64_t num_components, std::uint64_t num_values,
                               std::uint64_t num_frames) {
  const std::uint64_t tiles = (num_values + kTileValues - 1) / kTileValues;
  return num_components * (kBytesPerComponent + kBytesPerResidual * (num_values + num_frames) +
                           kBytesPerTemporalFactor * num_frames + kBytesPerTile * tiles);
}

// Parses the range-coder section of a GOF. Errors are sticky: nothing is read after the first.
class ClusterSectionParser {
 public:
  ClusterSectionParser(BitReader& r, const SequenceHeader& header, const Topology& topology,
                       ClusterGof& gof, const MemoryLimit& memory)
      : section_(r, "gof_section"),
        header_(header),
        topology_(topology),
        gof_(gof),
        memory_(memory) {}

  void parse();

 private:
  bool failed() const { return section_.failed(); }
  void cluster_headers();
  void cluster_seeds(std::size_t cluster_index);
  void count_factors(std::uint64_t more, const char* element);
  // Fails if the memory needed so far exceeds the caller's limit.
  void take_memory(std::uint64_t bytes, const char* element);
  void seed_tracks();
  void component_counts();
  void components();
  void component(std::size_t coded_vertices, Component& component);

  SectionReader section_;
  const SequenceHeader& header_;
  const Topology& topology_;
  ClusterGof& gof_;
  MemoryLimit memory_;
  ClusterModels models_;
  Vector<std::size_t> coded_vertices_;  // [cluster] number of coded vertices
  std::uint64_t num_factors_ = 0;
  std::uint64_t memory_bytes_ = 0;
  Vector<std::uint32_t> frame_mean_;
  Component previous_;  // header of the previous component
};

// 6.5.2 cluster_headers( )
void ClusterSectionParser::cluster_headers() {
  gof_.cluster_of_vertex.assign(header_.num_vertices, 0);
  for (std::size_t i = 0; i < gof_.clusters.size() && !failed(); ++i) {
    gof_.clusters[i].lcf_flag = section_.bin(models_.lcf_flag, "lcf_flag");
    if (gof_.clusters[i].lcf_flag) cluster_seeds(i);
    section_.check_overrun("lcf_flag");
  }
}

void ClusterSectionParser::cluster_seeds(std::size_t cluster_index) {
  Cluster& cluster = gof_.clusters[cluster_index];
  for (std::uint32_t& v : cluster.seed_vertex) {
    v = section_.bypass(ceil_log2(header_.num_vertices), "seed_vertex");
    if (v >= header_.num_vertices) {
      section_.fail("R-GOF-06", "seed_vertex");
      return;
    }
  }
  const auto& s = cluster.seed_vertex;
  if (s[0] == s[1] || s[1] == s[2] || s[2] == s[0]) {
    section_.fail("R-GOF-07", "seed_vertex");
    return;
  }
  std::uint32_t anchor = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto known = std::find_if(gof_.seed_tracks.begin(), gof_.seed_tracks.end(),
                                    [&](const SeedTrack& t) { return t.vertex == s[k]; });
    const auto index = static_cast<std::uint32_t>(known - gof_.seed_tracks.begin());
    if (k == 0) anchor = index;
    if (known != gof_.seed_tracks.end()) continue;
    gof_.seed_tracks.push_back({s[k], anchor, {}});
    gof_.cluster_of_vertex[s[k]] = kSeedCluster;
  }
}

// NumFactors of 6.5.4 and 6.5.5
void ClusterSectionParser::count_factors(std::uint64_t more, const char* element) {
  num_factors_ += more;
  if (num_factors_ > header_.level().max_gof_factors) section_.fail("R-LVL-05", element);
}

void ClusterSectionParser::take_memory(std::uint64_t bytes, const char* element) {
  memory_bytes_ += bytes;
  section_.check_memory(memory_, memory_bytes_, element);
}

// 6.5.4 seed_tracks( )
void ClusterSectionParser::seed_tracks() {
  frame_mean_.assign(gof_.num_frames, 0);
  const std::uint64_t values = 3 * std::uint64_t{gof_.seed_tracks.size()} * gof_.num_frames;
  count_factors(values, "seed_residual");
  take_memory(kBytesPerTrackValue * values, "seed_residual");
  const Vector<TrackPlace> order = track_order(gof_.num_frames, 0, 0);
  for (SeedTrack& track : gof_.seed_tracks) {
    if (failed()) return;
    track.residual.assign(gof_.num_frames, {});
    parse_track(section_, {&models_.seed, 1}, frame_mean_, order, track.residual,
                "seed_residual");
    section_.check_overrun("seed_residual");
  }
}

// 6.5.5 component_counts( )
void ClusterSectionParser::component_counts() {
  int previous = 0;
  coded_vertices_.assign(gof_.clusters.size(), 0);
  for (const std::uint16_t i : gof_.cluster_of_vertex) {
    if (i != kSeedCluster) ++coded_vertices_[i];
  }
  Vector<std::size_t> counts(gof_.clusters.size(), 0);
  std::uint64_t memory = 0;
  for (std::size_t i = 0; i < counts.size() && !failed(); ++i) {
    const Range range{0, header_.level().max_components};
    previous = parse_header_field(section_, models_.header, models_.header_mean,
                                  HeaderField::kNumComponents, previous, range,
                                  "num_components_delta", "R-GOF-09");
    if (failed()) return;
    counts[i] = static_cast<std::size_t>(previous);
    const std::uint64_t num_values = 3 * std::uint64_t{coded_vertices_[i]};
    count_factors(counts[i] * (num_values + gof_.num_frames), "num_components_delta");
    memory += component_memory(counts[i], num_values, gof_.num_frames);
  }
  take_memory(memory, "num_components_delta");
  if (failed()) return;
  for (std::size_t i = 0; i < counts.size(); ++i) gof_.clusters[i].components.resize(counts[i]);
}

// 6.5.6 components( )
void ClusterSectionParser::components() {
  for (std::size_t i = 0; i < gof_.clusters.size(); ++i) {
    frame_mean_.assign(gof_.num_frames, 0);
    for (Component& c : gof_.clusters[i].components) {
      component(coded_vertices_[i], c);
      section_.check_overrun("spatial_residual");
      if (failed()) return;
    }
  }
}

// 6.5.7 component( )
void ClusterSectionParser::component(std::size_t coded_vertices, Component& component) {
  parse_component_header(section_, models_.header, models_.header_mean, previous_, component);
  if (failed()) return;
  component.temporal_predictor =
      section_.truncated_unary(models_.temporal_predictor, "temporal_predictor");
  component.spatial_predictor = static_cast<SpatialPredictor>(
      section_.truncated_unary(models_.spatial_predictor, "spatial_predictor"));
  previous_ = component;

  TemporalContext temporal(frame_mean_, component);
  component.temporal_residual.resize(gof_.num_frames);
  for (std::uint32_t f = 0; f < gof_.num_frames; ++f) {
    const std::int32_t value =
        section_.residual(models_.temporal, temporal.expected(f), "temporal_residual");
    temporal.update(f, value);
    component.temporal_residual[f] = value;
  }
  SpatialContext spatial(component);
  component.spatial_residual.resize(3 * coded_vertices);
  for (std::size_t i = 0; i < coded_vertices; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      const std::int32_t value =
          section_.residual(models_.spatial, spatial.expected(c), "spatial_residual");
      spatial.update(c, value);
      component.spatial_residual[c * coded_vertices + i] = value;
    }
  }
}

// 6.5.1 gof_section( )
void ClusterSectionParser::parse() {
  cluster_headers();
  if (!failed()) {
    parse_cluster_map(section_, topology_, models_, gof_.clusters.size(),
                      gof_.cluster_of_vertex);
  }
  if (!failed()) seed_tracks();
  if (!failed()) component_counts();
  if (!failed()) components();
  section_.finish();
}

}  // namespace

// 6.5 clusters_of_gof( )
std::uint32_t parse_clusters_header(BitReader& r, const SequenceHeader& header,
                                    ClusterGof& gof) {
  const Level& level = header.level();
  const std::uint32_t num_clusters =
      r.ue("num_clusters_minus1", {0, std::int64_t{level.max_clusters} - 1}, "R-LVL-06") + 1;
  gof.fraction_bits =
      static_cast<int>(r.u(5, "fraction_bits", {0, kMaxFractionBits}, "R-GOF-03"));
  gof.seed_step = r.ue("seed_step_minus1", {0, kMaxSeedStep - 1}, "R-GOF-04") + 1;
  gof.seed_predictor =
      static_cast<int>(r.u(3, "seed_predictor", {0, kMaxPredictorOrder}, "R-GOF-05"));
  gof.seed_coupling_flag = r.flag("seed_coupling_flag");
  r.byte_alignment();
  return num_clusters;
}

Result<ClusterGof> parse_clusters(BitReader& r, const SequenceHeader& header,
                                  const Topology& topology, const GofHeader& gof_header,
                                  const MemoryLimit& memory) {
  ClusterGof gof;
  static_cast<GofHeader&>(gof) = gof_header;
  const std::uint32_t num_clusters = parse_clusters_header(r, header, gof);
  if (r.error()) return *r.error();
  gof.clusters.resize(num_clusters);
  ClusterSectionParser(r, header, topology, gof, memory).parse();
  if (r.error()) return *r.error();
  return gof;
}

Result<bool> ClusterGofParser::gof(BitReader& r, const GofHeader& header,
                                   const RigSlots& rigs) {
  memory_.bytes_in_use += memory_of_rigs(rigs);
  auto parsed = parse_clusters(r, header_, topology_, header, memory_);
  if (!parsed) return parsed.error();
  gof_ = std::move(*parsed);
  return true;
}

}  // namespace rlpc
