#include "decoder/codec/parse/sequence/parse_asset.h"

#include <utility>

#include "common/memory/owned.h"
#include "decoder/codec/parse/sequence/inflate.h"

namespace rlpc {

// 6.16 asset( )
Result<String> parse_asset(BitReader& r, const MemoryLimit& memory) {
  constexpr std::uint32_t kGlb = 0;
  constexpr std::uint64_t kMaxInflation = 1032;  // largest ratio of deflate
  const std::uint32_t format = r.u(8, "asset_format");
  const std::uint64_t at = r.bit_pos();
  const std::uint32_t size = r.u(32, "asset_size");
  if (r.error()) return *r.error();
  const auto deflated = r.remaining_bytes();
  const std::uint64_t needed = memory.bytes_in_use + deflated.size() + size;
  if (needed > memory.max_bytes) {
    r.fail(Errc::kLimitExceeded, "", "asset_size", at, needed);
    return *r.error();
  }
  const bool is_possible = size <= kMaxInflation * (deflated.size() + 1);
  auto bytes = is_possible ? inflate_exactly(deflated, size) : std::nullopt;
  if (!bytes) {
    r.fail(Errc::kInvalid, "R-AST-01", "asset_size", at);
    return *r.error();
  }
  if (format != kGlb) return String();
  return std::move(*bytes);
}

}  // namespace rlpc
