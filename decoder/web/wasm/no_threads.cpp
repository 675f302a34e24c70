// Replaces decoder/codec/gofs/prefetch.cpp and async.cpp: WebAssembly has a single thread here,
// and nothing is prefetched.
#include "decoder/codec/gofs/prefetch.h"

namespace rlpc {

void Prefetch::fill(std::uint64_t /*offset*/, std::uint32_t /*first_frame*/,
                    std::size_t /*count*/) {}

void Prefetch::ask(const GofPlace& /*place*/, std::uint32_t /*frame*/) {}

bool Prefetch::has_asked(std::uint32_t /*frame*/) const { return false; }

void Prefetch::hand_over_rigs() {}

std::optional<Prefetch::Found> Prefetch::take(std::uint64_t /*offset*/,
                                              std::uint32_t /*first_frame*/) {
  return std::nullopt;
}

void Prefetch::clear() {}

}  // namespace rlpc
