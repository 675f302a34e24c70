// Formats one frame as a mesh file (OBJ, PLY).
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "decoder/output/frame_sink.h"

namespace rlpc {

// The shortest decimal text that reads back as the same number.
void append_number(std::string& text, float value);
void append_number(std::string& text, std::uint64_t value);
// "30000/1001", for the comment in which rlpcenc finds the frame rate.
std::string frame_rate_text(FrameRate frame_rate);

class MeshBytes {
 public:
  // OBJ, or PLY as options.ascii says.
  MeshBytes(SinkFormat format, const SinkOptions& options);

  // The whole file of one frame, valid until the next call.
  const std::string& frame(std::span<const std::int32_t> positions);

 private:
  void append_header(const SinkOptions& options);
  void append_faces(const SinkOptions& options);

  SinkFormat format_;
  bool ascii_;
  Grid grid_;
  std::string header_;
  std::string faces_;
  std::string bytes_;
};

}  // namespace rlpc
