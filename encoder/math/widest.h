// For loops over independent outputs, which any width of vectors sums in the same order.
#pragma once

// Compiled for wider vectors, too; the machine takes what it has. Functions must be noexcept:
// g++ takes it for granted that no call of such a function throws.
#if defined(__x86_64__) && defined(__linux__)
#define RLPC_WIDEST __attribute__((target_clones("avx2", "default")))
#else
#define RLPC_WIDEST
#endif
