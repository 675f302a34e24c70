// Writes the units of a stream in order: leading units, GOFs, index, end of sequence.
#pragma once

#include <cstdint>
#include <vector>

#include "common/codec/syntax/sequence_header.h"
#include "common/codec/syntax/write_units.h"
#include "encoder/codec/report.h"
#include "encoder/codec/settings.h"
#include "encoder/codec/write/write_connectivity.h"

namespace rlpc {

// The units of one GOF as bytes of a stream.
struct GofBytes {
  std::uint32_t num_frames = 0;
  Bytes rig;        // the shared rig before it, and its slices; empty: none
  Bytes units;      // GOF unit and slices
  Bytes hash_unit;  // empty: none
  // Whether the GOF has hashes in its frame units, and must not have a hash unit (7.2).
  bool has_own_hashes = false;
  // Bytes of the slices or frame units of each temporal layer besides the first.
  std::vector<std::uint64_t> layer_bytes;

  std::uint64_t size() const { return rig.size() + units.size() + hash_unit.size(); }
};

class StreamAssembly {
 public:
  StreamAssembly(const SequenceHeader& header, const EncoderSettings& settings,
                 const ConnectivityCode& connectivity);

  // Sets the payload of the attribute unit, before write_lead(). Empty: none.
  void set_attributes(std::span<const std::uint8_t> payload);

  // Returns the size of everything but GOFs, hashes and index.
  std::uint64_t overhead_bytes() const { return lead_bytes_ + end_bytes_; }
  // Returns the size of the index of a stream with these GOFs and no shared rigs; 0 if it would
  // have no index.
  std::uint64_t index_bytes(std::vector<GofEntry> gofs) const;

  // Write the parts of the stream; call them in this order. False: the sink failed. The header
  // may differ from that of the constructor in its level only.
  bool write_lead(const SequenceHeader& header, const ByteSink& sink);
  bool write_gof(const GofBytes& gof, const ByteSink& sink);
  // Replace write_gof() for a GOF that is written unit by unit: the first unit, further ones,
  // and the number of frames once it is known.
  bool begin_gof(const Bytes& gof_unit, const ByteSink& sink);
  bool add_to_gof(const Bytes& unit, const ByteSink& sink);
  void end_gof(std::uint32_t num_frames);
  bool write_end(const ByteSink& sink);

  // Returns the size of the stream with only the first temporal layers, at least 1, once all
  // units are written.
  std::uint64_t cut_bytes(std::size_t layers) const;
  // Sets header, bytes, bpvf, bits, num_gofs and input_vertex of the report, once all units are
  // written.
  void describe(const SequenceHeader& header, const ConnectivityCode& connectivity,
                EncodeReport& report) const;

 private:
  // Whether the stream gets an index: with few GOFs, it saves nothing; in very large streams,
  // its offsets would not fit.
  static bool has_index(const GofIndexEntries& index);
  // Returns the index unit; empty if the stream gets none.
  Bytes index_unit(const GofIndexEntries& index) const;
  bool put(std::span<const std::uint8_t> bytes, const ByteSink& sink);

  std::uint32_t profile_idc_;
  bool is_open_ended_;
  std::uint32_t num_frames_ = 0;
  Bytes metadata_;
  Bytes clip_table_;
  Bytes connectivity_;
  Bytes vertex_order_;
  Bytes attributes_;
  Bytes asset_;
  std::uint64_t lead_bytes_ = 0;
  std::uint64_t end_bytes_ = 0;
  std::uint64_t gof_bytes_ = 0;
  std::uint64_t hash_bytes_ = 0;
  std::uint64_t written_ = 0;
  GofIndexEntries index_;
  std::vector<std::vector<std::uint64_t>> layer_bytes_;  // [GOF]: GofBytes::layer_bytes
  std::uint64_t index_unit_bytes_ = 0;
  std::uint64_t gof_offset_ = 0;  // offset of the last GOF unit
};

}  // namespace rlpc
