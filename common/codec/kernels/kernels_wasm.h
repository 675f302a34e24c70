// WebAssembly SIMD twin of the plain loop that dominates decoding time (kernels.cpp).
#pragma once

#include "common/codec/kernels/kernels.h"

#ifdef __wasm_simd128__
#define RLPC_HAVE_WASM_KERNELS

namespace rlpc {

// Kernels::sum_products, for WebAssembly with 128-bit SIMD.
void sum_products_wasm(const FactorPairs& factors, std::size_t first_row, std::size_t num_rows,
                       std::int32_t* sums);

}  // namespace rlpc

#endif
