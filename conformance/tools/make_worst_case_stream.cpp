// The units of the stream.
#include <algorithm>
#include <memory>
#include <span>

#include "common/codec/mesh/ordered_meshes.h"
#include "conformance/tools/make_worst_case.h"
#include "encoder/codec/write/write_cluster_gof.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/codec/write/write_inter_gof.h"
#include "encoder/codec/write/write_skinned_gof.h"
#include "encoder/codec/write/write_stream.h"

namespace rlpc::worst_case {
namespace {

class StreamMaker {
 public:
  StreamMaker(const Plan& plan, const std::function<void(const Bytes&)>& write)
      : plan_(plan), write_(write) {}

  void make() {
    const ConnectivityCode code = write_connectivity(plan_.size.vertices, plan_.triangles);
    set_header();
    write_(write_stream_header(header_.profile_idc));
    unit(UnitType::kSequenceHeader, write_sequence_header(header_));
    unit(UnitType::kConnectivity, code.payload);
    gofs(code.triangles);
    unit(UnitType::kEndOfSequence, write_end_of_sequence(0));
  }

 private:
  void set_header() {
    header_.profile_idc = std::min(static_cast<std::uint32_t>(plan_.kind), kProfileHigh);
    header_.level_idc = plan_.level;
    header_.num_vertices = plan_.size.vertices;
    header_.num_triangles = static_cast<std::uint32_t>(plan_.triangles.size());
    header_.num_frames = plan_.size.frames * plan_.num_rigs * plan_.num_rounds;
    header_.position_bits = kMaxPositionBits;
  }

  void unit(UnitType type, const Bytes& payload) { write_(write_unit(type, payload)); }
  void units(UnitType type, const SkinnedGofPayloads& payloads) {
    unit(type, payloads.first);
    for (const Bytes& slice : payloads.slices) unit(UnitType::kSlice, slice);
  }

  void gofs(std::span<const Triangle> triangles) {
    const Topology topology = make_topology(header_.num_vertices, triangles);
    if (plan_.kind == Kind::kCluster) {
      for (std::uint32_t i = 0; i < plan_.num_rounds; ++i) {
        ClusterGof gof = make_clusters(plan_.size, noise_);
        gof.first_frame = next_frame();
        unit(UnitType::kGof, write_cluster_gof(gof, header_, topology));
      }
      return;
    }
    const OrderedMeshes meshes(topology, triangles, header_.profile_idc >= kProfileHigh);
    const OrderedMesh& mesh = meshes[Prediction::kLayers];
    for (std::uint32_t i = 0; i < plan_.num_rounds; ++i) {
      if (plan_.kind == Kind::kSkinned) {
        SkinnedGof gof = make_bones(plan_.size, mesh, noise_);
        gof.first_frame = next_frame();
        units(UnitType::kGof, write_skinned_gof(gof, mesh, header_));
      } else if (plan_.kind == Kind::kSharedRig) {
        rigs_and_tracks(mesh);
      } else {
        frames(mesh);
      }
    }
  }

  void rigs_and_tracks(const OrderedMesh& mesh) {
    std::vector<std::shared_ptr<const SharedRig>> rigs;
    for (std::uint32_t m = 0; m < plan_.num_rigs; ++m) {
      rigs.push_back(std::make_shared<SharedRig>(make_rig(plan_.size, mesh, noise_)));
      units(UnitType::kRig, write_shared_rig(*rigs[m], m, mesh, header_));
    }
    for (std::uint32_t m = 0; m < plan_.num_rigs; ++m) {
      SkinnedGof gof = make_tracks(plan_.size, *rigs[m], noise_);
      gof.first_frame = next_frame();
      gof.rig = rigs[m];
      gof.rig_idx = m;
      units(UnitType::kGof, write_tracks(gof, mesh, header_));
    }
  }

  void frames(const OrderedMesh& mesh) {
    const InterSettings settings = make_frames(plan_.size, mesh);
    const GofHeader gof{GofKind::kInter, next_frame(), plan_.size.frames};
    unit(UnitType::kGof, write_inter_gof_unit(gof, settings, mesh.topology()));
    const FrameOrder order(settings.pattern, gof.num_frames);
    FrameUnitWriter writer(mesh, settings);
    for (std::uint32_t place = 0; place < gof.num_frames; ++place) {
      writer.start_frame(place, order[place]);
      if (place == 0) {
        writer.start_group(0);
        writer.write_positions(mesh.rest_order(),
                               noise_.residuals(std::size_t{3} * plan_.size.vertices),
                               std::vector<Counterpart>(plan_.size.vertices));
        writer.end_group();
        unit(UnitType::kFrame, writer.finish_units(0)[0]);
        continue;
      }
      writer.set_patches(motions());
      writer.start_group(0);
      for (const std::uint32_t v : mesh.vertices_of_layers(0, mesh.num_layers())) {
        writer.start(v);
        for (int c = 0; c < 3; ++c) writer.write(noise_.residual());
      }
      writer.end_group();
      const std::uint32_t layer = settings.pattern.temporal_layer(order[place].depth);
      unit(UnitType::kFrame, writer.finish_units(layer)[0]);
    }
  }

  // Each patch has a motion, to which the residuals of its vertices are added: more to do than
  // with neighbours or without residuals.
  FramePatches motions() {
    FramePatches patches(plan_.size.bones);
    for (PatchMotion& patch : patches) {
      patch.mode = PatchMode::kMotion;
      for (std::int32_t& residual : patch.residual) residual = noise_.residual();
    }
    return patches;
  }

  std::uint32_t next_frame() {
    const std::uint32_t frame = num_frames_;
    num_frames_ += plan_.size.frames;
    return frame;
  }

  const Plan& plan_;
  const std::function<void(const Bytes&)>& write_;
  SequenceHeader header_;
  Noise noise_;
  std::uint32_t num_frames_ = 0;
};

}  // namespace

void write_stream(const Plan& plan, const std::function<void(const Bytes&)>& write) {
  StreamMaker(plan, write).make();
}

}  // namespace rlpc::worst_case
