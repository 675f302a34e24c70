// 6.11 and 6.12: skinned GOFs and slices, parsing side.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/bitstream/bit_reader.h"
#include "common/mesh/coded_meshes.h"
#include "common/result.h"
#include "common/skinned_gof/skinned_gof.h"
#include "common/skinned_gof/slice_models.h"
#include "common/syntax/access_unit.h"
#include "common/syntax/sequence_header.h"
#include "decoder/slice_cut.h"

namespace rlpc {

// The unit of a skinned GOF and the slice units after it, one by one. Every size is checked
// against the level, and the memory it needs against max_memory_bytes, before anything is
// allocated. Slices outside the cut are treated as absent.
class SkinnedGofParser {
 public:
  // All must outlive it.
  SkinnedGofParser(const SequenceHeader& header, const CodedMeshes& meshes,
                   std::uint64_t max_memory_bytes, const SliceCut& cut = {})
      : header_(header), meshes_(meshes), max_memory_bytes_(max_memory_bytes), cut_(cut) {}

  // 6.11 bones_of_gof( ): the rest of the payload of a GOF unit, to which `r` ends.
  Result<bool> bones(BitReader& r, const GofHeader& gof_header);
  // 6.12 slice_unit( ), after bones( ). unit_bit_pos: of the slice unit.
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos);
  // After the last slice.
  SkinnedGof finish() { return std::move(gof_); }

  // The slice that the last slice() parsed; none if the cut drops it.
  const std::optional<SliceEntry>& last_slice() const { return last_slice_; }
  // Whether a slice has been dropped so far.
  bool is_cut() const { return is_cut_; }

 private:
  class SliceParser;

  void layers(BitReader& r);
  void rest(BitReader& r);
  void bone_section(BitReader& r);
  bool may_follow(std::uint32_t group, std::uint32_t layers) const;

  const SequenceHeader& header_;
  const CodedMeshes& meshes_;
  std::uint64_t max_memory_bytes_;
  SliceCut cut_;
  const CodedMesh* mesh_ = nullptr;
  SkinnedGof gof_;
  std::uint64_t num_factors_ = 0;
  // From slice to slice (9.8.1).
  struct SliceState {
    void start(std::uint32_t num_frames);

    SliceModels models;
    Trajectory previous;  // header of the previous trajectory
    std::vector<std::uint32_t> trajectory_mean;
    std::unique_ptr<VertexModels> vertex_models;
    std::unique_ptr<VertexModels> models_of_group;
    std::optional<VertexContexts> contexts;  // of the current group
    std::uint32_t last_group = 0;
  };
  SliceState state_;
  // Groups from these on are dropped.
  struct CutGroups {
    std::uint32_t end_component_group = 0;
    std::uint32_t end_layer_group = 0;
    bool has(std::uint32_t group, std::uint32_t layers) const {
      return group < end_component_group && layers < end_layer_group;
    }
  };
  CutGroups kept_;
  bool is_cut_ = false;
  std::optional<SliceEntry> last_slice_;
};

}  // namespace rlpc
