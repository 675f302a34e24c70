// Files that decoded animations are written to.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/io/output_file.h"
#include "common/mesh/mesh.h"

namespace rlpc {

// Takes the frames in order. Everything is written beside its place under a temporary name and
// moved there by finish(); a sink destroyed without a successful finish() removes what it wrote
// and leaves the files that were there before as they were. After an error only destruction
// makes sense.
class FrameSink {
 public:
  FrameSink() = default;
  FrameSink(const FrameSink&) = delete;
  FrameSink& operator=(const FrameSink&) = delete;
  virtual ~FrameSink() = default;

  // positions[3 * vertex + axis], in grid units; 3 * num_vertices values. At most num_frames
  // calls.
  virtual std::optional<OutputError> write_frame(std::span<const std::int32_t> positions) = 0;
  // After num_frames frames, or fewer if SinkOptions::keep_partial.
  virtual std::optional<OutputError> finish() = 0;
};

// What is written; kByName: what the name of the file says.
enum class SinkFormat : std::uint8_t { kByName, kRlpd, kPc2, kMdd, kGlb, kObj, kPly };

struct SinkOptions {
  std::uint32_t num_vertices = 0;
  std::uint32_t num_frames = 0;
  FrameRate frame_rate;
  Grid grid;
  std::vector<Triangle> triangles;  // every index below num_vertices
  // .rlpd only: finish() accepts fewer frames, and the file holds exactly those.
  bool keep_partial = false;
  // Mesh sequences only: number of the first file.
  std::uint32_t first_number = 0;
  SinkFormat format = SinkFormat::kByName;
  bool ascii = false;  // PLY as text
  // Of all that is written, temporary files included; null: none. Where it is certain before
  // the first frame that there is more, no sink opens.
  std::shared_ptr<OutputLimit> limit{};
};

// `given`, or else by the form of `path`; never kByName.
SinkFormat sink_format(const std::string& path, SinkFormat given);

// By options.format, or else by the form of `path`:
//   out/frame_%04d.obj  OBJ sequence (also %d, or another width); likewise .ply
//   x.rlpd              integer positions and their grid (Annex A)
//   x.pc2, x.mdd        point cache; x.obj beside it holds triangles and first frame
//   x.glb               glTF: one mesh, moved by morph targets
//   x.obj, x.ply        if there is only one frame
//   anything else       a folder of OBJ files, frame_0000.obj, frame_0001.obj, ...
// "-" is standard output, for formats of one file; options.format must then say which.
// Refuses x.obj for several frames, and extensions of files that it cannot write.
OutputResult<std::unique_ptr<FrameSink>> open_frame_sink(const std::string& path,
                                                         SinkOptions options);

// The formats one by one. A device or pipe (/dev/stdout) as path is written directly.
OutputResult<std::unique_ptr<FrameSink>> open_rlpd_sink(const std::string& path,
                                                        SinkOptions options);
// kPc2 or kMdd.
OutputResult<std::unique_ptr<FrameSink>> open_point_cache_sink(const std::string& path,
                                                               SinkFormat format,
                                                               SinkOptions options);
// Positions must fit a float, and the file 4 GB.
OutputResult<std::unique_ptr<FrameSink>> open_gltf_sink(const std::string& path,
                                                        SinkOptions options);
// kObj or kPly, here and below.
OutputResult<std::unique_ptr<FrameSink>> open_single_mesh_sink(const std::string& path,
                                                               SinkFormat format,
                                                               const SinkOptions& options);
// `pattern` has one %d or %04d in its last part. If its folder does not exist it appears whole,
// at the end; if it does, files with the numbers of this sequence are replaced and all others
// are left alone.
OutputResult<std::unique_ptr<FrameSink>> open_mesh_sink(const std::string& pattern,
                                                        SinkFormat format, SinkOptions options);

}  // namespace rlpc
