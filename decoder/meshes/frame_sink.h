// Interface of the writers of decoded animations, and functions that open them.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "common/files/output_file.h"

namespace rlpc {

// Takes the frames in order. Writes everything under a temporary name next to its destination;
// finish() moves it there. A sink destroyed without a successful finish() removes what it
// wrote; existing files stay untouched. After an error it can only be destroyed.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  // Writes a frame. positions: [num_vertices][3], grid units. At most num_frames calls.
  virtual std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) = 0;
  // Returns whether the sink uses set_pose().
  virtual bool wants_poses() const { return false; }
  // Sets the bones of the next frame; none: no bones move its vertices.
  virtual void set_pose(const std::optional<SkeletonPose>& /*pose*/) {}
  // Completes the output, after num_frames frames, or fewer if SinkOptions::keep_partial.
  virtual std::optional<OutputError> finish() = 0;
  // Returns remarks on the file for the user, one per line, after finish().
  virtual std::vector<std::string> remarks() const { return {}; }
};

// Format to write; kByName: from the name of the file.
enum class SinkFormat : std::uint8_t { kByName, kRlpd, kPc2, kMdd, kGlb, kObj, kPly };

// Method that moves the vertices in a .glb file. kSkin: bones, and morph targets for the
// residual; kMorph: a morph target per frame; kAuto: bones, unless frames take fewer bytes, or
// the residual exceeds the error of the stream and frames remain viewable.
enum class GltfMotion : std::uint8_t { kAuto, kSkin, kMorph };

inline constexpr std::uint32_t kUsualMaxTargets = 256;

struct SinkOptions {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_frames = 0;
  FrameRate frame_rate;
  Grid grid;
  std::vector<Triangle> triangles;  // every index below num_vertices
  // .rlpd only: finish() accepts fewer frames, and the file holds exactly those.
  bool keep_partial = false;
  // Frames arrive live, possibly fewer than num_frames, and each is written at once. Not for
  // MDD, glTF and PC2 files. A PC2 stream on standard output then has a count of 0 and no mesh.
  bool live = false;
  // Mesh sequences only: number of the first file.
  std::uint32_t first_number = 0;
  SinkFormat format = SinkFormat::kByName;
  bool ascii = false;  // PLY as text
  // .glb only: clips of the frames, whose first frame is 0.
  std::vector<Clip> clips{};
  GltfMotion motion = GltfMotion::kAuto;
  std::uint32_t max_targets = kUsualMaxTargets;  // maximum number of targets with bones
  std::uint64_t max_skin_bytes = 1U << 30;       // memory for all frames of a skin
  std::uint32_t threads = 1;                     // threads that make a skin
  // Attributes of `triangles`, as from the decoder; OBJ and PLY files hold some of them.
  std::vector<AttributeSet> attributes{};
  std::string asset{};  // materials and textures, a GLB (7.16); not in PLY files
  // Limit of all bytes written, including temporary files; null: none. Opening the sink fails
  // if it is certain to need more.
  std::shared_ptr<OutputLimit> limit{};
};

// Returns whether files of a format, or the mesh next to them, can hold attributes.
bool holds_attributes(SinkFormat format);

// Returns the format to use, never kByName: `given` unless kByName, otherwise from `path`.
SinkFormat sink_format(const std::string& path, SinkFormat given);

// Returns the file that a sink for `path` (as in open_frame_sink()) would replace and that is
// `input` under any name; none if it does not replace the input. Numbered files may have any
// number. Cost: reads the folder of numbered files.
std::optional<std::string> find_written_input(const std::string& path, SinkFormat given,
                                              const std::string& input);

// Opens a sink for options.format or, if that is kByName, for the form of `path`:
//   out/frame_%04d.obj  OBJ sequence (also %d, ####, or another width); also .ply
//   x.rlpd              integer positions and their grid (Annex A)
//   x.pc2, x.mdd        point cache; x.obj next to it holds triangles and first frame
//                       (all OBJ files: with materials, a .mtl file next to them)
//   x.glb               glTF: one mesh, moved by bones and morph targets
//   x.obj, x.ply        a single frame
//   anything else       a folder of OBJ files, frame_0000.obj, frame_0001.obj, ...
// "-" is standard output, for single-file formats; it needs options.format. Refuses x.obj for
// several frames, and extensions of formats that it cannot write.
OutputResult<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& path,
                                                         SinkOptions options);

// Open sinks of one format. A device or pipe (/dev/stdout) is written directly.
OutputResult<std::unique_ptr<FrameSink>> open_rlpd_sink(const std::string& path,
                                                        SinkOptions options);
// format: kPc2 or kMdd.
OutputResult<std::unique_ptr<FrameSink>> open_point_cache_sink(const std::string& path,
                                                               SinkFormat format,
                                                               SinkOptions options);
// Positions must fit a float, and the file must fit 4 GB.
OutputResult<std::unique_ptr<FrameSink>> open_gltf_sink(const std::string& path,
                                                        SinkOptions options);
// format: kObj or kPly, here and below.
OutputResult<std::unique_ptr<FrameSink>> open_single_mesh_sink(const std::string& path,
                                                               SinkFormat format,
                                                               const SinkOptions& options);
// pattern: has one %d or %04d in its last component. A folder that does not exist appears at
// the end, complete; in an existing one, files with the numbers of this sequence are replaced,
// and all others stay.
OutputResult<std::unique_ptr<FrameSink>> open_mesh_sink(const std::string& pattern,
                                                        SinkFormat format, SinkOptions options);

}  // namespace rlpc
