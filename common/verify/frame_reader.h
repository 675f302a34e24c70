// Decodes a stream while it is being written: what an encoder verifies its work by.
//
// An encoder cannot tell by its own reconstruction whether it has kept its promises. So it
// decodes what it has written, by the decoder that its users have. encoder/ and decoder/ do not
// include each other: the encoder calls these functions, decoder/verify/ implements them, and
// they meet when a program is linked.
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

  // Decodes the next frame into positions [num_vertices][3], in grid units and in the order in
  // which decoders output vertices. To be called only for frames whose GOF is in the buffer
  // whole; in an open-ended stream, for frames of an inter GOF whose units are. The first
  // call decodes attributes and asset, too. Returns what is wrong with the stream.
  virtual std::optional<std::string> next_frame(std::span<std::int32_t> positions) = 0;
  // After the last frame, once the whole stream is in the buffer: checks its end. Returns what
  // is wrong with the stream.
  virtual std::optional<std::string> finish() = 0;
};

// stream: may grow between calls. threads: as of DecoderOptions. An error in what comes before
// the first frame is returned by the first call of next_frame().
std::unique_ptr<FrameReader> read_frames(std::shared_ptr<StreamBuffer> stream,
                                         std::uint32_t threads);

}  // namespace rlpc
