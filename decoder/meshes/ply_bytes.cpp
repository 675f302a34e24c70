#include "decoder/meshes/ply_bytes.h"

#include <cmath>
#include <utility>

#include "common/files/binary_numbers.h"
#include "common/files/float_position.h"

namespace rlpc {

PlyBytes::PlyBytes(const SinkOptions& options)
    : options_(options), attributes_(options), normals_(attributes_, options) {
  split();
  append_header();
  append_faces();
}

void PlyBytes::split() {
  std::vector<const AttributeSet*> sets;
  for (const AttributeSet* const set :
       {attributes_.uv, attributes_.normal, attributes_.colour}) {
    if (set != nullptr) sets.push_back(set);
  }
  vertices_ = split_vertices(options_.triangles, options_.num_vertices, sets);
  auto next = vertices_.value_of_vertex.begin();
  if (attributes_.uv != nullptr) uv_ = {attributes_.uv_numbers(), 2, std::move(*next++)};
  if (attributes_.normal != nullptr) normal_of_vertex_ = std::move(*next++);
  if (attributes_.colour != nullptr) {
    colours_ = {attributes_.colour_numbers(), number_components(attributes_.colour->header),
                std::move(*next++)};
  }
}

void PlyBytes::append_header() {
  header_ = std::string("ply\nformat ") + (options_.ascii ? "ascii" : "binary_little_endian") +
            " 1.0\ncomment frame_rate " + frame_rate_text(options_.frame_rate) +
            "\nelement vertex " + std::to_string(vertices_.num_vertices()) +
            "\nproperty float x\nproperty float y\nproperty float z\n";
  if (normals_.exist()) header_ += "property float nx\nproperty float ny\nproperty float nz\n";
  if (uv_.width > 0) header_ += "property float s\nproperty float t\n";
  if (colours_.width > 0) {
    header_ += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  }
  if (colours_.width == 4) header_ += "property uchar alpha\n";
  header_ += "element face " + std::to_string(vertices_.triangles.size()) +
             "\nproperty list uchar uint vertex_indices\nend_header\n";
}

void PlyBytes::append_faces() {
  for (const Triangle& t : vertices_.triangles) {
    faces_ += options_.ascii ? '3' : '\3';
    for (const std::uint32_t v : t) {
      if (options_.ascii) {
        faces_ += ' ';
        append_number(faces_, std::uint64_t{v});
      } else {
        append_u32(faces_, v);
      }
    }
    if (options_.ascii) faces_ += '\n';
  }
}

bool PlyBytes::holds(const AttributeSet& set) const {
  return &set == attributes_.uv || &set == attributes_.normal || &set == attributes_.colour;
}

const std::string& PlyBytes::frame(std::span<const std::int32_t> positions) {
  bytes_ = header_;
  xyz_.resize(positions.size());
  for (std::size_t i = 0; i < positions.size(); ++i) {
    xyz_[i] = float_position(options_.grid, i % 3, positions[i]);
  }
  const auto normals = normals_.exist() ? normals_.of(xyz_) : std::span<const float>();
  for (std::uint32_t v = 0; v < vertices_.num_vertices(); ++v) append_vertex(v, normals);
  return bytes_ += faces_;
}

void PlyBytes::append_vertex(std::uint32_t vertex, std::span<const float> normals) {
  for (std::size_t c = 0; c < 3; ++c) {
    append(xyz_[3 * std::size_t{vertices_.stream_vertex[vertex]} + c]);
  }
  for (std::size_t c = 0; c < 3 && normals_.exist(); ++c) {
    append(normals[3 * std::size_t{normal_of_vertex_[vertex]} + c]);
  }
  for (std::size_t c = 0; c < uv_.width; ++c) {
    append(uv_.numbers[uv_.width * uv_.value_of_vertex[vertex] + c]);
  }
  for (std::size_t c = 0; c < colours_.width; ++c) {
    constexpr float kMax = 255.0F;
    const float x = colours_.numbers[colours_.width * colours_.value_of_vertex[vertex] + c];
    const auto byte = static_cast<std::uint8_t>(std::lround(x * kMax));
    if (options_.ascii) {
      append_number(bytes_, std::uint64_t{byte});
      bytes_ += ' ';
    } else {
      bytes_ += static_cast<char>(byte);
    }
  }
  if (options_.ascii) bytes_.back() = '\n';
}

// Appends a number; as text, with a blank, which becomes the line end after the last number.
void PlyBytes::append(float x) {
  if (!options_.ascii) return append_f32(bytes_, x);
  append_number(bytes_, x);
  bytes_ += ' ';
}

}  // namespace rlpc
