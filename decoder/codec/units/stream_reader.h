// Iterates over the access units of a stream: parses everything, reconstructs nothing.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "common/codec/kinds/access_unit.h"
#include "common/codec/mesh/clip.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/options.h"
#include "decoder/codec/parse/sequence/parse_gof_index.h"
#include "decoder/codec/parse/sequence/parse_sequence_header.h"
#include "decoder/codec/units/access_unit_reader.h"
#include "decoder/codec/units/stream_rigs.h"
#include "decoder/codec/units/unit_reader.h"

namespace rlpc {

// Frames that a decoder holds in addition to its GOF; open() counts them towards
// max_memory_bytes.
inline constexpr std::uint32_t kFramesHeld = 4;

// Frames of a GOF, and the place of its unit.
struct GofPlace {
  std::uint64_t offset = 0;  // bytes from the start of the stream
  std::uint32_t first_frame = 0;
  std::uint32_t num_frames = 0;
};

class StreamReader {
 public:
  StreamReader(std::unique_ptr<ByteSource> source, const DecoderOptions& options);
  StreamReader(const StreamReader&) = delete;
  StreamReader& operator=(const StreamReader&) = delete;

  // Reads up to the first GOF: sequence header, connectivity, vertex order.
  Result<bool> open();

  const StreamContext& context() const { return context_; }
  const SequenceHeader& header() const { return context_.header; }
  std::span<const Triangle> triangles() const { return lead_.triangles; }  // in output order
  // 8.6.1: output index of each decoded vertex; empty: the same.
  std::span<const std::uint32_t> vertex_order() const { return lead_.vertex_order; }
  const String& metadata() const { return lead_.metadata; }  // the last so far
  const Vector<Clip>& clips() const { return lead_.clips; }  // the last clip table so far
  // Returns the errors of ignored ancillary units (DecoderOptions::skip_damaged_units).
  const Vector<Error>& damaged_units() const { return lead_.damaged_units; }
  // Returns the asset unit, if any, whose CRC has been checked.
  const std::optional<UnitHeader>& asset_unit() const { return lead_.asset_unit; }
  // Returns the attribute unit, if any, whose CRC has been checked.
  const std::optional<UnitHeader>& attribute_unit() const { return lead_.attribute_unit; }

  // Advances to the next GOF unit, past everything in between. None: a proper end of the
  // sequence. Parses all shared rigs, or skips them until a GOF that is read uses them.
  enum class Rigs : std::uint8_t { kParse, kSkip };
  Result<std::optional<UnitHeader>> find_gof(Rigs rigs = Rigs::kParse);
  // Reads the access unit that begins with the unit found, and advances past it.
  Result<AccessUnit> read(const UnitHeader& gof_unit);
  // Advances past an access unit that was read elsewhere, whose units end at `end`.
  void go_past(const UnitHeader& gof_unit, std::uint32_t num_frames, std::uint64_t end);
  // Finds and reads the next access unit.
  Result<std::optional<AccessUnit>> next();
  // Parses the header of the next GOF; reads only the first bytes of its unit.
  Result<GofHeader> gof_header(const UnitHeader& unit);
  // Returns the number of frames, which an open-ended stream has at its end; kMaxFrames if it
  // has no end. Does not check the unit. Reads a pipe to its end.
  std::uint32_t find_num_frames();
  // Resumes after an error in a GOF: makes the next GOF whose unit can be found the next one,
  // and returns its first frame; none: the stream has no more GOFs. Errors: the boundaries of
  // units after the error are unknown, or the next GOF does not follow the frames read so far.
  Result<std::optional<std::uint32_t>> skip_damage();
  // Makes the GOF with `frame` (below num_frames) the next one.
  Result<bool> seek(std::uint32_t frame);
  // Finds the GOF with `frame`, without moving.
  Result<GofPlace> locate(std::uint32_t frame);
  // Place between two units.
  struct Place {
    std::uint64_t offset = kStreamHeaderBytes;
    std::uint32_t next_first_frame = 0;
    bool ended = false;
  };
  const Place& place() const { return place_; }
  void return_to(const Place& place);
  // Goes to a place between units; first_frame: the next frame there.
  void go_to(std::uint64_t offset, std::uint32_t first_frame);

  // Returns the first frame of the GOF that find_gof() finds.
  std::uint32_t next_first_frame() const { return place_.next_first_frame; }
  bool ended() const { return place_.ended; }
  std::uint64_t offset() const { return place_.offset; }  // offset of the next unit
  std::uint32_t num_gofs() const { return static_cast<std::uint32_t>(gofs_.size()); }
  // Sets the memory of cached GOFs from now on.
  void set_cached_bytes(std::uint64_t bytes) {
    units_.set_bytes_in_use(bytes_in_use_ + bytes);
    access_units_.set_cached_bytes(bytes);
  }
  // Returns the estimated memory in use, without GOFs.
  std::uint64_t bytes_in_use() const { return bytes_in_use_; }
  UnitReader& units() { return units_; }
  AccessUnitReader& access_units() { return access_units_; }
  StreamRigs& rigs() { return rigs_; }

 private:
  struct Options {
    DecodeLimits limits;
    bool is_coarse = false;
    bool skips_damaged_units = false;
  };
  // Contents of the units outside GOFs and rigs.
  struct Lead {
    Vector<Triangle> triangles;
    Vector<std::uint32_t> vertex_order;
    String metadata;
    Vector<Clip> clips;
    Vector<Error> damaged_units;
    std::optional<UnitHeader> attribute_unit;
    std::optional<UnitHeader> asset_unit;
  };

  bool starts_gofs(const UnitHeader& unit) const;
  Result<bool> read_sequence_header();
  // Replaces the bytes counted for an object that is kept.
  void count_kept(std::uint64_t before, std::uint64_t now);
  Result<bool> read_connectivity(const UnitHeader& unit);
  Result<bool> read_vertex_order(const UnitHeader& unit);
  Result<bool> read_ancillary(const UnitHeader& unit);
  void keep_place_of(const UnitHeader& unit);
  Result<bool> parse_ancillary(const UnitHeader& unit);
  Result<bool> read_metadata(const UnitHeader& unit);
  Result<bool> read_clip_table(const UnitHeader& unit);
  Result<bool> check_limits(const SequenceHeaderPlaces& places);
  Result<bool> check_end(const UnitHeader& unit);
  Result<GofPlace> pass_gofs_to(std::uint32_t frame);
  Result<bool> skip_slices(const UnitHeader& gof_unit, UnitType type,
                           std::uint32_t first_frame);
  Result<std::optional<std::uint32_t>> gof_end(const UnitHeader& unit);
  void remember_gof(const UnitHeader& unit);

  const Options options_;
  std::uint64_t bytes_in_use_ = 0;  // without cached GOFs
  UnitReader units_;
  StreamContext context_;
  AccessUnitReader access_units_;
  StreamRigs rigs_;
  Lead lead_;
  Place place_;
  Vector<GofLocation> gofs_;  // GOFs seen so far, ascending
  bool index_tried_ = false;
};

}  // namespace rlpc
