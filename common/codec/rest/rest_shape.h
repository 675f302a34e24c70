// 6.12.4, 8.18: positions of all vertices in an order of their own, as coded.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rlpc {

inline constexpr int kRestWeightBits = 6;       // of rest_edge_weight and rest_ring_weight
inline constexpr std::size_t kRestFactors = 3;  // of a vertex: the coordinates

// 6.11 rest_order( ): how rest positions are coded in the High profile, or the first frame of
// an inter GOF.
struct RestSettings {
  bool exact_flag = false;  // RestExact
  bool order_flag = false;  // in an order of their own; the others are of this order
  int edge_weight = 0;      // sixteenths
  int ring_weight = 0;      // sixteenths
  bool axes_flag = false;
  bool counterparts_flag = false;

  bool operator==(const RestSettings&) const = default;
};

// 6.12.4: the counterpart of a vertex, as coded.
struct Counterpart {
  bool flag = false;      // counterpart_flag: the inherited one
  bool new_flag = false;  // new_counterpart_flag: that of the elements below
  bool mirrored = false;
  std::uint8_t hinge = 0;
  std::uint32_t idx = 0;

  bool operator==(const Counterpart&) const = default;
};

// Width of rest positions, including 4 fractional bits.
constexpr int rest_bits(int position_bits) { return position_bits + 5; }

}  // namespace rlpc
