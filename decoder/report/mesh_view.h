// Interactive animation in a page, with the error in colour. Positions have 16 bits, errors 8.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/mesh/mesh.h"

namespace rlpc {

class MeshView {
 public:
  // Maximum bytes of triangles and frames in a page, before base64 (which takes 4/3).
  static constexpr std::size_t kMaxBytes = std::size_t{16} << 20;

  MeshView(std::uint32_t num_vertices, std::uint32_t num_frames,
           std::span<const Triangle> triangles, FrameRate frame_rate,
           std::size_t max_bytes = kMaxBytes);

  // Returns n if the page shows every n-th frame, to fit max_bytes; 0 if no frame fits.
  std::uint32_t stride() const { return stride_; }
  bool shows(std::uint32_t frame) const { return stride_ > 0 && frame % stride_ == 0; }
  // Adds the next frame that is shown. Both arguments: [num_vertices][3].
  void add_frame(std::span<const float> original, std::span<const float> decoded);

  // Describes omitted frames; empty if none are omitted.
  std::string note() const;
  // Returns HTML for a page with use_viewer(), after all frames. diagonal: unit of errors.
  std::string html(double diagonal) const;

 private:
  std::string frames_html(const std::vector<float>& values, const char* id,
                          const float (&low)[3], const double (&step)[3]) const;
  std::string errors_html(float largest) const;

  std::uint32_t num_vertices_;
  std::uint32_t num_frames_;
  std::vector<Triangle> triangles_;
  FrameRate frame_rate_;
  std::uint32_t stride_ = 0;
  std::vector<float> original_;  // [frame shown][num_vertices][3]
  std::vector<float> decoded_;
  std::vector<float> errors_;  // [frame shown][num_vertices] distances
};

}  // namespace rlpc
