// Builds a skinned model from its units, one by one (6.13).
#pragma once

#include <cstdint>
#include <memory>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/access_unit.h"
#include "common/codec/kinds/skinned/model_slots.h"
#include "common/codec/syntax/stream_context.h"
#include "common/memory/owned.h"
#include "common/result.h"
#include "decoder/codec/parse/memory_limit.h"
#include "decoder/codec/parse/parse_skinned_gof.h"
#include "decoder/codec/slice_cut.h"

namespace rlpc {

// A skinned model of a stream as parsed: its unit and its slice units.
struct ParsedModel {
  std::uint32_t model_idx = 0;
  std::shared_ptr<const SkinnedModel> model;
  Vector<SliceEntry> slices;  // in the order of the stream
  std::uint64_t bytes = 0;    // size of its unit
};

// Limits are checked as by AccessUnitParser. After an error it can only be destroyed.
class ModelParser {
 public:
  // The context must outlive it, and have its connectivity set. Slices outside the cut are
  // treated as absent.
  ModelParser(const StreamContext& context, const MemoryLimit& memory, const SliceCut& cut = {})
      : parser_(context.header, *context.meshes, memory, cut) {}

  // As for AccessUnitParser. models: those alive before it.
  Result<bool> model(BitReader& r, const ModelSlots& models, std::uint64_t unit_bytes) {
    if (auto ok = parser_.model(r, models); !ok) return ok;
    parsed_.bytes = unit_bytes;
    return true;
  }
  bool drops(BitReader& r) { return parser_.drops(r); }
  Result<bool> slice(BitReader& r, std::uint64_t unit_bit_pos, std::uint64_t unit_bytes) {
    if (auto ok = parser_.slice(r, unit_bit_pos); !ok) return ok;
    if (!parser_.last_slice()) return true;
    parsed_.slices.push_back(*parser_.last_slice());
    parsed_.slices.back().bytes = unit_bytes;
    return true;
  }
  // As of AccessUnitParser.
  std::uint64_t memory_bytes() const { return parser_.memory_bytes(); }
  // After the last unit.
  ParsedModel finish() {
    parsed_.model_idx = parser_.model_idx();
    parsed_.model = parser_.finish_model();
    return std::move(parsed_);
  }

 private:
  SkinnedGofParser parser_;
  ParsedModel parsed_;
};

}  // namespace rlpc
