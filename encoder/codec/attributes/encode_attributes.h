// Codes the attributes of an input mesh (Annex F).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/codec/attributes/attribute_set.h"
#include "encoder/codec/attributes/attribute_settings.h"
#include "encoder/codec/attributes/normal_error.h"
#include "encoder/codec/write/write_connectivity.h"
#include "encoder/meshes/source_attribute.h"

namespace rlpc {

// Size and errors of one coded attribute.
struct AttributeReport {
  std::string name;
  std::uint64_t values = 0;
  std::uint64_t bits = 0;      // in the stream
  double largest_error = 0.0;  // largest of a component, in its units; normals: degrees
  double rms_error = 0.0;      // normals only, degrees
  bool is_normal = false;
  bool is_smoothing = false;
  // Errors of normals as decoders show them, in the first frame and in others for which the
  // input has normals.
  std::vector<NormalError> normal_errors{};
  std::uint64_t num_following = 0;  // number of values that follow from positions (normals)
};

struct EncodedAttributes {
  std::vector<std::uint8_t> payload;  // payload of the attribute unit
  std::vector<AttributeReport> sets;
};

struct AttributeInput {
  const SourceAttributes& source;  // at least one set
  const ConnectivityCode& connectivity;
  std::span<const std::uint32_t> corner_map;  // map_corners()
  // Decoded positions of the first frame, in decoded order.
  std::span<const std::int32_t> first_frame;
  // Decoded frames of SourceAttributes::later_normals, as far as known.
  std::span<const DecodedFrame> later_frames{};
  bool is_animated = true;  // the sequence has several frames
};

// Codes each set in the ways that its kind and the settings allow, and keeps the smallest.
EncodedAttributes encode_attributes(const AttributeInput& input,
                                    const AttributeSettings& settings);

}  // namespace rlpc
