// Searches for the target over a whole sequence, and writes the stream.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/parallel/for_each.h"
#include "common/verify/stream_buffer.h"
#include "encoder/codec/report.h"
#include "encoder/codec/sequence/attribute_stage.h"
#include "encoder/codec/sequence/choices/grid_choice.h"
#include "encoder/codec/sequence/memory_need.h"
#include "encoder/codec/sequence/sequence_coding.h"
#include "encoder/codec/sequence/span_batch.h"
#include "encoder/codec/sequence/stream_assembly.h"
#include "encoder/codec/sequence/target_loop.h"
#include "encoder/codec/settings.h"
#include "encoder/meshes/frame_source.h"

namespace rlpc {

class SequenceEncoder {
 public:
  // Keeps references to all but the profile. written: profile of the stream; it includes the
  // profile of the settings, which decides what is tried.
  SequenceEncoder(FrameSource& source, const EncoderSettings& settings, Profile written,
                  const Progress& progress)
      : source_(source), settings_(settings), written_(written), progress_(progress) {}

  // Searches for the target; write() then writes the result. rival: result to beat; the search
  // may be given up (TargetResult::given_up), unless the animation is small. null: no rival.
  InputResult<TargetResult> find(const Rival* rival = nullptr);
  InputResult<EncodeReport> write(TargetResult best, const ByteSink& sink);
  // Returns the size of the stream that write() would write, without attributes.
  std::uint64_t bytes_of(const TargetResult& result) const;

 private:
  std::optional<InputError> prepare();
  std::optional<InputError> survey(SequenceHeader& header);
  SourceMemory source_memory() const;
  std::uint32_t longest_span_of(const SequenceHeader& header) const;
  double likely_step(const SequenceHeader& header) const;
  std::optional<InputError> lengthen_gofs(const SequenceHeader& header);
  std::optional<InputError> allot_memory(const SequenceHeader& header);
  InputResult<GridChoice> first_grid() const;
  void use_grid(const GridChoice& grid);
  std::optional<InputError> cut_gofs(const SequenceHeader& header);
  TargetTask task(const EncoderSettings& settings) const;
  InputResult<TargetResult> search(const Rival* rival);
  std::optional<InputError> search_on_finer_grid(TargetResult& best);
  double fixed_bits() const;
  std::uint64_t total_bytes(const TargetResult& result);
  std::optional<InputError> keep_to_rate(TargetResult& best);
  std::optional<InputError> verify(const std::shared_ptr<StreamBuffer>& stream,
                                   std::uint64_t end_of_first_gof, EncodeReport& report);
  void show_progress(std::uint32_t trial, double done) const;
  std::optional<InputError> measure_cuts(const BatchTrial& trial, EncodeReport& report);

  FrameSource& source_;
  const EncoderSettings& settings_;
  Profile written_;
  const Progress& progress_;
  bool keeps_analyses_ = true;
  std::uint32_t num_threads_ = 1;
  std::optional<ThreadPool> threads_;  // used in find() and write()
  Extent extent_;
  std::uint32_t longest_gof_ = 0;
  std::vector<FrameRange> spans_;
  std::optional<SequenceCoding> coding_;
  std::optional<StreamAssembly> stream_;
  std::optional<AttributeStage> attributes_;
  std::uint32_t trials_ = 0;    // trials of all searches so far
  double reserved_bits_ = 0.0;  // bits that earlier searches for a rate did not know of
};

}  // namespace rlpc
