// Parses the units of a skinned GOF in tests.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/codec/mesh/ordered_meshes.h"
#include "common/codec/syntax/sequence_header.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/parse_gof_header.h"
#include "decoder/testing/expected_errors.h"

namespace rlpc {

using Bytes = std::vector<std::uint8_t>;

// Four squares, whose nine vertices are in three layers.
inline const std::vector<Triangle> kSquares{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {3, 1, 5},
                                            {3, 5, 6}, {3, 6, 7}, {3, 7, 4}, {7, 6, 8}};

// Start of slice units, as passed to the parser.
inline constexpr std::uint64_t kUnitBitPos = 12345;

inline SequenceHeader main_header(std::uint32_t num_vertices, std::uint32_t num_frames) {
  SequenceHeader header;
  header.profile_idc = kProfileMain;
  header.num_vertices = num_vertices;
  header.num_frames = num_frames;
  header.position_bits = 12;
  return header;
}
inline SequenceHeader high_header(std::uint32_t num_vertices, std::uint32_t num_frames) {
  SequenceHeader header = main_header(num_vertices, num_frames);
  header.profile_idc = kProfileHigh;
  return header;
}

class SkinnedGofUnits {
 public:
  explicit SkinnedGofUnits(const SequenceHeader& header, std::vector<Triangle> triangles = {},
                           std::uint64_t max_memory_bytes = std::uint64_t{1} << 30,
                           const SliceCut& cut = {})
      : header_(header),
        topology_(make_topology(header.num_vertices, triangles)),
        meshes_(topology_, triangles),
        parser_(header_, meshes_, {max_memory_bytes, 0}, cut) {}

  Result<bool> gof(const Bytes& payload, Trace* trace = nullptr,
                   std::uint32_t first_frame = 0) {
    BitReader r(payload, 0, trace);
    const GofHeader header = parse_gof_header(r, header_, first_frame);
    if (r.error()) return *r.error();
    return parser_.bones(r, header);
  }
  Result<bool> slice(const Bytes& payload, Trace* trace = nullptr) {
    BitReader r(payload, 0, trace);
    return parser_.slice(r, kUnitBitPos);
  }
  SkinnedGofParser& parser() { return parser_; }

 private:
  SequenceHeader header_;
  Topology topology_;
  OrderedMeshes meshes_;
  SkinnedGofParser parser_;
};

}  // namespace rlpc
