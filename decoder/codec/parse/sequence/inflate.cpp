#include "decoder/codec/parse/sequence/inflate.h"

#include <zlib.h>

#include "common/memory/owned.h"

namespace rlpc {

std::optional<String> inflate_exactly(std::span<const std::uint8_t> deflated,
                                      std::uint32_t size) {
  String bytes(std::size_t{size} + 1, '\0');  // one byte more, to detect excess
  uLongf inflated = static_cast<uLongf>(bytes.size());
  uLong used = static_cast<uLong>(deflated.size());
  const int status =
      uncompress2(reinterpret_cast<Bytef*>(bytes.data()), &inflated, deflated.data(), &used);
  if (status != Z_OK || inflated != size || used != deflated.size()) return std::nullopt;
  bytes.resize(size);
  return bytes;
}

}  // namespace rlpc
