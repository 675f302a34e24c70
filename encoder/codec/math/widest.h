// RLPC_WIDEST compiles a function for several SIMD widths. Only for loops over independent
// outputs, whose sums have the same order at every width.
#pragma once

// The choice between versions would run before the thread sanitizer is initialised.
#ifdef __SANITIZE_THREAD__  // g++
#define RLPC_NO_CHOICE
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RLPC_NO_CHOICE
#endif
#endif

// Also compiles the function for AVX2; the version is chosen at load time. Functions must be
// noexcept, because g++ assumes that calls of such functions do not throw.
#if defined(__x86_64__) && defined(__linux__) && !defined(RLPC_NO_CHOICE)
#define RLPC_WIDEST __attribute__((target_clones("avx2", "default")))
#else
#define RLPC_WIDEST
#endif
