#include "encoder/codec/sequence/attribute_stage.h"

#include <utility>

#include "encoder/codec/attributes/corner_map.h"
#include "encoder/codec/stage_clock.h"

namespace rlpc {

AttributeStage::AttributeStage(const SourceAttributes& source,
                               std::span<const Triangle> triangles,
                               const EncoderSettings& settings,
                               const ConnectivityCode& connectivity, bool is_animated)
    : source_(source),
      settings_(settings.attributes),
      connectivity_(connectivity),
      is_animated_(is_animated) {
  // Cuts to fewer components or layers change the first frame.
  settings_.from_positions = settings_.from_positions && !settings.has_detail_layers();
  if (has_sets()) corner_map_ = map_corners(connectivity, triangles);
}

std::vector<std::uint32_t> AttributeStage::frames() const {
  if (!has_sets()) return {};
  std::vector<std::uint32_t> frames{0};
  for (const PosedNormals& later : source_.later_normals) frames.push_back(later.frame);
  return frames;
}

void AttributeStage::encode(std::span<const DecodedFrame> decoded, StreamAssembly& stream) {
  const Stage stage("attributes");
  if (!has_sets()) return;
  EncodedAttributes encoded =
      encode_attributes({source_, connectivity_, corner_map_, decoded[0].positions,
                         decoded.subspan(1), is_animated_},
                        settings_);
  reports_ = std::move(encoded.sets);
  stream.set_attributes(encoded.payload);
}

}  // namespace rlpc
