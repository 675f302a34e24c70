// Codes the attributes of an input mesh (Annex F).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/attributes/attribute_set.h"
#include "encoder/attributes/attribute_settings.h"
#include "encoder/input/source_attribute.h"
#include "encoder/write/write_connectivity.h"

namespace rlpc {

// What became of one attribute.
struct AttributeReport {
  std::string name;
  std::uint64_t values = 0;
  std::uint64_t bits = 0;      // in the stream
  double largest_error = 0.0;  // of a component, in its units; of normals, degrees
  double rms_error = 0.0;      // of normals, degrees
  bool is_normal = false;
  bool is_smoothing = false;
};

struct EncodedAttributes {
  std::vector<std::uint8_t> payload;  // of the attribute unit
  std::vector<AttributeReport> sets;
};

struct AttributeInput {
  const SourceAttributes& source;  // at least one set
  const ConnectivityCode& connectivity;
  std::span<const std::uint32_t> corner_map;  // map_corners()
  // Decoded positions of the first frame, in decoded order.
  std::span<const std::int32_t> first_frame;
  // The same before coding.
  std::span<const std::int32_t> source_frame;
};

// Each set is coded in the ways that its kind and the settings allow, and the smallest is kept.
EncodedAttributes encode_attributes(const AttributeInput& input,
                                    const AttributeSettings& settings);

}  // namespace rlpc
