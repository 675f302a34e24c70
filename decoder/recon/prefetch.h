// GOFs parsed and prepared on other threads before they are needed. This affects nothing but
// speed: a GOF with an error yields nothing, and the decoder parses it again to find the error.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "common/parallel/for_each.h"
#include "decoder/recon/gof_recon.h"
#include "decoder/recon/model_recons.h"
#include "decoder/stream/stream_reader.h"

namespace rlpc {

// An access unit and its reconstruction.
struct PreparedGof {
  GofHeader header;
  std::optional<GofHash> hash;
  FrameCrcs frame_crcs;
  bool is_cut = false;
  std::unique_ptr<GofRecon> recon;
};
inline PreparedGof prepare(AccessUnit access_unit, const StreamContext& context,
                           ModelRecons& models) {
  auto recon = make_recon(access_unit, context, models);
  return {access_unit.header(), std::move(access_unit.hash), access_unit.frame_crcs(),
          access_unit.is_cut, std::move(recon)};
}

class Prefetch {
 public:
  struct Found {
    PreparedGof gof;
    std::uint64_t end;  // of its units, bytes from the start of the stream
  };

  // Stream, models and threads must outlive it. threads: for loops within a GOF.
  // max_memory_bytes: of each GOF.
  Prefetch(StreamReader& stream, ModelRecons& models, ThreadPool& threads,
           std::uint64_t max_memory_bytes)
      : stream_(stream),
        models_(models),
        threads_(threads),
        max_memory_bytes_(max_memory_bytes) {}

  // Keeps up to `count` GOFs ready or in progress, from a byte offset on; the first of them
  // begins with first_frame. Drops earlier ones.
  void fill(std::uint64_t offset, std::uint32_t first_frame, std::size_t count);
  // Hands the skinned models between the position of the stream and the next GOF over to it.
  void hand_over_models();
  // The GOF whose unit is at the offset, if it was prepared without an error; otherwise drops
  // all.
  std::optional<Found> take(std::uint64_t offset, std::uint32_t first_frame);
  void clear() { gofs_.clear(); }

 private:
  // A skinned model that is parsed by the first thread that needs it.
  struct ModelAhead {
    std::uint64_t offset = 0;
    std::uint64_t end = 0;
    std::vector<CodedUnit> coded;
    std::array<std::shared_ptr<ModelAhead>, kMaxModels> before;  // those alive
    std::mutex parsing;
    bool is_tried = false;
    std::optional<ParsedModel> parsed;
  };
  using Slots = std::array<std::shared_ptr<ModelAhead>, kMaxModels>;  // by model_idx

  struct Ahead {
    CodedAccessUnit coded;
    // Since the GOF before; at most kMaxModels, or the GOF is not prepared.
    std::vector<std::shared_ptr<ModelAhead>> new_models;
    Slots models;  // those alive
    std::optional<PreparedGof> gof;
    std::future<bool> done;
  };

  bool start_slots(std::uint64_t offset);
  std::optional<Ahead> collect(std::uint64_t offset, std::uint32_t first_frame);
  std::shared_ptr<ModelAhead> collect_model(const UnitHeader& unit, std::uint64_t max_bytes);
  // Null if the model has an error.
  const ParsedModel* parse(ModelAhead& model) const;
  std::optional<ModelSlots> parse(const Slots& slots) const;
  std::optional<PreparedGof> parse(const Ahead& ahead) const;

  StreamReader& stream_;
  ModelRecons& models_;
  ThreadPool& threads_;
  std::uint64_t max_memory_bytes_;
  Slots slots_;  // those alive after the last of the GOFs
  std::deque<Ahead> gofs_;
};

}  // namespace rlpc
