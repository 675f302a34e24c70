// 6.14: an inter GOF, whose frames are predicted from decoded frames.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>

#include "common/codec/kinds/inter/compact_residuals.h"
#include "common/codec/kinds/inter/frame_order.h"
#include "common/codec/kinds/inter/patch_motion.h"
#include "common/codec/mesh/weight_settings.h"
#include "common/codec/rest/rest_shape.h"
#include "common/codec/syntax/gof_hash.h"
#include "common/codec/syntax/gof_header.h"
#include "common/memory/owned.h"

namespace rlpc {

inline constexpr std::uint32_t kMaxInterStep = 1U << 16;  // 1/16 grid units
inline constexpr std::uint32_t kExactInterStep = 16;      // one grid unit
inline constexpr std::uint32_t kMaxInterExpected = 1023;  // 9.8.6, 1/16

// frame_step_delta, 1/16 of the step of the depth
inline constexpr std::int32_t kMinStepDelta = -15;
inline constexpr std::int32_t kMaxStepDelta = 240;

// 8.19.3 StepOfFrame( f ): step_of_depth is 1 to kMaxInterStep.
inline std::uint32_t changed_step(std::uint32_t step_of_depth, std::int32_t delta) {
  const std::int64_t step = std::int64_t{step_of_depth} * (16 + delta) >> 4;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(step, 1, kMaxInterStep));
}

// 6.14.2 frame_unit( ): the residuals of a frame.
struct InterFrame {
  std::uint32_t layer_groups = 0;  // number in the stream; residuals of others are zero
  // Frame that this one equals, with the same layer groups; the members below are then empty.
  std::optional<std::uint32_t> repeated;
  // Frame that replaces the references of the pattern.
  std::optional<std::uint32_t> reference;
  std::int32_t step_delta = 0;
  std::optional<FrameCrc> frame_crc;
  FramePatches patches;
  CompactResiduals residual;       // [num_vertices][3]; empty: all are zero
  Vector<std::uint16_t> expected;  // [num_vertices]: FrameExpected, 1/16 step
  // [num_vertices] in a first frame with its own order and with counterparts; otherwise empty.
  Vector<Counterpart> counterparts;

  bool operator==(const InterFrame&) const = default;
};

struct InterSettings {
  FramePattern pattern;
  bool exact_flag = false;                      // positions are sums of whole grid units
  std::uint32_t first_step = kExactInterStep;   // of the first frame
  Vector<std::uint32_t> step{kExactInterStep};  // [num_depths], of other frames
  bool learning_flag = false;
  WeightSettings weights;  // without adaptive factors
  int prime_log2 = 0;
  bool frame_hash_flag = false;
  std::uint32_t max_earlier_distance = 0;  // bound of repeated and reference, in coding order
  Vector<std::uint32_t> layer_group_size{1};  // [num_layer_groups] layers
  Vector<std::uint8_t> layer_step;            // [num_layers], 1 to kMaxLayerStep
  RestSettings rest;                          // settings of the first frame
  bool step_delta_flag = false;
  std::uint32_t num_patches = 0;
  PatchOfVertex patch_of_vertex;  // [num_vertices]; empty without patches

  bool operator==(const InterSettings&) const = default;
};

// Inter GOF. Copies share the frames.
struct InterGof : GofHeader, InterSettings {
  std::shared_ptr<const Vector<InterFrame>> frames;  // [num_frames]; set once parsed

  FrameCrcs frame_crcs() const {
    FrameCrcs crcs;
    if (!frame_hash_flag) return crcs;
    for (const InterFrame& frame : *frames) crcs.push_back(frame.frame_crc);
    return crcs;
  }
  bool operator==(const InterGof& other) const {
    return static_cast<const GofHeader&>(*this) == other &&
           static_cast<const InterSettings&>(*this) == other && *frames == *other.frames;
  }
};

}  // namespace rlpc
