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

// The shortest decimal text that reads back as the same number.
void append_number(std::string& text, float value);
void append_number(std::string& text, std::uint64_t value);
// The same of a number rounded to four decimals.
void append_rounded(std::string& text, float value);
// The shortest number whose distance from 1 is `value`, as readers of OBJ files compute it in
// floats: "0.1" for 0.9F, where 1.0F - 0.9F has nine digits.
void append_flipped(std::string& text, float value);
// Seven digits, as many as every float has: for colours, which are not linear in files.
void append_precise(std::string& text, double value);
// "30000/1001", for the comment in which rlpcenc finds the frame rate.
std::string frame_rate_text(FrameRate frame_rate);

// Those attributes that mesh files can hold, in their conventions; null: none.
struct MeshAttributes {
  explicit MeshAttributes(const SinkOptions& options);

  const AttributeSet* uv = nullptr;
  const AttributeSet* normal = nullptr;
  const AttributeSet* colour = nullptr;
  const AttributeSet* material = nullptr;
  const AttributeSet* part = nullptr;

  // [value of uv][2], v pointing up
  std::vector<float> uv_numbers() const;
  // [value of colour][number_components()], sRGB, 0 to 1
  std::vector<float> colour_numbers() const;
  // Whether the numbers of these sets are those of the input, so that files have all digits.
  bool has_exact_colours() const;
  bool has_exact_normals() const;
};

// The texture coordinates of a set uv0, uv1, ...; null: there are none.
const AttributeSet* find_uv(const SinkOptions& options, std::uint32_t set);

// The normals of each frame, if the stream has any.
class MeshNormals {
 public:
  // Keeps references to both.
  MeshNormals(const MeshAttributes& attributes, const SinkOptions& options);

  bool exist() const { return normals_.has_value(); }
  // [normal][3]; xyz: the vertices of the frame.
  std::span<const float> of(std::span<const float> xyz);
  std::uint32_t of_corner(std::size_t corner) const { return normals_->of_corner(corner); }

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

  // The whole file of one frame, valid until the next call.
  virtual const std::string& frame(std::span<const std::int32_t> positions) = 0;
  // Whether files hold the values of a set of options.attributes.
  virtual bool holds(const AttributeSet& set) const = 0;
};

// kObj, or kPly as options.ascii says; options must outlive it. materials: the name of the .mtl
// file beside OBJ files, empty if there is none.
std::unique_ptr<MeshBytes> make_mesh_bytes(SinkFormat format, const SinkOptions& options,
                                           const std::string& materials);

// A line that names the sets that files of this format do not hold, if there are any; see
// FrameSink::remarks().
std::vector<std::string> left_out_remark(SinkFormat format, const SinkOptions& options,
                                         const MeshBytes& mesh);

}  // namespace rlpc
