#include "decoder/codec/parse/sequence/parse_metadata.h"

#include <utility>

#include "common/codec/syntax/sequence_header.h"
#include "common/memory/owned.h"
#include "decoder/codec/parse/sequence/inflate.h"

namespace rlpc {

// 6.10 metadata( )
Result<String> parse_metadata(BitReader& r, const MemoryLimit& memory) {
  const std::uint64_t at = r.bit_pos();
  const std::uint32_t size =
      r.u(32, "metadata_size", {0, std::int64_t{kMaxMetadataBytes}}, "R-MET-01");
  if (r.error()) return *r.error();
  const auto deflated = r.remaining_bytes();
  const std::uint64_t needed = memory.bytes_in_use + deflated.size() + size;
  if (needed > memory.max_bytes) {
    r.fail(Errc::kLimitExceeded, "", "metadata_size", at, needed);
    return *r.error();
  }
  auto json = inflate_exactly(deflated, size);
  if (!json) {
    r.fail(Errc::kInvalid, "R-MET-02", "metadata_json", r.bit_pos());
    return *r.error();
  }
  return std::move(*json);
}

}  // namespace rlpc
