// Formats frames as mesh files (OBJ, PLY).
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "decoder/meshes/frame_sink.h"
#include "decoder/surface/attribute_values.h"

namespace rlpc {

// Append the shortest decimal text that reads back as the same number.
void append_number(std::string& text, float value);
void append_number(std::string& text, std::uint64_t value);
// Appends the shortest decimal text of a number rounded to four decimals.
void append_rounded(std::string& text, float value);
// Appends the shortest number whose distance from 1 is `value`, as readers of OBJ files compute
// it in floats: "0.1" for 0.9F, where 1.0F - 0.9F has nine digits.
void append_flipped(std::string& text, float value);
// Appends seven digits, the precision of floats: for colours, which are not linear in files.
void append_precise(std::string& text, double value);
// Formats "30000/1001", for the comment in which rlpcenc finds the frame rate.
std::string frame_rate_text(FrameRate frame_rate);

// Attributes that mesh files can hold, in their conventions; null: none.
struct MeshAttributes {
  explicit MeshAttributes(const SinkOptions& options);

  const AttributeSet* uv = nullptr;
  const AttributeSet* normal = nullptr;
  const AttributeSet* colour = nullptr;
  const AttributeSet* material = nullptr;
  const AttributeSet* part = nullptr;

  // Returns [value of uv][2], v pointing up.
  std::vector<float> uv_numbers() const;
  // Returns [value of colour][number_components()], sRGB, 0 to 1.
  std::vector<float> colour_numbers() const;
  // Return whether the stream has the exact numbers of the input, so that files need all
  // digits.
  bool has_exact_colours() const;
  bool has_exact_normals() const;
};

// Returns the set uv0, uv1, ... with a number; null if there is none.
const AttributeSet* find_uv(const SinkOptions& options, std::uint32_t set);

// Normals of each frame, if the stream has any.
class MeshNormals {
 public:
  // Attributes and options must outlive it.
  MeshNormals(const MeshAttributes& attributes, const SinkOptions& options);

  bool exist() const { return normals_.has_value(); }
  // Returns [normal][3]. xyz: vertices of the frame.
  std::span<const float> of(std::span<const float> xyz);
  std::uint32_t normal_of_corner(std::size_t corner) const {
    return normals_->normal_of_corner(corner);
  }

 private:
  std::optional<FrameNormals> normals_;
  std::vector<float> numbers_;
};

class MeshBytes {
 public:
  MeshBytes() = default;
  MeshBytes(const MeshBytes&) = delete;
  MeshBytes& operator=(const MeshBytes&) = delete;
  virtual ~MeshBytes() = default;

  // Returns the whole file of one frame, valid until the next call.
  virtual const std::string& frame(std::span<const std::int32_t> positions) = 0;
  // Returns whether files hold the values of a set of options.attributes.
  virtual bool holds(const AttributeSet& set) const = 0;
};

// Makes a formatter of kObj, or kPly (options.ascii); options must outlive it. materials: name
// of the .mtl file next to OBJ files, empty if there is none.
std::unique_ptr<MeshBytes> make_mesh_bytes(SinkFormat format, const SinkOptions& options,
                                           const std::string& materials);

// Returns a remark that names the sets that files of this format do not hold, if any; see
// FrameSink::remarks().
std::vector<std::string> left_out_remark(SinkFormat format, const SinkOptions& options,
                                         const MeshBytes& mesh);

}  // namespace rlpc
