// Twin of the plain loop that takes most of the time of decoding (kernels.cpp).
#pragma once

#include "common/kernels/kernels.h"

#ifdef __wasm_simd128__
#define RLPC_HAVE_WASM_KERNELS

namespace rlpc {

// Kernels::sum_products, for WebAssembly with vectors of 128 bits.
void sum_products_wasm(const FactorPairs& factors, std::size_t first_row, std::size_t num_rows,
                       std::int32_t* sums);

}  // namespace rlpc

#endif
