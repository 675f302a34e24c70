// GOFs parsed and prepared on other threads before they are needed: those that follow in the
// stream, and those asked for. This affects nothing but speed: a GOF with an error yields
// nothing, and the decoder parses it again to find the error.
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
#include "decoder/codec/gofs/rig_recons.h"
#include "decoder/codec/units/stream_reader.h"

namespace rlpc {

class Prefetch {
 public:
  struct Found {
    PreparedGof gof;
    std::uint64_t end;  // of its units, bytes from the start of the stream
  };

  // Stream, rigs and threads must outlive it. threads: for loops within a GOF.
  // max_memory_bytes: of each GOF; max_frame_bytes: as of prepare(). At most `most_asked` GOFs
  // that were asked for are kept.
  Prefetch(StreamReader& stream, RigRecons& rigs, ThreadPool& threads,
           std::uint64_t max_memory_bytes, std::uint64_t max_frame_bytes,
           std::size_t most_asked)
      : stream_(stream),
        rigs_(rigs),
        threads_(threads),
        cut_(stream.access_units().cut()),
        max_memory_bytes_(max_memory_bytes),
        max_frame_bytes_(max_frame_bytes),
        most_asked_(most_asked) {}

  // Keeps up to `count` GOFs ready or in progress, from a byte offset on; the first of them
  // begins with first_frame. Drops earlier ones.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // Prepares a GOF anywhere in the stream, for a frame of it, unless that has been done or is
  // being done. Drops the one asked for before all others if there are too many.
  void ask(const GofPlace& place, std::uint32_t frame);
  bool has_asked(std::uint32_t frame) const;
  // Hands the shared rigs between the position of the stream and the next GOF over to it.
  void hand_over_rigs();
  // The GOF whose unit is at the offset, if it was prepared without an error; waits for it.
  // Otherwise drops those that follow in the stream.
  std::optional<Found> take(std::uint64_t offset, std::uint32_t first_frame);
  // Drops all that follow in the stream.
  void clear();

 private:
  // A shared rig that is parsed by the first thread that needs it.
  struct RigAhead {
    std::uint64_t offset = 0;
    std::uint64_t end = 0;
    Vector<RawUnit> coded;
    std::array<std::shared_ptr<RigAhead>, kMaxRigs> before;  // those alive
    std::mutex parsing;
    bool is_tried = false;
    std::optional<ParsedRig> parsed;
  };
  using Slots = std::array<std::shared_ptr<RigAhead>, kMaxRigs>;  // by rig_idx

  struct Ahead {
    RawAccessUnit coded;
    // Since the GOF before; at most kMaxRigs, or the GOF is not prepared.
    Vector<std::shared_ptr<RigAhead>> new_rigs;
    Slots rigs;                      // those alive
    std::uint32_t first_wanted = 0;  // frame of the GOF
    std::optional<PreparedGof> gof;
    std::future<bool> done;

    bool is_at(std::uint64_t offset, std::uint32_t first_frame) const {
      return coded.units.front().header.offset == offset &&
             coded.gof.first_frame == first_frame;
    }
  };
  using List = LinkedList<Ahead>;  // threads refer to its elements

  void start(Ahead& ahead);
  // Drops one without waiting for its thread.
  void drop(List& from, List::iterator which);
  std::optional<Found> take(List& from, List::iterator which);
  std::optional<Ahead> collect_at(const GofPlace& place);
  bool start_slots(std::uint64_t offset);
  std::optional<Ahead> collect(std::uint64_t offset, std::uint32_t first_frame);
  std::shared_ptr<RigAhead> collect_rig(const UnitHeader& unit, std::uint64_t max_bytes);
  // Null if the rig has an error.
  const ParsedRig* parse(RigAhead& rig) const;
  std::optional<RigSlots> parse(const Slots& slots) const;
  std::optional<PreparedGof> parse(const Ahead& ahead) const;

  StreamReader& stream_;
  RigRecons& rigs_;
  ThreadPool& threads_;
  const SliceCut cut_;  // of its own: the stream's may change while threads parse
  std::uint64_t max_memory_bytes_;
  std::uint64_t max_frame_bytes_;
  std::size_t most_asked_;
  Slots slots_;  // those alive after the last of the GOFs that follow
  List gofs_;    // that follow
  List asked_;
  List dropped_;  // their threads may still run
};

}  // namespace rlpc
