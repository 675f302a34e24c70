// 6.12.4, 8.18: coded positions of all vertices in the rest order.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rlpc {

inline constexpr int kRestWeightBits = 6;       // rest_edge_weight and rest_ring_weight
inline constexpr std::size_t kRestFactors = 3;  // coordinates of a vertex

// 6.11 rest_order( ): settings for coding rest positions in the High profile, or the first
// frame of an inter GOF.
struct RestSettings {
  bool exact_flag = false;  // RestExact
  bool order_flag = false;  // coded in the rest order, to which the members below apply
  int edge_weight = 0;      // sixteenths
  int ring_weight = 0;      // sixteenths
  bool axes_flag = false;
  bool counterparts_flag = false;

  bool operator==(const RestSettings&) const = default;
};

// 6.12.4: coded counterpart of a vertex.
struct Counterpart {
  bool flag = false;      // counterpart_flag: the inherited counterpart
  bool new_flag = false;  // new_counterpart_flag: the counterpart given by the elements below
  bool mirrored = false;
  std::uint8_t hinge = 0;
  std::uint32_t idx = 0;

  bool operator==(const Counterpart&) const = default;
};

// Returns the width of rest positions, including 4 fractional bits.
constexpr int rest_bits(int position_bits) { return position_bits + 5; }

}  // namespace rlpc
