// 8.14.1 Slices that are absent: extracts a sub-stream of a stream of the Main or High profile
// without some of its slices.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/codec/syntax/write_units.h"
#include "common/result.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/slice_cut.h"
#include "decoder/codec/units/access_unit_reader.h"
#include "decoder/codec/units/byte_source.h"
#include "decoder/codec/units/stream_reader.h"
#include "decoder/codec/units/stream_rigs.h"
#include "decoder/codec/units/stream_summary.h"
#include "decoder/rlpc_decoder.h"

namespace rlpc {

// Writes access units and shared rigs, with new hashes where slices of the GOF or its shared
// rig are dropped, and the GOF index directly before the end of the sequence. Copies other
// units in their order; drops hash units that follow no GOF (R-HSH-03), GOF indices elsewhere
// (R-IDX-04), and attributes predicted from a first frame that the cut changes (R-ATT-08). A
// conforming stream that loses no slice is copied; only its last index_gof_bytes may grow, to
// reach the index.
class SubStreamExtractor {
 public:
  // Checks the whole stream, including hashes and metadata: damaged streams yield no
  // sub-stream, and every sub-stream conforms.
  static Result<SubStreamExtractor> open(std::unique_ptr<ByteSource> source,
                                         const SliceCut& cut, const DecodeLimits& limits = {});

  const SequenceHeader& header() const { return stream_->header(); }
  std::uint32_t num_frames() const { return summary_.num_frames(); }
  std::uint64_t size() const { return stream_->units().size(); }  // bytes of the input
  // Returns the GOFs and shared rigs of the input. Cluster GOFs have no slices and are kept
  // whole.
  const StreamSummary& summary() const { return summary_; }
  // Returns the totals of a GOF or shared rig within the cut.
  template <class Summary>
  SliceTotals totals_that_stay(const Summary& summary) const {
    return summary.totals(summary.groups_that_stay(cut_));
  }
  bool cuts_any() const;
  // Returns whether attributes have been dropped so far.
  bool drops_attributes() const { return drops_attributes_; }

  // Returns the next bytes of the output; empty at its end.
  Result<Bytes> next();

 private:
  SubStreamExtractor(std::unique_ptr<StreamReader> stream, const DecoderOptions& options,
                     StreamSummary summary);

  Result<Bytes> next_unit();
  Result<Bytes> copy(const UnitHeader& unit);
  Result<Bytes> attributes(const UnitHeader& unit);
  bool cuts_first_frame() const;
  Result<Bytes> rig(const UnitHeader& unit);
  Result<Bytes> gof(const UnitHeader& unit);
  Result<Bytes> slice(const UnitHeader& unit);
  Result<Bytes> hash(const UnitHeader& unit);
  Result<Bytes> new_hash();
  Bytes end_of_sequence();

  std::unique_ptr<StreamReader> stream_;  // read to its end
  // Decodes GOFs without the slices that the cut drops.
  struct CutReader {
    CutReader(StreamReader& stream, const DecoderOptions& options)
        : units(stream.units(), stream.context(), options),
          rigs(stream.units(), units),
          recons(stream.context()) {}

    AccessUnitReader units;
    StreamRigs rigs;
    RigRecons recons;
  };
  std::unique_ptr<CutReader> cut_reader_;
  SliceCut cut_;
  StreamSummary summary_;

  std::uint64_t offset_ = 0;   // in the input
  std::uint64_t written_ = 0;  // bytes of the output so far
  // GOF or shared rig that the next slices belong to.
  struct OpenUnit {
    UnitHeader unit;
    const SlicedSummary* summary = nullptr;
    const GofSummary* gof = nullptr;  // null: a shared rig
    SliceGroups groups;               // groups that are kept
    std::size_t num_slices = 0;       // so far
  };
  std::optional<OpenUnit> open_;
  // State up to offset_.
  std::size_t num_gofs_ = 0;
  std::size_t num_rigs_ = 0;
  bool has_index_ = false;
  bool drops_attributes_ = false;
  std::uint64_t gof_offset_ = 0;
  GofIndexEntries index_;
};

}  // namespace rlpc
