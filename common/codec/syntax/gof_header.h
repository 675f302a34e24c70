// 6.5 gof( ): beginning of every kind of GOF.
#pragma once

#include <cstdint>
#include <optional>

#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/stream_format.h"

namespace rlpc {

// 7.5: gof_kind
enum class GofKind : std::uint8_t {
  kCluster,    // 6.5: clusters in local coordinate frames
  kSkinned,    // 6.11: bones, and trajectories for the residual
  kSharedRig,  // 6.13.1: bones and trajectories with the vertices of a shared rig
  kInter,      // 6.14: frames predicted from frames
};

// Returns the name of a kind, for messages: "a cluster GOF".
constexpr const char* kind_name(GofKind kind) {
  if (kind == GofKind::kInter) return "inter";
  return kind == GofKind::kCluster ? "cluster" : "skinned";
}

// Table 7-1: returns the type of the units that may follow the GOF unit in its access unit
// before its hash: slice units or frame units. None if no units may.
constexpr std::optional<UnitType> slice_type(GofKind kind) {
  if (kind == GofKind::kCluster) return std::nullopt;
  return kind == GofKind::kInter ? UnitType::kFrame : UnitType::kSlice;
}
constexpr bool has_slices(GofKind kind) { return slice_type(kind).has_value(); }
// 6.1 IsLive( ): returns whether frames of a GOF are output before it ends.
constexpr bool is_live(const SequenceHeader& header, GofKind kind) {
  return header.open_end_flag && kind == GofKind::kInter;
}

struct GofHeader {
  GofKind kind = GofKind::kCluster;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;

  bool operator==(const GofHeader&) const = default;
};

}  // namespace rlpc
