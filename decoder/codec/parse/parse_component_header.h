// 6.5.7 component_header( ), of components and of trajectories.
#pragma once

#include <array>
#include <cstdint>

#include "common/codec/components/component_limits.h"
#include "common/codec/components/track_models.h"
#include "decoder/codec/parse/section_reader.h"

namespace rlpc {

// Parses a field of a header, coded relative to its previous value. `models` and `mean` are
// shared by all fields.
inline int parse_header_field(SectionReader& section, ResidualModels& models,
                              std::array<std::uint32_t, 4>& mean, HeaderField field,
                              int previous, Range range, const char* element,
                              const char* rule) {
  return section.header_value(models, mean[static_cast<std::size_t>(field)], previous, range,
                              element, rule);
}

// Header: Component or Trajectory. After a failure, `header` must not be used.
template <class Header>
void parse_component_header(SectionReader& section, ResidualModels& models,
                            std::array<std::uint32_t, 4>& mean, const Header& previous,
                            Header& header) {
  header.scale_idx =
      parse_header_field(section, models, mean, HeaderField::kScaleIdx, previous.scale_idx,
                         {0, kMaxScaleIdx}, "scale_idx_delta", "R-GOF-10");
  header.spatial_bits = parse_header_field(section, models, mean, HeaderField::kSpatialBits,
                                           previous.spatial_bits, {1, kMaxSpatialBits},
                                           "spatial_bits_delta", "R-GOF-11");
  header.temporal_bits = parse_header_field(section, models, mean, HeaderField::kTemporalBits,
                                            previous.temporal_bits, {1, kMaxTemporalBits},
                                            "temporal_bits_delta", "R-GOF-12");
}

}  // namespace rlpc
