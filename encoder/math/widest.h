// For loops over independent outputs, which any width of vectors sums in the same order.
#pragma once

// The choice is made before the thread sanitizer is ready for it.
#ifdef __SANITIZE_THREAD__  // of g++
#define RLPC_NO_CHOICE
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define RLPC_NO_CHOICE
#endif
#endif

// Compiled for wider vectors, too; the machine takes what it has. Functions must be noexcept:
// g++ takes it for granted that no call of such a function throws.
#if defined(__x86_64__) && defined(__linux__) && !defined(RLPC_NO_CHOICE)
#define RLPC_WIDEST __attribute__((target_clones("avx2", "default")))
#else
#define RLPC_WIDEST
#endif
