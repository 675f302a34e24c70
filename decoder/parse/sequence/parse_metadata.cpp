#include "decoder/parse/sequence/parse_metadata.h"

#include <zlib.h>

#include "common/owned.h"
#include "common/syntax/sequence_header.h"

namespace rlpc {

// 6.10 metadata( )
Result<String> parse_metadata(BitReader& r) {
  const std::uint32_t size =
      r.u(32, "metadata_size", {0, std::int64_t{kMaxMetadataBytes}}, "R-MET-01");
  if (r.error()) return *r.error();
  const auto deflated = r.remaining_bytes();
  String json(size + 1, '\0');  // one byte more, to detect excess
  uLongf inflated = size + 1;
  uLong used = static_cast<uLong>(deflated.size());
  const int status =
      uncompress2(reinterpret_cast<Bytef*>(json.data()), &inflated, deflated.data(), &used);
  if (status != Z_OK || inflated != size || used != deflated.size()) {
    r.fail(Errc::kInvalid, "R-MET-02", "metadata_json", r.bit_pos());
    return *r.error();
  }
  json.resize(size);
  return json;
}

}  // namespace rlpc
