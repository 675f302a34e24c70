// Reads frames of a fixed size from a pipe.
#pragma once

#include <cstdint>
#include <cstdio>
#include <span>
#include <string>
#include <utility>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

class PipedFrames {
 public:
  // The file is not owned. name: for messages.
  PipedFrames(std::FILE* file, std::string name) : file_(file), name_(std::move(name)) {}

  // Reads a frame. Returns false at the end. Errors: see FrameStream::next_frame().
  InputResult<bool> read(std::span<char> frame) {
    const std::size_t got = std::fread(frame.data(), 1, frame.size(), file_);
    if (std::ferror(file_) != 0) return InputError{name_ + ": reading it failed"};
    if (got == 0) return false;
    if (got < frame.size()) {
      return InputError{name_ + ": ends within frame " + std::to_string(num_frames_) +
                        " (from 0), after " + std::to_string(got) + " of its " +
                        std::to_string(frame.size()) + " bytes"};
    }
    ++num_frames_;
    return true;
  }

 private:
  std::FILE* file_;
  std::string name_;
  std::uint32_t num_frames_ = 0;  // number of frames read
};

}  // namespace rlpc
