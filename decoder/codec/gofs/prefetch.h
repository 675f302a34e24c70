// Parses and prepares GOFs on other threads before they are needed: those that follow in the
// stream, and those requested. Affects only speed: a GOF with an error yields nothing, and the
// decoder parses it again to report the error.
#pragma once

#include <array>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <optional>

#include "common/memory/owned.h"
#include "common/parallel/for_each.h"
#include "decoder/codec/gofs/prepared_gof.h"
#include "decoder/codec/recon/rig_recons.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {

class Prefetch {
 public:
  struct Found {
    PreparedGof gof;
    std::uint64_t end;  // end of its units, bytes from the start of the stream
  };

  // Stream, rigs and threads must outlive it. threads: for loops within a GOF.
  // max_memory_bytes: limit per GOF; max_frame_bytes: see prepare(); max_asked: maximum number
  // of requested GOFs that are kept.
  Prefetch(StreamReader& stream, RigRecons& rigs, ThreadPool& threads,
           std::uint64_t max_memory_bytes, std::uint64_t max_frame_bytes, std::size_t max_asked)
      : stream_(stream),
        rigs_(rigs),
        threads_(threads),
        cut_(stream.access_units().cut()),
        max_memory_bytes_(max_memory_bytes),
        max_frame_bytes_(max_frame_bytes),
        max_asked_(max_asked) {}

  // Keeps up to `count` GOFs ready or in progress from a byte offset on; the first one begins
  // with first_frame. Drops earlier ones.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // Requests a GOF anywhere in the stream for one of its frames, unless it is ready or in
  // progress. Drops the oldest request if there are too many.
  void ask(const GofPlace& place, std::uint32_t frame);
  bool has_asked(std::uint32_t frame) const;
  // Hands the shared rigs between the position of the stream and the next GOF over to the
  // stream.
  void hand_over_rigs();
  // Waits for the GOF whose unit is at the offset, and returns it if it has no error; otherwise
  // drops the GOFs that follow in the stream.
  std::optional<Found> take(std::uint64_t offset, std::uint32_t first_frame);
  // Drops the GOFs that follow in the stream.
  void clear();

 private:
  // Shared rig, parsed by the first thread that needs it.
  struct RigAhead {
    std::uint64_t offset = 0;
    std::uint64_t end = 0;
    Vector<RawUnit> coded;
    std::array<std::shared_ptr<RigAhead>, kMaxRigs> before;  // rigs alive before it
    std::mutex parsing;
    bool is_tried = false;
    std::optional<ParsedRig> parsed;
  };
  using Slots = std::array<std::shared_ptr<RigAhead>, kMaxRigs>;  // [rig_idx]

  struct Ahead {
    RawAccessUnit coded;
    // Rigs since the previous GOF; with more than kMaxRigs, the GOF is not prepared.
    Vector<std::shared_ptr<RigAhead>> new_rigs;
    Slots rigs;                      // rigs alive at the GOF
    std::uint32_t first_wanted = 0;  // frame of the GOF that is needed first
    std::optional<PreparedGof> gof;
    std::future<bool> done;

    bool is_at(std::uint64_t offset, std::uint32_t first_frame) const {
      return coded.units.front().header.offset == offset &&
             coded.gof.first_frame == first_frame;
    }
  };
  using List = LinkedList<Ahead>;  // threads refer to its elements

  void start(Ahead& ahead);
  // Drops a GOF without waiting for its thread.
  void drop(List& from, List::iterator which);
  std::optional<Found> take(List& from, List::iterator which);
  std::optional<Ahead> collect_at(const GofPlace& place);
  bool start_slots(std::uint64_t offset);
  std::optional<Ahead> collect(std::uint64_t offset, std::uint32_t first_frame);
  std::shared_ptr<RigAhead> collect_rig(const UnitHeader& unit, std::uint64_t max_bytes);
  // Returns null if the rig has an error.
  const ParsedRig* parse(RigAhead& rig) const;
  std::optional<RigSlots> parse(const Slots& slots) const;
  std::optional<PreparedGof> parse(const Ahead& ahead) const;

  StreamReader& stream_;
  RigRecons& rigs_;
  ThreadPool& threads_;
  const SliceCut cut_;  // a copy: the stream's may change while threads parse
  std::uint64_t max_memory_bytes_;
  std::uint64_t max_frame_bytes_;
  std::size_t max_asked_;
  Slots slots_;   // rigs alive after the last of gofs_
  List gofs_;     // GOFs that follow in the stream
  List asked_;    // GOFs requested
  List dropped_;  // their threads may still run
};

}  // namespace rlpc
