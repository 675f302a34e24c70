// 6.5 gof( ): the beginning of every kind of GOF.
#pragma once

#include <cstdint>

namespace rlpc {

// 7.5: gof_kind
enum class GofKind : std::uint8_t {
  kClusters,  // 6.5: clusters in local coordinate frames
  kSkinned,   // 6.11: bones, and trajectories for the residual
  kTracks,    // 6.13.1: the same, with the vertices of a skinned model
};

// The adjective of a kind, for messages: "a cluster GOF".
constexpr const char* kind_name(GofKind kind) {
  return kind == GofKind::kClusters ? "cluster" : "skinned";
}

// 6.12: whether slice units may follow the GOF unit.
constexpr bool has_slices(GofKind kind) { return kind != GofKind::kClusters; }

struct GofHeader {
  GofKind kind = GofKind::kClusters;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;

  bool operator==(const GofHeader&) const = default;
};

}  // namespace rlpc
