// 6.11 to 6.13: skinned GOFs, shared rigs and their slices, parsing side.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/rig_slots.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/kinds/skinned/slice_models.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_headers.h"
#include "decoder/codec/parse/gof_parser.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

class SectionReader;

// Parses the unit of a skinned GOF or shared rig and the slice units after it. Checks every
// size against the level, and the memory it needs against the limit, before allocating. Slices
// outside the cut are treated as absent.
class SkinnedGofParser final : public GofParser {
 public:
  // The references must outlive it.
  SkinnedGofParser(const SequenceHeader& header, const OrderedMeshes& meshes,
                   const MemoryLimit& memory, const SliceCut& cut = {})
      : header_(header), meshes_(meshes), memory_(memory), cut_(cut) {}

  // Parse the rest of the payload of a unit, where `r` ends; one of them must be called first.
  // rigs: the shared rigs alive at the unit.
  //
  // 6.11 bones_of_gof( )
  Result<bool> bones(BitReader& r, const GofHeader& gof_header, const RigSlots& rigs = {});
  // 6.13.1 tracks_of_gof( )
  Result<bool> tracks(BitReader& r, const GofHeader& gof_header, const RigSlots& rigs);
  // 6.13 rig( )
  Result<bool> rig(BitReader& r, const RigSlots& rigs);

  bool drops(BitReader& r) override;
  // 6.12 slice_unit( ). unit_bit_pos: start of the slice unit.
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos);

  // Return the GOF or the shared rig, after the last slice.
  SkinnedGof finish() { return std::move(gof_); }
  std::shared_ptr<const SharedRig> finish_rig();
  std::uint32_t rig_idx() const { return gof_.rig_idx; }

  // Returns the slice that the last slice() parsed; none if the cut drops it.
  const std::optional<SliceEntry>& last_slice() const { return last_slice_; }

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override;
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                     Vector<SliceEntry>& slices) override;
  bool is_cut() const override { return gof_.is_cut; }
  std::uint64_t memory_bytes() const override { return memory_bytes_; }
  AnyGof take_gof() override { return finish(); }

 private:
  class SliceParser;
  enum class Unit : std::uint8_t { kGof, kRig, kTracks };

  Result<bool> rig(BitReader& r);
  void start_temporal_layers();
  void load_rig();
  void bone_section(BitReader& r);
  void track_section(BitReader& r);
  // Counts the spatial factors of all vertices, the values of tracks, and the memory for both,
  // before a section is parsed that adds to them.
  struct Factors {
    std::uint64_t spatial = 0;
    std::uint64_t track_values = 0;
  };
  std::uint64_t factors_of_bones() const {
    const std::uint64_t values = gof_.stretch_flag ? 9 : 6;
    return values * gof_.bones.size() * gof_.num_frames;
  }
  void count_factors(SectionReader& section, const Factors& factors, const char* element);
  // Returns whether slices of the group have only tracks: the shared rig has the vertices.
  bool has_only_tracks(std::uint32_t group) const {
    return unit_ == Unit::kTracks && group <= gof_.num_component_groups;
  }
  // Returns the trajectories of a component group, from 1 on, of the GOF or its shared rig.
  FactorGroup tracks_of(std::uint32_t group) const {
    return has_only_tracks(group) ? factor_group(*gof_.rig, group)
                                  : factor_group(gof_, own_group(group));
  }
  // Returns the index of a component group among those with vertices in this GOF.
  std::size_t own_group(std::uint32_t group) const {
    return unit_ == Unit::kTracks ? group - gof_.num_component_groups : group;
  }
  std::uint32_t temporal_layers(std::uint32_t group) const;
  SliceCounts slice_counts() const;
  bool may_follow(const SliceEntry& slice) const;

  const SequenceHeader& header_;
  const OrderedMeshes& meshes_;
  MemoryLimit memory_;
  SliceCut cut_;
  const OrderedMesh* mesh_ = nullptr;
  Unit unit_ = Unit::kGof;
  SkinnedGof gof_;  // or shared rig
  std::uint64_t num_factors_ = 0;
  std::uint64_t memory_bytes_ = 0;
  // State that slices inherit from the previous one (9.8.1).
  struct SliceState {
    void start(std::uint32_t num_frames, std::uint32_t first_group);

    std::uint32_t first_own_group = 1;
    SliceModels models;
    Trajectory previous;  // header of the previous trajectory
    Vector<std::uint32_t> trajectory_mean;
    std::shared_ptr<VertexModels> vertex_models;
    std::shared_ptr<VertexModels> models_of_group;
    std::optional<VertexContexts> contexts;  // contexts of the current group
    std::uint32_t last_group = 0;
    std::uint32_t last_temporal_layer = 0;
  };
  SliceState state_;
  // First groups and layers that the cut drops.
  struct CutGroups {
    std::uint32_t end_component_group = 0;
    std::uint32_t end_layer_group = 0;
    std::uint32_t end_temporal_layer = 0;
    bool has(const SliceEntry& slice) const {
      return slice.component_group_idx < end_component_group &&
             slice.layer_group_idx < end_layer_group &&
             slice.temporal_layer_idx < end_temporal_layer;
    }
  };
  CutGroups kept_;
  std::optional<SliceEntry> last_slice_;
};

}  // namespace rlpc
