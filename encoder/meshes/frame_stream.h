// Animations that are read while they are made: frames arrive one after the other from a pipe.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "encoder/meshes/frame_source.h"

namespace rlpc {

class FrameStream {
 public:
  struct Shape {
    std::string name;  // name of the input, for messages
    std::uint32_t num_vertices = 0;
    FrameRate frame_rate;
    std::vector<Triangle> triangles;  // every index below num_vertices; may be empty
    SourceAttributes attributes{};
    std::vector<std::string> notes{};  // see FrameSource::notes()
  };

  explicit FrameStream(Shape shape) : shape_(std::move(shape)) {}
  FrameStream(const FrameStream&) = delete;
  FrameStream& operator=(const FrameStream&) = delete;
  virtual ~FrameStream() = default;

  const Shape& shape() const { return shape_; }
  // Waits for the next frame, and for no more: 3 * num_vertices values, not checked. Returns
  // false after the last. Errors: the input cannot be read, or ends within the frame.
  virtual InputResult<bool> next_frame(std::span<float> xyz) = 0;
  // Returns the numbers of the input that the last frame was rounded from, in the same shape;
  // empty if the input has floats. Valid until the next frame.
  virtual std::span<const double> exact() const { return {}; }

 private:
  Shape shape_;
};

}  // namespace rlpc
