#include "decoder/c_api/decoder_handle.h"

#include <algorithm>
#include <array>
#include <string>

#include "decoder/describe_error.h"

namespace rlpc {
namespace {

template <class Index>
void write_indices(std::span<const Triangle> triangles, void* out) {
  auto* place = static_cast<unsigned char*>(out);
  for (const Triangle& t : triangles) {
    const std::array corners{static_cast<Index>(t[0]), static_cast<Index>(t[1]),
                             static_cast<Index>(t[2])};
    std::copy_n(reinterpret_cast<const unsigned char*>(corners.data()), sizeof corners, place);
    place += sizeof corners;
  }
}

}  // namespace

rlpc_status status_of(Errc code) {
  switch (code) {
    case Errc::kTruncated:
    case Errc::kInvalid:
      return RLPC_BAD_STREAM;
    case Errc::kUnsupported:
      return RLPC_UNSUPPORTED;
    case Errc::kLimitExceeded:
      return RLPC_LIMIT_EXCEEDED;
    case Errc::kIo:
      break;
  }
  return RLPC_IO_FAILED;
}

rlpc_status fail(rlpc_decoder& handle, const Error& error) {
  return handle.error.set(status_of(error.code), describe_error(error));
}

rlpc_status check_frame(rlpc_decoder& handle, std::uint32_t frame) {
  const std::uint32_t num_frames = handle.decoder->num_frames().value_or(0);
  if (frame < num_frames) return RLPC_OK;
  return handle.error.set(RLPC_BAD_ARGUMENT, "there is no frame " + std::to_string(frame) +
                                                 " of " + std::to_string(num_frames) +
                                                 " (from 0)");
}

bool check_buffer(rlpc_decoder& handle, const void* buffer, std::size_t num_values,
                  std::size_t wanted) {
  if (buffer != nullptr && num_values == wanted) return true;
  if (buffer == nullptr && num_values == 0 && wanted == 0) return true;
  handle.error.set(RLPC_BAD_ARGUMENT, buffer == nullptr
                                          ? "the buffer is null"
                                          : "the buffer has " + std::to_string(num_values) +
                                                " values, not " + std::to_string(wanted));
  return false;
}

rlpc_status give_indices(rlpc_decoder& handle, std::span<const Triangle> triangles,
                         std::uint32_t num_vertices, const IndexBuffer& buffer) {
  constexpr std::uint32_t kMax16BitVertices = 65536;
  const auto bad = [&](const std::string& what) {
    return handle.error.set(RLPC_BAD_ARGUMENT, what);
  };
  if (buffer.index_bytes != 2 && buffer.index_bytes != 4) {
    return bad("index_bytes: expected 2 or 4, got " + std::to_string(buffer.index_bytes));
  }
  if (buffer.index_bytes == 2 && num_vertices > kMax16BitVertices) {
    return bad("16 bits cannot hold the indices of more than 65536 vertices");
  }
  const std::size_t wanted = 3 * triangles.size() * buffer.index_bytes;
  if (buffer.indices == nullptr && wanted > 0) return bad("the buffer is null");
  if (buffer.num_bytes != wanted) {
    return bad("the buffer has " + std::to_string(buffer.num_bytes) + " bytes, not " +
               std::to_string(wanted));
  }
  if (buffer.index_bytes == 2) {
    write_indices<std::uint16_t>(triangles, buffer.indices);
  } else {
    write_indices<std::uint32_t>(triangles, buffer.indices);
  }
  return RLPC_OK;
}

}  // namespace rlpc
