// 6.5 gof( ): beginning of every kind of GOF.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/stream_format.h"

namespace rlpc {

// 7.5: gof_kind
enum class GofKind : std::uint8_t {
  kCluster,    // 6.5: clusters in local coordinate frames
  kSkinned,    // 6.11: bones, and trajectories for the residual
  kSharedRig,  // 6.13.1: motion of bones and trajectories; the rest is in a shared rig
  kInter,      // 6.14: frames predicted from frames
};

// Properties of a kind that hold for each of its GOFs.
struct KindProperties {
  GofKind kind = GofKind::kCluster;
  const char* name = "";          // in messages: "a cluster GOF"
  bool has_rig = false;           // its per-vertex data are those of a shared rig
  std::uint32_t profile_idc = 0;  // the lowest profile with this kind
  // Table 7-1: type of the units that may follow the GOF unit in its access unit before its
  // hash. None if no units may.
  std::optional<UnitType> slice_type = {};
  bool is_live = false;  // frames of an open-ended stream are output before their GOF ends
};

inline constexpr std::array<KindProperties, 4> kGofKinds{{
    {GofKind::kCluster, "cluster", false, kProfileBaseline, std::nullopt, false},
    {GofKind::kSkinned, "skinned", false, kProfileMain, UnitType::kSlice, false},
    {GofKind::kSharedRig, "skinned", true, kProfileHigh, UnitType::kSlice, false},
    {GofKind::kInter, "inter", false, kProfileHigh, UnitType::kFrame, true},
}};

constexpr const KindProperties& properties_of(GofKind kind) {
  return kGofKinds[static_cast<std::size_t>(kind)];
}
static_assert(std::all_of(kGofKinds.begin(), kGofKinds.end(), [](const KindProperties& k) {
  return properties_of(k.kind).kind == k.kind;
}));

// Returns the name of a kind, for messages: "a cluster GOF".
constexpr const char* kind_name(GofKind kind) { return properties_of(kind).name; }
// Returns the type of the units that may follow a GOF unit: slice units or frame units.
constexpr std::optional<UnitType> slice_type(GofKind kind) {
  return properties_of(kind).slice_type;
}
constexpr bool has_slices(GofKind kind) { return slice_type(kind).has_value(); }
// 6.1 IsLive( ): returns whether frames of a GOF are output before it ends.
constexpr bool is_live(const SequenceHeader& header, GofKind kind) {
  return header.open_end_flag && properties_of(kind).is_live;
}

struct GofHeader {
  GofKind kind = GofKind::kCluster;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;

  bool operator==(const GofHeader&) const = default;
};

}  // namespace rlpc
