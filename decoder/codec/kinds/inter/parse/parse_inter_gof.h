// 6.14: inter GOFs and their frame units, parsing side.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/inter/inter_contexts.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/patch_contexts.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_headers.h"
#include "decoder/codec/parse/gof_parser.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/parse/section_reader.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// Parses a GOF unit and the frame units after it. Checks every size against the level, and the
// memory it needs against the limit, before allocating. Layer groups outside the cut are
// treated as absent.
class InterGofParser final : public GofParser {
 public:
  // The mesh must have layers. The references must outlive it. memory.bytes_in_use: memory of
  // the rest of the decoder.
  InterGofParser(const SequenceHeader& header, const OrderedMesh& mesh,
                 const MemoryLimit& memory, const SliceCut& cut = {})
      : header_(header), mesh_(mesh), memory_(memory), cut_(cut) {}

  // 6.14 frames_of_gof( ): the rest of the payload of a GOF unit, where `r` ends.
  Result<bool> gof(BitReader& r, const GofHeader& gof_header);
  // 6.14.2 frame_unit( ). unit_bit_pos: start of the unit.
  Result<bool> frame(BitReader& r, std::uint64_t unit_bit_pos);
  InterGof finish();

  // Return the settings of the GOF unit, and the order of the frames known so far.
  const InterSettings& settings() const { return gof_; }
  const FrameOrder& order() const { return *order_; }
  // Returns the number of leading places whose frames have all their frame units: 8.19.1
  // DecodeCompleteFrames( ).
  std::uint32_t complete_places() const;
  // Hands over a complete frame.
  InterFrame take_frame(std::uint32_t frame);

  // Returns the unit that the last frame() parsed; none if the cut drops it.
  const std::optional<SliceEntry>& last_unit() const { return last_unit_; }

  Result<bool> gof(BitReader& r, const GofHeader& header, const RigSlots& rigs) override;
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos,
                     Vector<SliceEntry>& slices) override;
  bool is_cut() const override { return is_cut_; }
  std::uint64_t memory_bytes() const override { return rig_bytes_ + memory_bytes_; }
  AnyGof take_gof() override { return finish(); }

 private:
  void patch_map(BitReader& r);
  void end_gof(BitReader& r, std::uint32_t num_frames, std::uint64_t unit_bit_pos);
  void frames_of_group(BitReader& r, const FrameUnitStart& start, SliceEntry& unit,
                       std::uint64_t unit_bit_pos);
  // Returns the places of the frames of a unit; fewer than it declares if the GOF has fewer.
  Vector<std::uint32_t> unit_places(const SliceEntry& unit) const;
  // Returns whether a frame has all its frame units.
  bool is_whole(const InterFrame& frame) const {
    return frame.repeated || frame.layer_groups == gof_.layer_group_size.size();
  }
  // Returns the first place of a frame of a temporal layer that lacks a layer group, or the
  // number of frames. Takes time in proportion to the frames of the GOF over all calls, since
  // frames only gain layer groups.
  std::uint32_t first_lacking(std::uint32_t layer, std::uint32_t group);
  // Returns whether the frames of a unit continue those of the units before, as they do in an
  // open-ended stream.
  bool continues(const SliceEntry& unit, std::span<const std::uint32_t> places) const;
  bool may_follow(const SliceEntry& unit, std::span<const std::uint32_t> places);
  // Returns false if the frame repeats another.
  bool frame_start(BitReader& r, const SliceEntry& unit, std::uint32_t place);
  void earlier_frame(BitReader& r, std::uint32_t place);
  void patch_motions(SectionReader& section, InterFrame& frame);
  void frame_section(BitReader& r, const SliceEntry& unit,
                     std::span<const std::uint32_t> places);
  void positions_in_order(SectionReader& section, InterFrame& frame);
  void frame_residuals(SectionReader& section, const SliceEntry& unit, std::uint32_t place);
  InterFrame& frame_at(std::uint32_t place) { return frames_[(*order_)[place].frame]; }
  bool has_memory(BitReader& r, std::uint64_t more, const char* structure, std::uint64_t at);

  const SequenceHeader& header_;
  const OrderedMesh& mesh_;
  MemoryLimit memory_;
  SliceCut cut_;
  InterGof gof_;  // without its frames
  Vector<InterFrame> frames_;
  std::optional<InterContexts> contexts_;
  std::optional<PatchContexts> patch_contexts_;  // none: no patches
  std::optional<FrameOrder> order_;
  std::uint32_t unit_place_ = 0;                 // UnitPlace
  std::uint32_t next_place_ = 0;                 // LastPlace + 1
  Vector<std::uint32_t> to_come_;                // FramesToCome, by place
  Vector<Vector<std::uint32_t>> first_lacking_;  // [temporal layer][layer group]; lower bounds
  std::uint32_t end_layer_group_ = 0;            // first layer group that the cut drops
  std::uint32_t end_temporal_layer_ = 0;         // first temporal layer that the cut drops
  bool is_cut_ = false;
  std::optional<SliceEntry> last_unit_;
  std::uint64_t rig_bytes_ = 0;     // of the shared rigs alive
  std::uint64_t memory_bytes_ = 0;  // of what has been parsed so far
};

}  // namespace rlpc
