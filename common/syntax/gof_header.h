// 6.5 gof( ): the beginning of every kind of GOF.
#pragma once

#include <cstdint>

namespace rlpc {

enum class GofKind : std::uint8_t {
  kClusters,  // 6.5: clusters in local coordinate frames
  kSkinned,   // 6.11: bones, and trajectories for the residual
};

// The main elements of a kind, for messages: "clusters", "bones".
constexpr const char* kind_name(GofKind kind) {
  return kind == GofKind::kSkinned ? "skinned" : "cluster";
}

// 6.12: whether slice units may follow the GOF unit.
constexpr bool has_slices(GofKind kind) { return kind == GofKind::kSkinned; }

struct GofHeader {
  GofKind kind = GofKind::kClusters;
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 1;

  bool operator==(const GofHeader&) const = default;
};

}  // namespace rlpc
