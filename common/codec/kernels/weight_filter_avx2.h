// Twins of the plain loops of weight_filter.cpp.
#pragma once

#include "common/codec/kernels/kernels_avx2.h"
#include "common/codec/kernels/weight_filter.h"

#ifdef RLPC_HAVE_AVX2_KERNELS

namespace rlpc {

// Kernels for machines with AVX2 only.
std::int64_t predict_offset_avx2(const FilterState& filter, const std::int32_t* offsets);
void adapt_avx2(const FilterState& filter, const std::int32_t* offsets, std::int64_t error);
void adapt_to_frame_avx2(const FilterState& filter, const std::int32_t* offsets,
                         std::int64_t error, std::int64_t variance);

}  // namespace rlpc

#endif
