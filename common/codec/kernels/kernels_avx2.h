// AVX2 twins of the plain loops of kernels.cpp.
#pragma once

#include "common/codec/kernels/kernels.h"

#if defined(__x86_64__) && defined(__GNUC__)
#define RLPC_HAVE_AVX2_KERNELS

namespace rlpc {

// Kernels for machines with AVX2 only.
extern const Kernels kKernelsAvx2;

}  // namespace rlpc

#endif
