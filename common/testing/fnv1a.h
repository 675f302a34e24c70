// Digests of lists, for tests that compare with what the pseudo-code of a clause computes.
#pragma once

#include <cstdint>
#include <span>

namespace rlpc {

// FNV-1a over words of 32 bits.
class Fnv1a {
 public:
  void add(std::span<const std::uint32_t> words) {
    for (const std::uint32_t x : words) hash_ = (hash_ ^ x) * 16777619U;
  }
  std::uint32_t hash() const { return hash_; }

 private:
  std::uint32_t hash_ = 2166136261U;
};

}  // namespace rlpc
