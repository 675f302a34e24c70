// 6.11 and 6.12: bones of a GOF, and slices, parsing side.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/bitstream/bit_reader.h"
#include "common/mesh/coded_mesh.h"
#include "common/result.h"
#include "common/skinned_gof/skinned_gof.h"
#include "common/skinned_gof/slice_models.h"
#include "common/syntax/sequence_header.h"
#include "decoder/parse/parse_cluster_gof.h"
#include "decoder/slice_cut.h"

namespace rlpc {

// What a decoder keeps of a stream for the prediction along the mesh.
class MeshPredictions {
 public:
  // triangles: in decoded order, read during the call. The topology must outlive it.
  MeshPredictions(const Topology& topology, std::span<const Triangle> triangles)
      : topology_(topology),
        layers_(make_layers(static_cast<std::uint32_t>(topology.earlier_neighbours.size()),
                            triangles)),
        meshes_{CodedMesh(Prediction::kNone, topology_, layers_),
                CodedMesh(Prediction::kParallelogram, topology_, layers_),
                CodedMesh(Prediction::kParallelograms, topology_, layers_),
                CodedMesh(Prediction::kLayers, topology_, layers_)} {}
  MeshPredictions(const MeshPredictions&) = delete;
  MeshPredictions& operator=(const MeshPredictions&) = delete;

  const CodedMesh& get(Prediction prediction) const {
    return meshes_[static_cast<std::size_t>(prediction)];
  }

 private:
  const Topology& topology_;
  VertexLayers layers_;
  std::array<CodedMesh, 4> meshes_;
};

// The unit of a GOF of bones and the slice units behind it, one after the other. Every size
// is checked against the level, and what it needs against max_memory_bytes, before memory is
// taken for it. Slices that the cut leaves out are as if they were absent.
class SkinnedGofParser {
 public:
  // All must outlive it.
  SkinnedGofParser(const SequenceHeader& header, const MeshPredictions& meshes,
                   std::uint64_t max_memory_bytes, const SliceCut& cut = {})
      : header_(header), meshes_(meshes), max_memory_bytes_(max_memory_bytes), cut_(cut) {}

  // 6.11 bones_of_gof( ): the rest of the payload of a GOF unit, to which `r` ends.
  Result<bool> bones(BitReader& r, const GofStart& start);
  // 6.12 slice_unit( ), after bones( ). unit_bit_pos: of the slice unit.
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos);
  // After the last slice: the GOF, with what absent slices are predicted to hold.
  SkinnedGof finish();

  const CodedMesh& mesh() const { return *mesh_; }
  // Whether a slice was left out so far.
  bool is_cut() const { return is_cut_; }

 private:
  class SliceParser;

  void layers(BitReader& r);
  void bone_section(BitReader& r);
  bool may_follow(std::uint32_t group, std::uint32_t layers) const;

  const SequenceHeader& header_;
  const MeshPredictions& meshes_;
  std::uint64_t max_memory_bytes_;
  SliceCut cut_;
  const CodedMesh* mesh_ = nullptr;
  SkinnedGof gof_;
  std::uint64_t num_factors_ = 0;
  // Models that go on from slice to slice (9.8.1).
  SliceModels models_;
  Trajectory previous_;  // header of the trajectory before
  std::vector<std::uint32_t> trajectory_mean_;
  std::unique_ptr<VertexModels> vertex_models_;
  std::unique_ptr<VertexModels> models_of_group_;
  std::optional<VertexContexts> contexts_;  // of the group that is being read
  std::uint32_t last_group_ = 0;
  // Groups from these on are left out.
  std::uint32_t end_component_group_ = 0;
  std::uint32_t end_layer_group_ = 0;
  bool is_cut_ = false;
};

}  // namespace rlpc
