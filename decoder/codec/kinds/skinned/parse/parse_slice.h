// 6.12 slice_section( ): the section of a slice, parsed by SkinnedGofParser.
#pragma once

#include <cstdint>

#include "common/codec/bits/bit_reader.h"
#include "common/codec/kinds/skinned/influences.h"
#include "decoder/codec/kinds/skinned/parse/parse_skinned_gof.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

class SkinnedGofParser::SliceParser {
 public:
  SliceParser(SkinnedGofParser& parser, BitReader& r, const SliceEntry& slice)
      : parser_(parser),
        gof_(parser.gof_),
        state_(parser.state_),
        section_(r, "slice_section"),
        group_(slice.component_group_idx),
        layers_(slice.layer_group_idx),
        temporal_layer_(slice.temporal_layer_idx) {}

  void parse();

 private:
  bool failed() const { return section_.failed(); }
  FactorGroup own_factors() const { return factor_group(gof_, parser_.own_group(group_)); }
  void count_factors(std::uint64_t count, std::uint64_t spatial, const char* element);
  void tracks_of_group();
  void group_components();
  void trajectory(Trajectory& trajectory);
  void trajectory_residuals(Trajectory& trajectory);
  void temporal_slice();
  void start();
  void influences(std::uint32_t v, InfluencePrediction& prediction);
  void spatial_residuals(std::uint32_t v);

  SkinnedGofParser& parser_;
  SkinnedGof& gof_;
  SliceState& state_;
  SectionReader section_;
  std::uint32_t group_;
  std::uint32_t layers_;
  std::uint32_t temporal_layer_;
};

}  // namespace rlpc
