// 6.14: GOFs of frames and their frame units, parsing side.
#pragma once

#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "common/bitstream/bit_reader.h"
#include "common/frame_gof/frame_contexts.h"
#include "common/frame_gof/frame_gof.h"
#include "common/mesh/coded_mesh.h"
#include "common/result.h"
#include "common/syntax/access_unit.h"
#include "common/syntax/sequence_header.h"
#include "decoder/parse/memory_limit.h"
#include "decoder/slice_cut.h"

namespace rlpc {

// A GOF unit and the frame units after it, one by one. Every size is checked against the level,
// and the memory it needs against the limit, before anything is allocated. Layer groups outside
// the cut are treated as absent.
class FrameGofParser {
 public:
  // The mesh must have layers. All must outlive it. memory.bytes_in_use: by all others.
  FrameGofParser(const SequenceHeader& header, const CodedMesh& mesh, const MemoryLimit& memory,
                 const SliceCut& cut = {})
      : header_(header), mesh_(mesh), memory_(memory), cut_(cut) {}

  // 6.14 frames_of_gof( ): the rest of the payload of a GOF unit, to which `r` ends.
  Result<bool> gof(BitReader& r, const GofHeader& gof_header);
  // 6.14.1 frame_unit( ). unit_bit_pos: of the unit.
  Result<bool> frame(BitReader& r, std::uint64_t unit_bit_pos);
  FrameGof finish();

  // The unit that the last frame() parsed; none if the cut drops it.
  const std::optional<SliceEntry>& last_unit() const { return last_unit_; }
  bool is_cut() const { return is_cut_; }
  // Estimated memory of what has been parsed so far.
  std::uint64_t memory_bytes() const { return memory_bytes_; }

 private:
  void weights(BitReader& r);
  SliceEntry frame_header(BitReader& r) const;
  void frame_section(BitReader& r, const SliceEntry& unit);
  bool has_memory(BitReader& r, std::uint64_t more, const char* element);

  const SequenceHeader& header_;
  const CodedMesh& mesh_;
  MemoryLimit memory_;
  SliceCut cut_;
  FrameGof gof_;  // without its frames
  std::vector<CodedFrame> frames_;
  std::optional<FrameContexts> contexts_;
  std::vector<std::uint32_t> frames_of_group_;  // FramesOfGroup
  std::uint32_t next_frame_ = 0;                // whose contexts have not started
  std::uint32_t end_layer_group_ = 0;           // of those that the cut keeps
  bool is_cut_ = false;
  std::optional<SliceEntry> last_unit_;
  std::uint64_t memory_bytes_ = 0;
};

}  // namespace rlpc
