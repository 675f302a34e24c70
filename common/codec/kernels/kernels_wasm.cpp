#include "common/codec/kernels/kernels_wasm.h"

#ifdef RLPC_HAVE_WASM_KERNELS

#include <wasm_simd128.h>

namespace rlpc {
namespace {

// Sums for kRows rows and two vectors of values, held in registers.
template <std::size_t kRows>
void sum_block(const FactorPairs& factors, std::size_t first_row, std::size_t i,
               std::int32_t* sums) {
  v128_t sum[kRows][2];
  for (auto& row : sum) row[0] = row[1] = wasm_i32x4_splat(0);
  const std::int16_t* s = factors.spatial + 2 * i;
  const std::int16_t* t = factors.temporal + 2 * first_row;
  for (std::size_t k = 0; k < factors.num_pairs; ++k) {
    const v128_t s0 = wasm_v128_load(s);
    const v128_t s1 = wasm_v128_load(s + 8);
    for (std::size_t r = 0; r < kRows; ++r) {
      const v128_t w = wasm_v128_load32_splat(t + 2 * r);
      sum[r][0] = wasm_i32x4_add(sum[r][0], wasm_i32x4_dot_i16x8(w, s0));
      sum[r][1] = wasm_i32x4_add(sum[r][1], wasm_i32x4_dot_i16x8(w, s1));
    }
    s += 2 * kTileValues;
    t += 2 * factors.temporal_rows;
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    wasm_v128_store(sums + kTileValues * r + i, sum[r][0]);
    wasm_v128_store(sums + kTileValues * r + i + 4, sum[r][1]);
  }
}

template <std::size_t kRows>
void sum_rows(const FactorPairs& factors, std::size_t first_row, std::int32_t* sums) {
  for (std::size_t i = 0; i < kTileValues; i += 8)
    sum_block<kRows>(factors, first_row, i, sums);
}

}  // namespace

void sum_products_wasm(const FactorPairs& factors, std::size_t first_row, std::size_t num_rows,
                       std::int32_t* sums) {
  std::size_t r = 0;
  for (; r + 4 <= num_rows; r += 4) sum_rows<4>(factors, first_row + r, sums + kTileValues * r);
  for (; r < num_rows; ++r) sum_rows<1>(factors, first_row + r, sums + kTileValues * r);
}

}  // namespace rlpc

#endif
