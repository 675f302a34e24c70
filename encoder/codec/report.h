// The report of the encoder, and the callbacks for its output and its progress.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "common/codec/kinds/inter/inter_gof.h"
#include "common/codec/syntax/sequence_header.h"
#include "encoder/codec/attributes/encode_attributes.h"
#include "encoder/codec/metrics/metrics.h"

namespace rlpc {

// Bits of the stream by purpose.
struct PartBits {
  std::uint64_t headers = 0;  // stream and sequence header, index, end of sequence
  std::uint64_t connectivity = 0;
  std::uint64_t vertex_order = 0;
  std::uint64_t gofs = 0;
  std::uint64_t hashes = 0;
  std::uint64_t metadata = 0;  // metadata and clip table
  std::uint64_t attributes = 0;
  std::uint64_t asset = 0;
};

// A stream without the slices of its higher temporal layers, as rlpcinfo --extract writes it.
struct TemporalCut {
  std::uint32_t layers = 1;  // number of layers left
  std::uint64_t bytes = 0;
  double kg_error_percent = 0.0;
};

// Number of inter GOFs with one pattern and one number of patches.
struct PatternCount {
  FramePattern pattern;
  std::uint32_t patches = 0;
  std::uint32_t gofs = 0;
};

struct EncodeReport {
  SequenceHeader header;
  // Errors of the decoded float32 positions, in input vertex order, from
  // FrameSource::read_exact().
  Metrics metrics;
  std::uint64_t bytes = 0;
  double bpvf = 0.0;  // bits per vertex per frame, everything included
  PartBits bits;
  std::uint32_t num_gofs = 0;
  std::uint32_t clusters = 0;    // clusters or bones, over all GOFs
  std::uint32_t components = 0;  // components or trajectories, over all GOFs
  double step = 0.0;             // quantiser step, units; 0 with qu and qc
  std::uint32_t trials = 0;      // encodings during the search for the target
  bool target_met = true;        // the target is not exceeded
  // Largest distance of an input vertex from the 32-bit floats that were coded, in units.
  // Errors are measured from the numbers of the input, and include it.
  double largest_rounding = 0.0;
  std::vector<PatternCount> patterns;       // in order of appearance
  std::vector<AttributeReport> attributes;  // in the order of the stream
  std::vector<TemporalCut> temporal_cuts;   // [layers - 1]; empty: only one layer
  std::vector<std::uint32_t> input_vertex;  // [decoded vertex], index in the input
};

// Receives the next bytes of the stream. Returns false to stop the encoder, for example if the
// disk is full.
using ByteSink = std::function<bool(std::span<const std::uint8_t>)>;
// Receives the fraction done, 0 to 1, from time to time; called by any thread, one at a time.
using Progress = std::function<void(double)>;

}  // namespace rlpc
