// The units of an inter GOF through their parser, for tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/bits/trace.h"
#include "common/codec/mesh/ordered_meshes.h"
#include "decoder/codec/kinds/inter/parse/parse_inter_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/testing/skinned_gof_units.h"

namespace rlpc {

// Position at which payloads are said to begin.
inline constexpr std::uint64_t kPayloadBitPos = 8000;

class InterGofUnits {
 public:
  explicit InterGofUnits(const SequenceHeader& header, std::vector<Triangle> triangles = {},
                         std::uint64_t max_memory_bytes = std::uint64_t{1} << 30,
                         const SliceCut& cut = {})
      : header_(header),
        topology_(make_topology(header.num_vertices, triangles)),
        meshes_(topology_, triangles),
        parser_(header_, mesh(), {max_memory_bytes, 0}, cut) {}

  Result<bool> gof(const Bytes& payload, Trace* trace = nullptr) {
    BitReader r(payload, kPayloadBitPos, trace);
    const GofHeader header = parse_gof_header(r, header_, 0);
    if (r.error()) return *r.error();
    return parser_.gof(r, header);
  }
  Result<bool> frame(const Bytes& payload, Trace* trace = nullptr) {
    BitReader r(payload, kPayloadBitPos, trace);
    return parser_.frame(r, kUnitBitPos);
  }
  InterGofParser& parser() { return parser_; }
  const OrderedMesh& mesh() const { return meshes_[Prediction::kLayers]; }

 private:
  SequenceHeader header_;
  Topology topology_;
  OrderedMeshes meshes_;
  InterGofParser parser_;
};

// Expects an error; bit_pos: from the start of the payload.
inline void expect_invalid_at(const Result<bool>& parsed, const std::string& rule,
                              const std::string& element, std::uint64_t bit_pos) {
  expect_invalid(parsed, rule, element);
  if (parsed) return;
  EXPECT_EQ(parsed.error().bit_pos, kPayloadBitPos + bit_pos) << element;
}

// Elements of a unit, with their places in it.
class ElementPlaces final : public Trace {
 public:
  void begin(const char* /*structure*/, std::uint64_t /*bit_pos*/) override {}
  void element(const char* name, std::int64_t /*value*/, std::uint64_t bit_pos) override {
    places_.emplace_back(bit_pos - kPayloadBitPos, name);
  }
  // Returns the last element that begins within this many bytes, or at their end.
  const std::pair<std::uint64_t, std::string>& cut_off_at(std::size_t num_bytes) const {
    std::size_t i = 0;
    while (i + 1 < places_.size() && places_[i + 1].first <= 8 * num_bytes) ++i;
    return places_[i];
  }

 private:
  std::vector<std::pair<std::uint64_t, std::string>> places_;
};

}  // namespace rlpc
