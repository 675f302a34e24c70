// 6.3 Sequence header, and limits of the levels of Annex B.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

// Each minor version adds a profile of the same number.
inline constexpr std::uint32_t kProfileBaseline = 0;
inline constexpr std::uint32_t kProfileMain = 1;
inline constexpr std::uint32_t kProfileHigh = 2;
// Table of B.1: [profile_idc].
inline constexpr std::array<const char*, 3> kProfileNames{"Baseline", "Main", "High"};

inline constexpr int kMinPositionBits = 2;
inline constexpr int kMaxPositionBits = 24;
inline constexpr std::int32_t kMinGridLog2Step = -150;
inline constexpr std::int32_t kMaxGridLog2Step = 120;
inline constexpr std::int32_t kMaxGridOrigin = 1 << 26;
inline constexpr std::uint32_t kMaxFrames = 1U << 24;  // per sequence, at every level

inline constexpr std::uint32_t kMaxMetadataBytes = 1U << 20;  // size of metadata_json

// Table B-1
struct Level {
  std::uint32_t max_vertices;
  std::uint32_t max_triangles;
  std::uint32_t max_gof_frames;
  std::uint32_t max_clusters;
  std::uint32_t max_components;         // per cluster, or trajectories
  std::uint64_t max_gof_values;         // vertices x frames per GOF
  std::uint64_t max_gof_factors;        // spatial and temporal values per GOF
  std::uint64_t max_unit_bytes;         // payload of a critical unit
  std::uint64_t max_adaptive_values;    // adaptive factors of a GOF or shared rig x vertices
  std::uint32_t max_learning_vertices;  // vertices of a mesh whose frames learn weights
};

consteval std::uint64_t pow2(int n) { return std::uint64_t{1} << n; }

inline constexpr auto kLevels = std::to_array<Level>({
    {1U << 14, 1U << 15, 512, 256, 512, pow2(22), pow2(23), pow2(25), pow2(21), 1U << 14},
    {1U << 17, 1U << 18, 1024, 512, 1024, pow2(25), pow2(26), pow2(28), pow2(24), 1U << 17},
    {1U << 20, 1U << 21, 4096, 1024, 1024, pow2(28), pow2(29), pow2(31), pow2(27), 1U << 19},
    {1U << 23, 1U << 24, 16384, 1024, 1024, pow2(31), pow2(32), pow2(32), pow2(30), 1U << 21},
});
inline constexpr std::uint32_t kMaxLevelIdc = static_cast<std::uint32_t>(kLevels.size());

// Members are named after the syntax elements; elements named _minus1 are stored as their
// values.
struct SequenceHeader {
  std::uint32_t profile_idc = kProfileBaseline;
  std::uint32_t level_idc = 1;
  std::uint32_t num_vertices = 1;
  std::uint32_t num_triangles = 0;
  bool open_end_flag = false;    // whether the number of frames is at the end of the stream
  std::uint32_t num_frames = 1;  // open-ended stream: kMaxFrames
  FrameRate frame_rate;
  Grid grid;
  int position_bits = 20;

  const Level& level() const { return kLevels[level_idc - 1]; }
  bool has_skinned_gofs() const { return profile_idc >= kProfileMain; }
  bool operator==(const SequenceHeader&) const = default;
};

}  // namespace rlpc
