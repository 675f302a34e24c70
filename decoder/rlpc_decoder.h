// RLPC decoder: the public interface.
//
//   auto source = rlpc::file_source("dance.rlpc");
//   if (!source) return report(source.error());
//   auto decoder = rlpc::Decoder::open(std::move(*source));
//   if (!decoder) return report(decoder.error());
//   Vector<std::int32_t> positions(3 * decoder->num_vertices());
//   for (;;) {
//     const auto more = decoder->next_frame(positions);
//     if (!more) return report(more.error());   // rule id, element and bit position
//     if (!*more) break;                        // the stream is complete and was checked whole
//     use(decoder->triangles(), positions);
//   }
//
// Nothing throws but std::bad_alloc, after which a Decoder can only be destroyed. Memory is
// bounded by one GOF, the shared rigs that it could use (at most eight, which count towards
// the limits of a GOF) and one that is being replaced, plus four frames and max_cached_bytes;
// every size in a stream is checked against its level and DecodeLimits before anything is
// allocated. A Decoder is used by one thread at a time; different Decoders are independent.
// Errors are sticky until seek() succeeds, for example to a frame past the damage.
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

// The frames of a GOF.
struct GofRange {
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;

  bool operator==(const GofRange&) const = default;
};

// Estimated, upper bounds.
struct DecoderMemory {
  std::uint64_t stream_bytes = 0;  // connectivity, what follows from it, four frames
  std::uint64_t gof_bytes = 0;     // of the GOF in use, without shared rigs that it shares
  std::uint64_t cached_bytes = 0;  // of those kept, with their shared rigs
};

class Decoder {
 public:
  // Reads up to the first GOF: sequence header, connectivity, vertex order.
  static Result<Decoder> open(std::unique_ptr<ByteSource> source,
                              const DecoderOptions& options = {});
  Decoder(Decoder&&) noexcept;
  Decoder& operator=(Decoder&&) noexcept;
  ~Decoder();

  // As in the stream: num_vertices and num_triangles are those of the whole mesh; num_frames is
  // kMaxFrames if open_end_flag is set, see num_frames().
  const SequenceHeader& header() const;
  // Of the frames and of triangles(): header().num_vertices, or fewer in a coarse mesh.
  std::uint32_t num_vertices() const;
  // Vertex indices as in the decoded frames; input order if the stream carries it, otherwise
  // that of the connectivity process.
  std::span<const Triangle> triangles() const;
  // Of a coarse mesh: the index of each vertex in the whole mesh, ascending. Empty without
  // DecoderOptions::coarse_layers.
  std::span<const std::uint32_t> coarse_vertices() const;
  // Vertex layers of the whole mesh; 0 in the Baseline profile without coarse_layers, because
  // they have not been made.
  std::uint32_t num_layers() const;
  bool has_vertex_order() const;
  // JSON text of the last metadata unit so far; empty if there was none.
  const String& metadata() const;
  // Those of the last clip table so far. Names may have any bytes.
  const Vector<Clip>& clips() const;

  // What was wrong with ancillary units that count as absent, so far.
  const Vector<Error>& damaged_units() const;

  // The asset of the stream (7.16), a GLB without geometry; empty: none. Not checked beyond its
  // size. Errors leave the frames decodable.
  Result<String> asset();
  bool has_asset() const;
  // Whether the stream has attributes.
  bool has_attributes() const;
  // Decodes the attributes (Annex F), from the first frame, which is decoded for it even if
  // the options cut it; position() stays. Vertices, triangles and corners are those of frames
  // and triangles(); not for coarse meshes. Empty if the stream has none. Errors leave the
  // frames decodable. With forward_only, to be called before the first frame.
  Result<Vector<AttributeSet>> attributes();

  // Decodes the next frame into positions [num_vertices][3], grid units (clause 8.6). False
  // after the last frame, once the rest of the stream has been checked.
  Result<bool> next_frame(std::span<std::int32_t> positions);
  // The bones that move the vertices in the frame that next_frame() has decoded last, with
  // their influences, for writers of skinned meshes; none if its GOF has no bones. The first
  // call in a GOF takes time and memory in proportion to the vertices; GOFs with the same bones
  // and influences share the Skeleton.
  std::optional<SkeletonPose> pose();
  // The number of frames. Of an open-ended stream, it is at the end: reads a pipe to its end;
  // none if the stream has been cut off, so that it is not there.
  std::optional<std::uint32_t> num_frames() const;
  // Makes `frame` (below num_frames) the next one. GOFs in between are skipped, not decoded.
  Result<bool> seek(std::uint32_t frame);
  // Decodes a frame below num_frames, whatever came before; the one after it is then the next.
  // Takes the time of one frame where its GOF is kept, or has been prefetched, and is not an
  // inter GOF, or keeps the frame; otherwise, that of parsing the GOF; in an inter GOF that of
  // decoding those it is predicted from as well. Always returns true, or an error.
  Result<bool> frame(std::uint32_t frame, std::span<std::int32_t> positions);
  // Prepares the GOF of a frame below num_frames: with several threads in the background, with
  // one during the call, if it may be kept (max_cached_bytes). Only errors that prevent it from
  // being found are reported, and do not last; others come with its frames.
  Result<bool> prefetch(std::uint32_t frame);
  // The GOF of a frame below num_frames; all GOFs. They read headers of units, from the GOF
  // index on if there is one, and decode nothing.
  Result<GofRange> gof_of(std::uint32_t frame);
  Result<Vector<GofRange>> gofs();
  // After an error of next_frame(): goes on with the next GOF that is not lost, and returns its
  // first frame, which is the next one; none: the rest of the stream is lost. The frames in
  // between, from position() on, are not decoded. Errors: as of next_frame(); there is no way
  // to go on.
  Result<std::optional<std::uint32_t>> skip_damage();
  // Parses the rest of the stream without reconstructing frames, for programs that inspect its
  // syntax. Returns the number of GOFs in the stream; afterwards there is no next frame.
  Result<std::uint32_t> parse_rest();
  // The memory that is needed now.
  DecoderMemory memory() const;
  // Index of the frame that next_frame would decode.
  std::uint32_t position() const;
  // Whether DecoderOptions::cut or coarse_layers has dropped slices of a GOF so far.
  bool was_cut() const;
  // Number of frames that the last next_frame compared with hashes: 1 if each frame has its
  // own; the whole GOF on its last frame, if decoded in order; otherwise 0. A mismatch is an
  // error of next_frame (R-HSH-02).
  std::uint32_t compared_frames() const;

 private:
  class Impl;
  explicit Decoder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace rlpc
