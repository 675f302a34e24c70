#include "encoder/sequence/attribute_stage.h"

#include <utility>

#include "encoder/attributes/corner_map.h"

namespace rlpc {

AttributeStage::AttributeStage(const SourceAttributes& source,
                               std::span<const Triangle> triangles,
                               const EncoderSettings& settings,
                               const ConnectivityCode& connectivity)
    : source_(source), settings_(settings.attributes), connectivity_(connectivity) {
  // Cuts to fewer components or layers change the first frame.
  settings_.from_positions = settings_.from_positions && !settings.has_detail_layers();
  if (has_sets()) corner_map_ = map_corners(connectivity, triangles);
}

void AttributeStage::encode(std::span<const std::int32_t> first_frame, StreamAssembly& stream) {
  if (!has_sets()) return;
  const auto source_frame = source_frame_.empty() ? first_frame : std::span(source_frame_);
  EncodedAttributes encoded = encode_attributes(
      {source_, connectivity_, corner_map_, first_frame, source_frame}, settings_);
  reports_ = std::move(encoded.sets);
  stream.set_attributes(encoded.payload);
}

}  // namespace rlpc
