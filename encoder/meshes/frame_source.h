// The interface through which the encoder reads animations: fixed triangles, moving vertices.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "common/result.h"
#include "encoder/meshes/source_attribute.h"
#include "encoder/meshes/source_images.h"
#include "encoder/meshes/source_rig.h"

namespace rlpc {

// Error for the user, in one line: the file, the place in it (line, byte or frame), what was
// expected, and what to do.
struct InputError {
  std::string message;
  bool is_limit = false;  // the input may be valid but exceeds a limit of the caller
  bool is_fault = false;  // the encoder is wrong, not the input
};
template <class T>
using InputResult = Result<T, InputError>;

// Axes in terms of others: coordinate a of the new axes is coordinate from[a] of the old ones,
// negated if negative[a]. from is a permutation of 0, 1, 2.
struct Axes {
  std::array<std::uint8_t, 3> from{0, 1, 2};
  std::array<bool, 3> negative{};

  bool operator==(const Axes&) const = default;
};

// Random access to the frames; most sources hold at most one frame in memory. Not thread-safe.
class FrameSource {
 public:
  struct Shape {
    std::uint32_t num_vertices = 0;
    std::uint32_t num_frames = 0;
    FrameRate frame_rate;
    std::vector<Triangle> triangles;
    std::vector<std::string> notes{};
    std::vector<std::string> files{};
    std::vector<Clip> clips{};
    SourceAttributes attributes{};
    std::string asset{};
    SourceMaterials materials{};
    std::uint64_t memory_bytes = 0;
    std::optional<Axes> axes_of_mesh{};
    std::shared_ptr<const SourceRig> rig{};
  };

  FrameSource(const FrameSource&) = delete;
  FrameSource& operator=(const FrameSource&) = delete;
  virtual ~FrameSource() = default;

  std::uint32_t num_vertices() const { return shape_.num_vertices; }  // at least 1
  std::uint32_t num_frames() const { return shape_.num_frames; }      // at least 1
  FrameRate frame_rate() const { return shape_.frame_rate; }
  // Returns the triangles, with indices below num_vertices(). Empty for a point cloud.
  const std::vector<Triangle>& triangles() const { return shape_.triangles; }
  // Returns notes for the user, one line each, about dropped or merged data. Reading frames may
  // add some.
  const std::vector<std::string>& notes() const { return shape_.notes; }
  // Returns all files read, including those that the input refers to.
  const std::vector<std::string>& files() const { return shape_.files; }
  // Returns the parts of the sequence that the input names.
  const std::vector<Clip>& clips() const { return shape_.clips; }
  // Returns the axes to turn frames to, if the triangles are from a mesh with other axes.
  const std::optional<Axes>& axes_of_mesh() const { return shape_.axes_of_mesh; }
  const Shape& shape() const { return shape_; }

  // Returns texture coordinates, normals and other attributes of triangles().
  const SourceAttributes& attributes() const { return shape_.attributes; }
  // Returns materials, textures and names of parts: a GLB without geometry; empty: none.
  const std::string& asset() const { return shape_.asset; }
  const SourceMaterials& materials() const { return shape_.materials; }
  // Returns the bones that move the vertices; null if the input does not say.
  const std::shared_ptr<const SourceRig>& rig() const { return shape_.rig; }

  // Keeps at most `max` attributes: drops those with the highest numbers in their names, the
  // last of equal ones, and adds a note that names them.
  void limit_attributes(std::size_t max);

  // Returns the estimated memory held by the source.
  std::uint64_t memory_bytes() const { return shape_.memory_bytes; }

  // Reads the positions of one frame: xyz[3 * vertex + axis], 3 * num_vertices() values, in
  // units; all finite on success. frame < num_frames(), in any order.
  virtual std::optional<InputError> read_frame(std::uint32_t frame, std::span<float> xyz) = 0;
  // Reads the same frame as the numbers of the input, before they become floats; errors are
  // measured against them. By default, the floats.
  virtual std::optional<InputError> read_exact(std::uint32_t frame, std::span<double> xyz);
  // Whether read_exact() may differ from read_frame().
  virtual bool is_finer_than_floats() const { return false; }
  // Computes the maps of the bones of rig() in a frame, [bone].
  virtual void read_bones(std::uint32_t /*frame*/, std::span<BoneMap> /*maps*/) {}
  // Returns the name, for messages, of the file that holds a frame.
  virtual std::string file_of(std::uint32_t /*frame*/) const { return "input"; }

 protected:
  explicit FrameSource(Shape shape) : shape_(std::move(shape)) {}
  void set_axes_of_mesh(const std::optional<Axes>& axes) { shape_.axes_of_mesh = axes; }
  void drop_later_normals() { shape_.attributes.later_normals.clear(); }
  void add_note(std::string note) { shape_.notes.push_back(std::move(note)); }
  void set_note(std::size_t index, std::string note) { shape_.notes[index] = std::move(note); }

 private:
  Shape shape_;
};

// The default memory limit.
inline constexpr std::uint64_t kUsualEncoderBytes = std::uint64_t{1} << 35;

// Input to read.
//   path                points  meaning
//   mesh.obj                    one frame
//   mesh.obj            x.pc2   triangles from the mesh, positions from the point cache;
//                               also x.mdd
//   folder                      every .obj file in it
//   walk_*.obj                  the files that match (* ? [ ] in the file name)
//   walk_%04d.obj               the files with such a number, without gaps
//   walk_%g.obj                 the files with a number, also 1.25, -5 or 007
//   a.obj b.obj ...             these files: path, then more_paths
//   mesh.ply, mesh.off          as .obj, everywhere above; one format in a folder
//   x.rlpd                      decoder output (Annex A)
//   x.glb, x.gltf               the scene of a glTF 2.0 document, moved by its animations
//   -                           standard input: any of these files
// Frames are sorted by the number in which their names differ; see names/frame_names.h.
//
// Without a known extension, the format is detected from the contents.
//
// Frame rate: `frame_rate` if given; otherwise that of the .rlpd header, or of a comment "#
// frame_rate 30000/1001" in the (first) OBJ file ("comment frame_rate ..." in PLY), as rlpcdec
// writes it; otherwise that of the times of an MDD file; otherwise 30. The sample
// rate of a PC2 file is not a frame rate: it counts frames per sample, is 1 in nearly every
// file regardless of the speed, and is not used. Animations of glTF are sampled at the frame
// rate: usually one on which their keys lie (gltf/frame_grid.h).
struct InputOptions {
  std::string path;
  std::string points;  // empty: none
  std::optional<FrameRate> frame_rate;
  // glTF only, in this order: names, indices from 0, or "all"; none: the first.
  std::vector<std::string> animations{};
  bool weld = true;                  // glTF only: merge vertices that coincide in every frame
  Images images = Images::kSmaller;  // glTF and OBJ
  bool rig = true;             // glTF only: tell the encoder the bones (FrameSource::rig())
  std::optional<Axes> axes{};  // axes to turn positions to
  // Input estimated to need more is an error. Files may claim far more than they contain.
  std::uint64_t max_memory_bytes = kUsualEncoderBytes;
  std::vector<std::string> more_paths{};  // further files of a sequence
};

// Parses "25", "30000/1001" or "29.97" as an exact, reduced fraction (the last one is
// 2997/100).
InputResult<FrameRate> parse_frame_rate(std::string_view text);

// Returns the nearest common frame rate: an integer, N * 1000 / 1001, or thousandths. For rates
// that are known to about five digits; none outside 2 to 1000.
std::optional<FrameRate> frame_rate_near(double frames_per_second);

}  // namespace rlpc
