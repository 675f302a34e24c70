// GOFs that are parsed on other threads before they are wanted. They change nothing but the
// time that decoding takes: a GOF with an error, or whatever else is amiss, is not given, and
// its decoder finds out by itself.
#pragma once

#include <cstdint>
#include <deque>
#include <future>
#include <optional>
#include <vector>

#include "common/mesh/topology.h"
#include "decoder/parse/parse_skinned_gof.h"
#include "decoder/recon/frame_recon.h"
#include "decoder/stream/unit_reader.h"

namespace rlpc {

// A GOF unit, and the slice units behind that of a GOF of bones.
struct GofUnits {
  struct Coded {
    UnitHeader unit;
    std::vector<std::uint8_t> payload;
  };
  GofStart start;
  Coded gof;
  std::vector<Coded> slices;

  std::uint64_t end() const {
    return slices.empty() ? gof.unit.end() : slices.back().unit.end();
  }
  std::uint32_t end_frame() const { return start.first_frame + start.num_frames; }
};

class Prefetch {
 public:
  struct Parsed {
    FrameRecon recon;
    std::uint64_t end;  // of its units, bytes from the start of the stream
  };

  // All must outlive it. max_memory_bytes: of each GOF.
  Prefetch(UnitReader& units, const SequenceHeader& header, const Topology& topology,
           const MeshPredictions* meshes, std::uint64_t max_memory_bytes, const SliceCut& cut);

  // Sees to it that up to `count` GOFs are here or on their way: those behind a byte offset, of
  // which the first one begins with first_frame. Forgets any before it.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // The GOF whose unit is at the offset, if it was parsed ahead without an error. If not, all
  // are forgotten.
  std::optional<Parsed> take(std::uint64_t offset, std::uint32_t first_frame);

 private:
  struct Ahead {
    GofUnits units;
    std::optional<FrameRecon> recon;
    std::future<bool> done;
  };

  std::optional<GofUnits> read(std::uint64_t offset, std::uint32_t first_frame);
  std::optional<FrameRecon> parse(const GofUnits& units) const;

  UnitReader& units_;
  const SequenceHeader& header_;
  const Topology& topology_;
  const MeshPredictions* meshes_;
  std::uint64_t max_memory_bytes_;
  SliceCut cut_;
  std::deque<Ahead> gofs_;
};

}  // namespace rlpc
