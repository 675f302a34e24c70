#include "decoder/output/mesh_bytes.h"

#include <array>
#include <cassert>
#include <charconv>

#include "common/io/binary_numbers.h"
#include "common/io/float_position.h"
#include "common/io/output_file.h"

namespace rlpc {

namespace {

template <class Number>
void append_digits(std::string& text, Number value) {
  std::array<char, 64> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), result.ptr);
}

}  // namespace

void append_number(std::string& text, float value) { append_digits(text, value); }
void append_number(std::string& text, std::uint64_t value) { append_digits(text, value); }

std::string frame_rate_text(FrameRate frame_rate) {
  return std::to_string(frame_rate.numerator) + "/" + std::to_string(frame_rate.denominator);
}

MeshBytes::MeshBytes(SinkFormat format, const SinkOptions& options)
    : format_(format),
      ascii_(format == SinkFormat::kObj || options.ascii),
      grid_(options.grid) {
  assert(format == SinkFormat::kObj || format == SinkFormat::kPly);
  append_header(options);
  append_faces(options);
}

void MeshBytes::append_header(const SinkOptions& options) {
  const std::string rate = "frame_rate " + frame_rate_text(options.frame_rate) + "\n";
  if (format_ == SinkFormat::kObj) {
    header_ = "# " + rate;
    return;
  }
  header_ = std::string("ply\nformat ") + (ascii_ ? "ascii" : "binary_little_endian") +
            " 1.0\ncomment " + rate + "element vertex " + std::to_string(options.num_vertices) +
            "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
            std::to_string(options.triangles.size()) +
            "\nproperty list uchar uint vertex_indices\nend_header\n";
}

void MeshBytes::append_faces(const SinkOptions& options) {
  const bool obj = format_ == SinkFormat::kObj;
  for (const Triangle& t : options.triangles) {
    if (ascii_) {
      faces_ += obj ? "f" : "3";
    } else {
      faces_ += '\3';
    }
    for (const std::uint32_t v : t) {
      if (!ascii_) {
        append_u32(faces_, v);
        continue;
      }
      faces_ += ' ';
      append_number(faces_, std::uint64_t{v} + (obj ? 1 : 0));
    }
    if (ascii_) faces_ += '\n';
  }
}

const std::string& MeshBytes::frame(std::span<const std::int32_t> positions) {
  bytes_ = header_;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const float x = float_position(grid_, i % 3, positions[i]);
    if (!ascii_) {
      append_f32(bytes_, x);
      continue;
    }
    if (i % 3 > 0) {
      bytes_ += ' ';
    } else if (format_ == SinkFormat::kObj) {
      bytes_ += "v ";
    }
    append_number(bytes_, x);
    if (i % 3 == 2) bytes_ += '\n';
  }
  return bytes_ += faces_;
}

}  // namespace rlpc
