// Parsed GOF of a stream: the GOF unit, its slice or frame units, and its hash. Made by
// AccessUnitParser (decoder/codec/units), inspected by all programs, decoded by make_recon()
// (decoder/codec/gofs/make_recon.h).
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "common/codec/kinds/cluster/cluster_gof.h"
#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/kinds/skinned/skinned_gof.h"
#include "common/codec/syntax/gof_hash.h"
#include "common/codec/syntax/gof_header.h"
#include "common/memory/owned.h"

namespace rlpc {

// GOF of any kind.
using AnyGof = std::variant<ClusterGof, SkinnedGof, InterGof>;

// 6.12 slice_unit( ), 6.14.2 frame_unit( )
struct SliceEntry {
  std::uint32_t component_group_idx = 0;
  std::uint32_t layer_group_idx = 0;
  std::uint32_t num_trajectories = 0;  // trajectories whose temporal values it contains
  std::uint64_t bytes = 0;             // size of the unit
  std::uint32_t temporal_layer_idx = 0;
  std::uint32_t frame_idx = 0;   // first frame of a frame unit
  std::uint32_t num_frames = 1;  // frames of a frame unit
  bool is_gof_end = false;       // the GOF ends before that frame; the unit has no residuals
};

struct AccessUnit {
  AnyGof gof;
  Vector<SliceEntry> slices;    // in the order of the stream
  std::optional<GofHash> hash;  // none: no hash unit, or not requested
  std::uint64_t gof_bytes = 0;  // size of the GOF unit
  // Slices were dropped on request (SliceCut): they are not among `slices`, and the hash does
  // not match the remaining positions.
  bool is_cut = false;

  // Returns the hashes in the units of the GOF; empty in kinds that have none there.
  FrameCrcs frame_crcs() const {
    const auto crcs_of = [](const auto& g) -> FrameCrcs {
      if constexpr (requires { g.frame_crcs(); }) return g.frame_crcs();
      return {};
    };
    return std::visit(crcs_of, gof);
  }
  const GofHeader& header() const {
    return std::visit([](const auto& g) -> const GofHeader& { return g; }, gof);
  }
};

}  // namespace rlpc
