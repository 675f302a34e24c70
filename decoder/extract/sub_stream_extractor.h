// 8.14.1 Slices that are absent: a stream of the Main profile without some of its slices.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/result.h"
#include "common/syntax/write_units.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/slice_cut.h"
#include "decoder/stream/byte_source.h"
#include "decoder/stream/gof_summary.h"
#include "decoder/stream/unit_reader.h"

namespace rlpc {

// Units stay as they are, with these exceptions. The hashes of GOFs that slices are left out of
// are those of the positions that are decoded now. The GOF index, which has to be the unit
// before the end of the sequence, has the places that GOF units have now. Where nothing is left
// out, the stream is a copy.
class SubStreamExtractor {
 public:
  // Parses all of the stream, so that no cut stream comes of one that does not conform.
  static Result<SubStreamExtractor> open(std::unique_ptr<ByteSource> source,
                                         const SliceCut& cut, const DecodeLimits& limits = {});

  const SequenceHeader& header() const { return decoder_.header(); }
  std::uint64_t size() const { return units_.size(); }  // of the stream before
  // Those before. GOFs of clusters have no slices, and stay whole.
  const std::vector<GofSummary>& gofs() const { return gofs_; }
  SliceTotals totals_that_stay(const GofSummary& gof) const {
    return gof.totals(gof.groups_that_stay(cut_));
  }
  // Whether a slice is left out of the GOF.
  bool cuts(const GofSummary& gof) const {
    return totals_that_stay(gof).num_slices < gof.slices.size();
  }
  bool cuts_any() const { return cuts_any_; }

  // The next bytes of the cut stream; empty at its end.
  Result<Bytes> next();

 private:
  SubStreamExtractor(std::unique_ptr<ByteSource> units, Decoder decoder, const SliceCut& cut,
                     std::vector<GofSummary> gofs);

  Result<Bytes> cut_unit(const UnitHeader& unit, const Bytes& payload);
  void start_gof();
  Result<Bytes> new_hash(const GofSummary& gof, const UnitHeader& unit, const Bytes& payload);
  Bytes end_of_sequence();

  UnitReader units_;
  Decoder decoder_;  // of the stream as it is cut
  SliceCut cut_;
  std::vector<GofSummary> gofs_;
  bool cuts_any_ = false;

  std::uint64_t offset_ = 0;   // in the stream before
  std::uint64_t written_ = 0;  // bytes of the cut stream so far
  std::vector<std::uint32_t> vertex_order_;
  const GofSummary* gof_ = nullptr;  // which the unit before belongs to
  SliceGroups groups_;               // of that GOF, which stay
  std::size_t num_gofs_ = 0;         // so far
  std::size_t num_slices_ = 0;       // of the GOF so far
  bool has_index_ = false;
  std::uint64_t first_gof_offset_ = 0;
  std::uint64_t gof_offset_ = 0;
  std::vector<GofEntry> index_;
};

}  // namespace rlpc
