// 8.14.1 Slices that are absent: extracts a sub-stream of a Main stream without some of its
// slices.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/result.h"
#include "common/syntax/write_units.h"
#include "decoder/rlpc_decoder.h"
#include "decoder/slice_cut.h"
#include "decoder/stream/access_unit_reader.h"
#include "decoder/stream/byte_source.h"
#include "decoder/stream/gof_summary.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// Writes access units, with new hashes where slices are dropped, and the GOF index directly
// before the end of the sequence. Other units are copied in their order, except hash units that
// follow no GOF (R-HSH-03) and GOF indices elsewhere (R-IDX-04), which are dropped. If no slice
// is dropped, a conforming stream is copied; only the last index_gof_bytes may grow, to reach
// the index.
class SubStreamExtractor {
 public:
  // Checks the whole stream, including hashes and metadata: damaged streams yield no
  // sub-stream, and every sub-stream conforms.
  static Result<SubStreamExtractor> open(std::unique_ptr<ByteSource> source,
                                         const SliceCut& cut, const DecodeLimits& limits = {});

  const SequenceHeader& header() const { return stream_->header(); }
  std::uint64_t size() const { return stream_->units().size(); }  // of the input
  // The GOFs of the input. Cluster GOFs have no slices and are kept whole.
  const std::vector<GofSummary>& gofs() const { return gofs_; }
  SliceTotals totals_that_stay(const GofSummary& gof) const {
    return gof.totals(gof.groups_that_stay(cut_));
  }
  // Whether the GOF loses a slice.
  bool cuts(const GofSummary& gof) const {
    return totals_that_stay(gof).num_slices < gof.slices.size();
  }
  bool cuts_any() const;

  // The next bytes of the output; empty at its end.
  Result<Bytes> next();

 private:
  SubStreamExtractor(std::unique_ptr<StreamReader> stream, const DecoderOptions& options,
                     std::vector<GofSummary> gofs);

  Result<Bytes> next_unit();
  Result<Bytes> copy(const UnitHeader& unit);
  Result<Bytes> gof(const UnitHeader& unit);
  Result<Bytes> slice_or_hash(const UnitHeader& unit);
  Result<Bytes> new_hash();
  Bytes end_of_sequence();

  std::unique_ptr<StreamReader> stream_;  // read to its end
  AccessUnitReader cut_units_;
  SliceCut cut_;
  std::vector<GofSummary> gofs_;

  std::uint64_t offset_ = 0;   // in the input
  std::uint64_t written_ = 0;  // bytes of the output so far
  // The access unit that the previous unit belongs to.
  struct OpenAccessUnit {
    UnitHeader unit;  // of its GOF
    const GofSummary* gof = nullptr;
    SliceGroups groups;          // groups that are kept
    std::size_t num_slices = 0;  // so far
  };
  std::optional<OpenAccessUnit> access_unit_;
  std::size_t num_gofs_ = 0;  // so far
  bool has_index_ = false;
  std::uint64_t first_gof_offset_ = 0;
  std::uint64_t gof_offset_ = 0;
  std::vector<GofEntry> index_;
};

}  // namespace rlpc
