#include "decoder/c_api/decoder_handle.h"

#include <string>

#include "decoder/describe_error.h"

namespace rlpc {

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

}  // namespace rlpc
