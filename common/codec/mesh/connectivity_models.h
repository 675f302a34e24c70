// Models and contexts of the connectivity unit (clause 8.7.7). The parser and the writer drive
// them in the same way.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "common/codec/bits/bit_model.h"
#include "common/codec/mesh/cut_border.h"

namespace rlpc {

// Largest join prefix. Join distances are at most 2^(kMaxJoinPrefix + 1) - 1, which bounds the
// time of a join.
inline constexpr int kMaxJoinPrefix = 9;
inline constexpr std::uint32_t kMaxJoinDistance = (1U << (kMaxJoinPrefix + 1)) - 1;

struct ConnectivityModels {
  BitModel vertex_reused_flag;
  std::array<BitModel, 16> boundary_flag;
  std::array<BitModel, 4> close_flag;
  std::array<BitModel, 105> new_vertex_flag;
  std::array<BitModel, 150> glue_previous_flag;
  std::array<BitModel, 6> glue_next_flag;
  BitModel far_join_flag;
  BitModel forward_join_flag;
  std::array<std::array<BitModel, kMaxJoinPrefix>, 2>
      join_prefix_flag;                                   // [forward_join_flag][i]
  std::array<BitModel, kMaxJoinPrefix + 1> join_top_bit;  // [prefix]
};

// 8.7.7 SetContexts( ): indices into the arrays of the same names.
struct GateContexts {
  std::size_t boundary_flag = 0;
  std::size_t close_flag = 0;
  std::size_t new_vertex_flag = 0;
  std::size_t glue_previous_flag = 0;
  std::size_t glue_next_flag = 0;
};

inline GateContexts gate_contexts(const CutBorder& border) {
  const std::uint32_t gate = border.gate();
  const std::uint32_t to = border.next(gate);
  const std::uint32_t before = border.previous(gate);
  const auto clipped_degree = [&](std::uint32_t node, std::uint32_t lo, std::uint32_t hi) {
    return std::size_t{std::clamp(border.degree(node), lo, hi) - lo};
  };
  const auto bit = [](bool b) { return b ? std::size_t{1} : std::size_t{0}; };
  GateContexts ctx;
  ctx.boundary_flag = bit(border.is_boundary(to)) + 2 * bit(border.is_boundary(before)) +
                      4 * clipped_degree(gate, 2, 3) + 8 * clipped_degree(to, 2, 3);
  ctx.close_flag = clipped_degree(gate, 2, 5);
  ctx.new_vertex_flag = clipped_degree(gate, 2, 8) + 7 * clipped_degree(to, 2, 6) +
                        35 * clipped_degree(before, 2, 4);
  ctx.glue_previous_flag = clipped_degree(gate, 2, 7) + 6 * clipped_degree(before, 2, 6) +
                           30 * clipped_degree(to, 2, 6);
  ctx.glue_next_flag = clipped_degree(to, 2, 7);
  return ctx;
}

}  // namespace rlpc
