// RLPC decoder: the public interface.
//
//   auto source = rlpc::file_source("dance.rlpc");
//   if (!source) return report(source.error());
//   auto decoder = rlpc::Decoder::open(std::move(*source));
//   if (!decoder) return report(decoder.error());
//   std::vector<std::int32_t> positions(3 * std::size_t{decoder->num_vertices()});
//   for (;;) {
//     const auto more = decoder->next_frame(positions);
//     if (!more) return report(more.error());  // rule id, element and bit position
//     if (!*more) break;                       // the stream is complete and has been checked
//     use(decoder->triangles(), positions);
//   }
//
// The only exception is std::bad_alloc, after which a Decoder can only be destroyed. Memory is
// bounded by one GOF, the shared rigs that it can refer to (at most eight, which count towards
// the limits of a GOF), one shared rig being replaced, four frames and max_cached_bytes; every
// size in a stream is checked against its level and DecodeLimits before memory is allocated. A
// Decoder is used by one thread at a time; different Decoders are independent. Errors are
// sticky until seek() or frame() succeeds, for example with a frame past the damage.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "common/codec/attributes/attribute_set.h"
#include "common/codec/bits/trace.h"
#include "common/codec/mesh/clip.h"
#include "common/codec/mesh/mesh.h"
#include "common/codec/mesh/skeleton.h"
#include "common/codec/syntax/sequence_header.h"
#include "common/files/float_position.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/options.h"
#include "decoder/codec/units/byte_source.h"
#include "decoder/file_source.h"

namespace rlpc {

// Frames of a GOF.
struct GofRange {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;

  bool operator==(const GofRange&) const = default;
};

// Estimates of the memory in use: upper bounds.
struct DecoderMemory {
  std::uint64_t stream_bytes = 0;  // connectivity and data derived from it, four frames
  std::uint64_t gof_bytes = 0;     // the current GOF, without shared rigs
  std::uint64_t cached_bytes = 0;  // cached GOFs with their shared rigs
};

class Decoder {
 public:
  // Opens a stream: reads up to the first GOF (sequence header, connectivity, vertex order).
  static Result<Decoder> open(std::unique_ptr<ByteSource> source,
                              const DecoderOptions& options = {});
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;
  ~Decoder();

  // Returns the sequence header. Its num_vertices and num_triangles count the whole mesh; its
  // num_frames is kMaxFrames if open_end_flag is set: see num_frames().
  const SequenceHeader& header() const;
  // Returns the vertices per frame: fewer than header().num_vertices for a coarse mesh.
  std::uint32_t num_vertices() const;
  // Returns the triangles as vertex indices of the decoded frames: in input order if the stream
  // carries it, otherwise in the order of the connectivity process.
  std::span<const Triangle> triangles() const;
  // Returns the index in the whole mesh of each vertex of a coarse mesh, ascending; empty
  // without DecoderOptions::coarse_layers.
  std::span<const std::uint32_t> coarse_vertices() const;
  // Returns the vertex layers of the whole mesh; 0 in the Baseline profile without
  // coarse_layers, which does not compute them.
  std::uint32_t num_layers() const;
  // Returns whether vertices are in the order of the encoder's input.
  bool has_vertex_order() const;
  // Returns the JSON text of the last metadata unit so far; empty if there was none.
  const String& metadata() const;
  // Returns the clips of the last clip table so far. Names may have any bytes.
  const Vector<Clip>& clips() const;

  // Returns the errors of the ancillary units that were ignored so far (skip_damaged_units).
  const Vector<Error>& damaged_units() const;

  // Returns the asset of the stream (7.16), a GLB without geometry; empty if there is none.
  // Checks only its size. Frames remain decodable after an error.
  Result<String> asset();
  // Returns whether the stream has an asset, before its first GOF.
  bool has_asset() const;
  // Returns whether the stream has attributes, before its first GOF.
  bool has_attributes() const;
  // Decodes the attributes (Annex F); empty if the stream has none. Also decodes the first
  // frame, whole even if the options cut it; position() stays the same. Vertices, triangles and
  // corners are those of frames and triangles(). Not for coarse meshes. Frames remain decodable
  // after an error. With forward_only, must be called before the first frame.
  Result<Vector<AttributeSet>> attributes();

  // Decodes the next frame into positions [num_vertices][3], grid units (clause 8.6). Returns
  // false after the last frame, once the rest of the stream has been checked.
  Result<bool> next_frame(std::span<std::int32_t> positions);
  // Returns the bones of the frame that next_frame() decoded last, with their influences on the
  // vertices, for writers of skinned meshes; none if its GOF has no bones. The first call in a
  // GOF takes time and memory proportional to the vertices; GOFs with the same bones and
  // influences share the Skeleton.
  std::optional<SkeletonPose> pose();
  // Returns the number of frames, which an open-ended stream has at its end: a pipe is read to
  // its end. None if such a stream has been cut off.
  std::optional<std::uint32_t> num_frames() const;
  // Makes `frame` (below num_frames) the next one. GOFs in between are not decoded.
  Result<bool> seek(std::uint32_t frame);
  // Decodes a frame below num_frames at random access; the frame after it becomes the next one.
  // Takes the time of one frame if its GOF is cached or prefetched and is not an inter GOF, or
  // if the frame itself is cached; otherwise also that of parsing the GOF and, in an inter GOF,
  // of decoding the frames that it is predicted from. Returns true, or an error.
  Result<bool> frame(std::uint32_t frame, std::span<std::int32_t> positions);
  // Prepares the GOF of a frame below num_frames if it may be cached (max_cached_bytes): in the
  // background with several threads, otherwise during the call. Reports only errors that
  // prevent finding the GOF, which are not sticky; others are reported with its frames.
  Result<bool> prefetch(std::uint32_t frame);
  // Finds the GOF of a frame below num_frames. Reads headers of units, or the GOF index if
  // there is one, and decodes nothing.
  Result<GofRange> gof_of(std::uint32_t frame);
  // Finds all GOFs, in order, like gof_of().
  Result<Vector<GofRange>> gofs();
  // Resumes after an error of next_frame() with the next intact GOF, and returns its first
  // frame, which becomes the next one; none if the rest of the stream is lost. The frames from
  // position() to it are not decoded. Errors are those of next_frame(), and final.
  Result<std::optional<std::uint32_t>> skip_damage();
  // Parses the rest of the stream without reconstructing frames, for programs that inspect its
  // syntax. Returns the number of GOFs in the stream; afterwards there is no next frame.
  Result<std::uint32_t> parse_rest();
  // Returns the memory in use.
  DecoderMemory memory() const;
  // Returns the index of the next frame.
  std::uint32_t position() const;
  // Returns whether DecoderOptions::cut or coarse_layers has dropped slices so far.
  bool was_cut() const;
  // Returns the number of frames that the last next_frame() compared with hashes: 1 if each
  // frame has its own hash; the frames of the GOF on its last frame, if decoded in order;
  // otherwise 0. A mismatch is an error of next_frame() (R-HSH-02).
  std::uint32_t compared_frames() const;

 private:
  class Impl;
  explicit Decoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rlpc
