// Decodes a stream while it is being written, so that the encoder can verify it.
//
// The encoder's own reconstruction cannot prove that it kept its promises, so it decodes what
// it has written with the decoder of its users. encoder/ and decoder/ do not include each
// other: the encoder calls these functions, decoder/verify/ implements them, and the linker
// connects them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/verify/stream_buffer.h"

namespace rlpc {

class FrameReader {
 public:
  FrameReader() = default;
  FrameReader(const FrameReader&) = delete;
  FrameReader& operator=(const FrameReader&) = delete;
  virtual ~FrameReader() = default;

  // Decodes the next frame into positions [num_vertices][3], grid units, in output order. May
  // be called only for frames whose GOF is in the buffer whole or, in an inter GOF of an
  // open-ended stream, whose units are. The first call also decodes attributes and asset.
  // Returns the error of the stream, if any.
  virtual std::optional<std::string> next_frame(std::span<std::int32_t> positions) = 0;
  // Checks the end of the stream, after the last frame, once the whole stream is in the buffer.
  // Returns the error of the stream, if any.
  virtual std::optional<std::string> finish() = 0;
};

// Makes a reader. stream: may grow between calls. threads: see DecoderOptions. The first call
// of next_frame() returns errors of everything before the first frame.
std::unique_ptr<FrameReader> read_frames(std::shared_ptr<StreamBuffer> stream,
                                         std::uint32_t threads);

}  // namespace rlpc
