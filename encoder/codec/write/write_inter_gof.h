// 6.14: inter GOFs and their frame units, writing side.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/codec/bits/bit_writer.h"
#include "common/codec/kinds/inter/inter_contexts.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/inter/patch_contexts.h"
#include "common/codec/mesh/ordered_mesh.h"
#include "common/codec/mesh/rest_order.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/write/section_writer.h"

namespace rlpc {

// 6.14 frames_of_gof( ): returns the payload of the GOF unit. Settings must be legal.
std::vector<std::uint8_t> write_inter_gof_unit(const GofHeader& gof,
                                               const InterSettings& settings,
                                               const Topology& topology);

// Writes frame units, residual by residual, so that an encoder can choose each by its cost.
class FrameUnitWriter {
 public:
  // Mesh and settings must outlive it.
  FrameUnitWriter(const OrderedMesh& mesh, const InterSettings& settings,
                  bool is_open_ended = false)
      : settings_(settings),
        is_open_ended_(is_open_ended),
        contexts_(mesh, settings.layer_group_size.size(), settings.pattern.num_depths()),
        patch_contexts_(settings.num_patches, settings.pattern.num_depths()),
        units_(settings.pattern.temporal_layers) {}

  // Starts a frame. Calls for each frame, in coding order: start_frame(), with its place, and
  // for each layer group start_group(), the vertices of its layers in mesh order except those
  // that patches move alone, and end_group(). If the GOF has patches, set_patches() comes
  // second in each frame but the first. finish_units() comes after one or more frames of a
  // temporal layer; in an open-ended stream, before a frame of another temporal layer.
  // step_delta: used if the GOF has step_delta_flag, and the frame is not the first.
  void start_frame(std::uint32_t place, const FramePlace& frame, std::int32_t step_delta = 0);
  // Sets the distance, in places, of the earlier frame that predicts this one instead of its
  // references.
  void set_reference(std::uint32_t distance) { reference_distance_ = distance; }
  void set_patches(const FramePatches& patches) { patches_ = patches; }
  void start_group(std::uint32_t layer_group);
  // Writes a first frame in an order of its own, instead of its vertices: residuals,
  // [num_vertices][3], and counterparts, [num_vertices] or empty.
  void write_positions(const RestOrder& order, std::span<const std::int32_t> residuals,
                       std::span<const Counterpart> counterparts);
  // Writes that the frame repeats the one so many places before, instead of all these calls.
  void repeat(const FramePlace& frame, std::uint32_t distance);
  // Starts a vertex; then call write() for each axis.
  void start(std::uint32_t v) { contexts_.start(v); }
  InterContexts& contexts() { return contexts_; }
  const PatchContexts& patch_contexts() const { return patch_contexts_; }
  void write(std::int32_t residual);
  // Ends a layer group. frame_crc: used in the last group if the GOF has hashes of frames.
  void end_group(std::uint32_t frame_crc = 0);
  // Return the number of frames in the units of a temporal layer, and the bytes of their
  // sections so far.
  std::size_t unit_frames(std::uint32_t layer) const {
    return units_[layer].empty() ? 0 : units_[layer][0].frames.size();
  }
  std::size_t unit_bytes(std::uint32_t layer) const;
  // Ends the units of a temporal layer, which must have frames, and returns their payloads by
  // ascending layer group.
  std::vector<std::vector<std::uint8_t>> finish_units(std::uint32_t layer);

 private:
  struct UnitFrame {
    std::uint32_t frame = 0;
    std::uint32_t distance = 0;  // places to its repeated or reference frame; 0: neither
    bool is_repeated = false;
    std::int32_t step_delta = 0;
    std::uint32_t crc = 0;
  };

  struct Unit {
    std::vector<UnitFrame> frames;
    std::optional<SectionWriter> section;
  };

  Unit& unit_of(const FramePlace& frame, std::uint32_t layer_group);
  std::vector<std::uint8_t> payload_of(std::uint32_t layer_group, Unit unit) const;
  void write_patches();

  const InterSettings& settings_;
  bool is_open_ended_;
  InterContexts contexts_;
  PatchContexts patch_contexts_;
  FramePatches patches_;  // patches of the frame
  std::uint32_t reference_distance_ =
      0;  // places; 0: the frame has the references of its pattern
  std::uint32_t place_ = 0;
  FramePlace frame_;
  std::int32_t step_delta_ = 0;
  std::vector<std::vector<Unit>> units_;  // [temporal layer][layer group]
  Unit* unit_ = nullptr;                  // unit of the frame and layer group
};

// 6.14.2 gof_end( ): returns the payload of a frame unit that ends a GOF of an open-ended
// stream.
std::vector<std::uint8_t> write_gof_end(std::uint32_t num_frames);

// Payloads of a GOF unit and of its frame units.
struct InterGofPayloads {
  std::vector<std::uint8_t> first;
  std::vector<std::vector<std::uint8_t>> frames;
};
// Writes the whole GOF, with the layer groups that each frame has. frames_per_unit: maximum;
// frames share units only if they are of one temporal layer and have the same layer groups.
InterGofPayloads write_inter_gof(const InterGof& gof, const OrderedMesh& mesh,
                                 std::uint32_t frames_per_unit = 1);

}  // namespace rlpc
